//! What the passes count while they work, where a host asks for it: `render --health`.

use airglow_gpu::Health;
#[cfg(any(feature = "radiance", feature = "shadow", feature = "normals"))]
use airglow_gpu::Tally;
#[cfg(any(feature = "radiance", feature = "shadow"))]
use airglow_gpu::{Imports, Look, Record};
#[cfg(any(feature = "radiance", feature = "shadow"))]
use airglow_graph::{Buffer, Graph, Handle};

#[cfg(any(feature = "radiance", feature = "shadow", feature = "normals"))]
use super::device::Device;
use super::lighting::Lighting;
use super::renderer::Renderer;
#[cfg(any(feature = "fog", feature = "radiance", feature = "shadow", feature = "normals"))]
use crate::failure::Failure;
use crate::failure::Outcome;
use crate::measure::health;

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
        health::clear(device, &mut health)?;
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

impl Renderer<'_> {
    /// Sets the counters of every pass to 0, and makes those that its frames are declared with. Those of relight are there
    /// if its [`Source`](super::lighting::Source) says so, those of normals if the renderer was made to count.
    pub fn count_health(&mut self) -> Outcome {
        let device = self.device;
        #[cfg(feature = "fog")]
        if let Some(fog) = &mut self.fog {
            let mut health = airglow::fog::InputHealth::new(device.context()).map_err(Failure::work)?;
            health::clear(device, health.counters())?;
            fog.health = Some(health);
        }
        if let Lighting::Relight(lit) = &mut self.lighting {
            if let Some(health) = lit.relight.health() {
                health::clear(device, health)?;
            }
            #[cfg(feature = "radiance")]
            if lit.near.is_some() {
                self.counters.radiance = Some(Counted::new(device, &airglow::radiance::HEALTH)?);
            }
            #[cfg(feature = "shadow")]
            if lit.shadow.is_some() {
                self.counters.shadow = Some(Counted::new(device, &airglow::shadow::HEALTH)?);
            }
        }
        Ok(())
    }

    /// The counters of the passes that were asked to count.
    pub fn health(&mut self) -> Vec<&mut Health> {
        let mut all: Vec<&mut Health> = Vec::new();
        if let Lighting::Relight(lit) = &mut self.lighting {
            all.extend(lit.relight.health());
        }
        #[cfg(feature = "fog")]
        all.extend(self.fog.iter_mut().filter_map(|fog| Some(fog.health.as_mut()?.counters())));
        #[cfg(feature = "radiance")]
        all.extend(self.counters.radiance.iter_mut().map(|counted| &mut counted.health));
        #[cfg(feature = "shadow")]
        all.extend(self.counters.shadow.iter_mut().map(|counted| &mut counted.health));
        #[cfg(feature = "normals")]
        all.extend(self.counters.normals.iter_mut().map(|counted| &mut counted.health));
        all
    }
}
