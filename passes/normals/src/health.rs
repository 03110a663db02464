//! What a host may have counted of a build, readable frames later.

use airglow_gpu::{Counted, Look, Records, Tally};
use airglow_graph::Access;

use crate::build::Build;
use crate::stage::{Resource, Stage, Work};

/// Counters of [`Build::count`], to be made by [`Health::new`](airglow_gpu::Health::new): lobes that are not finite; lobes
/// that hold no normal, so that fewer would do.
pub const HEALTH: [&str; 2] = ["normals lobes not finite", "normals lobes empty"];

/// Words of a lobe in f32: its moment, its weight.
const LOBE: u32 = 4;

impl Build {
    /// Has the lobes of all levels counted by a tally of [`HEALTH`], in a step of its own before the last. To be called
    /// before any step is taken; a chain that was kept has nothing to count.
    pub fn count(&mut self, tally: &Tally) {
        let (Some(copy), 0) = (self.stages.len().checked_sub(1), self.next) else { return };
        let looks = self.levels.iter().zip(&self.lobes).flat_map(|(level, lobes)| {
            let [width, height] = level.size.map(|size| size as u64);
            let count = width * height * self.lobe_count();
            let look = |counter, counted, first, words| {
                let records = Records { count, stride: LOBE, first, words };
                Look { counter, counted, buffer: lobes.into(), records }
            };
            [look(0, Counted::NotFinite, 0, LOBE), look(1, Counted::NotPositive, LOBE - 1, 1)]
        });
        let looks: Vec<_> = looks.collect();
        if looks.is_empty() {
            return;
        }
        let lobes =
            self.levels.iter().map(|level| (Resource::Lobes(level.level), Access::ComputeStorageRead));
        let stage = Stage {
            name: "normals health",
            accesses: lobes.chain([(Resource::Health, Access::ComputeStorageReadWrite)]).collect(),
            texels: 0,
            work: Work::Count { tally: tally.clone(), looks },
        };
        self.stages.insert(copy, stage);
        self.counters = Some(tally.counters().clone());
    }
}
