//! What the radiance pass sampled, and which samples a vertex takes its light from.

use airglow::radiance::gpu::bench::Bench;
use airglow::radiance::{Hierarchy, OVERLAP, Reconstruction, Refined, Weights};
use glam::DVec3;

use super::{Shown, View};
use crate::compare::legend::Values;
use crate::failure::{Failure, Outcome};
use crate::host::emitters;
use crate::host::lighting::Lighting;
use crate::host::placed::Placed;
use crate::host::source::Source;

/// The views.
pub const VIEWS: [View; 4] = [
    View { name: "radiance-light", title: "mean radiance that arrives, luminance, w/sr/m2", high: None },
    View { name: "radiance-domain", title: "radius of the smallest sample that is valid, m", high: None },
    View { name: "radiance-sample", title: "number of that sample", high: None },
    View { name: "radiance-meeting", title: "samples that a vertex takes its light from", high: None },
];

/// The values of one of them.
pub fn values(shown: &Shown<'_>, name: &str) -> Outcome<Values> {
    let mut renderer = shown.renderer()?;
    let probed = shown.probe(&mut renderer)?;
    let (Lighting::Relight(lit), Source::Relight(transfer)) = (&renderer.lighting, shown.source) else {
        return Err(nothing());
    };
    let Some(near) = &lit.near else { return Err(nothing()) };
    if name == "radiance-light" {
        let coefficients = (shown.scene.quality.order as usize).pow(2);
        let mean = |row: &[[f32; 3]]| {
            airglow_scene::luminance(row[0]).max(0.0) / (4.0 * std::f32::consts::PI).sqrt()
        };
        let of = |light: &Vec<[f32; 3]>| light.chunks_exact(coefficients).map(mean).collect();
        return shown.surfaces(probed.light.iter().map(of).collect());
    }
    let placed = Placed::new(shown.scene, transfer);
    let tree = placed.tree()?;
    let run = shown.device.bench();
    let bench = Bench { context: shown.device.context(), run: &run };
    let (refined, _) = bench.refined(near.receiver(), &tree).map_err(Failure::work)?;
    let all = match name {
        "radiance-meeting" => meeting(&placed, &refined)?,
        _ => {
            let finest = finest(&tree, &refined);
            let value = |sample: &Option<usize>| match (name, sample) {
                (_, None) => 0.0,
                ("radiance-sample", Some(sample)) => *sample as f32,
                (_, Some(sample)) => (OVERLAP * refined.samples[*sample].reach) as f32,
            };
            finest.iter().map(value).collect()
        }
    };
    let of = |part: &airglow::radiance::Part| {
        all.get(part.vertices.start as usize..part.vertices.end as usize).unwrap_or_default().to_vec()
    };
    shown.surfaces(placed.parts.iter().map(of).collect())
}

impl Shown<'_> {
    /// Draws the values of surfaces; emitters reflect nothing, and have none.
    fn surfaces(&self, mut values: Vec<Vec<f32>>) -> Outcome<Values> {
        values.iter_mut().skip(emitters::surfaces(self.scene)).for_each(|values| values.fill(-1.0));
        self.vertices(&values)
    }
}

/// The last sample below which each vertex lies: those of parts come after those of the whole.
fn finest(tree: &Hierarchy, refined: &Refined) -> Vec<Option<usize>> {
    let mut finest = vec![None; tree.vertices().len()];
    for (number, sample) in refined.samples.iter().enumerate() {
        let Some(node) = tree.nodes().get(sample.node) else { continue };
        let members = tree.vertices().get(node.first as usize..(node.first + node.count) as usize);
        for &vertex in members.unwrap_or_default() {
            finest[vertex as usize] = Some(number);
        }
    }
    finest
}

/// How many samples each vertex takes its light from.
fn meeting(placed: &Placed, refined: &Refined) -> Outcome<Vec<f32>> {
    let gradients = refined.samples.first().is_some_and(|sample| !sample.light.gradients.is_empty());
    let reconstruction = Reconstruction::new(refined, Weights::Compact, gradients);
    let coefficients = refined.samples.first().map_or(0, |sample| sample.light.coefficients.len());
    let mut light = vec![DVec3::ZERO; coefficients];
    let at = |position: &[f32; 3]| {
        let point = DVec3::from(position.map(f64::from));
        reconstruction.light(point, &mut light).map(|count| count as f32).map_err(Failure::work)
    };
    placed.positions.iter().map(at).collect()
}

fn nothing() -> Failure {
    Failure::input(
        "the radiance pass has nothing to do in this scene: it needs an [[emitter]] that gives light",
    )
}
