//! What the passes count while they work, where a host asks for it: `render --health`.

use airglow_gpu::Health;
#[cfg(any(feature = "radiance", feature = "shadow", feature = "normals"))]
use airglow_gpu::Tally;
#[cfg(any(feature = "radiance", feature = "shadow"))]
use airglow_gpu::{Imports, Look, Record};
#[cfg(any(feature = "radiance", feature = "shadow"))]
use airglow_graph::{Buffer, Graph, Handle};

use super::device::Device;
use crate::failure::{Failure, Outcome};

/// Counters of the rooms that have their buffers looked at; none where nothing is counted.
#[derive(Default)]
pub struct Counters {
    /// Of the radiance pass.
    #[cfg(feature = "radiance")]
    pub radiance: Option<Counted>,
    /// Of the shadow pass.
    #[cfg(feature = "shadow")]
    pub shadow: Option<Counted>,
    /// Of the textures of normals, which were made before the first frame.
    #[cfg(feature = "normals")]
    pub normals: Option<Counted>,
}

/// A room's counters, and the kernel that looks at its buffers.
#[cfg(any(feature = "radiance", feature = "shadow", feature = "normals"))]
pub struct Counted {
    /// The counters.
    pub health: Health,
    /// What adds to them.
    pub tally: Tally,
}

#[cfg(any(feature = "radiance", feature = "shadow", feature = "normals"))]
impl Counted {
    /// Counters of these names, at 0.
    pub fn new(device: &Device<'_>, names: &[&str]) -> Outcome<Self> {
        let mut health = Health::new(device.context(), names).map_err(Failure::work)?;
        clear(device, &mut health)?;
        Ok(Self { tally: Tally::new(device.context(), &health).map_err(Failure::work)?, health })
    }
}

/// Adds the pass `name` that looks at buffers of a graph, where they are counted and there are any.
#[cfg(any(feature = "radiance", feature = "shadow"))]
pub fn look(
    counted: Option<&Counted>,
    graph: &mut Graph<Record>,
    imports: &mut Imports,
    name: &str,
    looks: Vec<Look<Handle<Buffer>>>,
) {
    if let Some(counted) = counted.filter(|_| !looks.is_empty()) {
        counted.tally.add(graph, imports, name, looks);
    }
}

/// Sets the counters to 0, before the frames.
pub fn clear(device: &Device<'_>, health: &mut Health) -> Outcome {
    device.run(|recorder| health.clear(recorder)).map_err(Failure::work)
}
