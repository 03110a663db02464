//! What passes tell of the frames that were drawn: their counters, samples and clusters.

use airglow_gpu::Health;

#[cfg(any(feature = "radiance", feature = "shadow"))]
use super::counted::Counted;
use super::counted::clear;
use super::lighting::Lighting;
#[cfg(feature = "radiance")]
use super::near::Sampled;
#[cfg(feature = "shadow")]
use super::picture::Compiled;
use super::renderer::Renderer;
#[cfg(any(feature = "radiance", feature = "shadow"))]
use super::settings::Settings;
#[cfg(feature = "shadow")]
use super::shadow::{self, SceneShadow};
#[cfg(feature = "fog")]
use crate::failure::Failure;
use crate::failure::Outcome;

impl Renderer<'_> {
    /// Sets the counters of every pass to 0, and makes those that its frames are declared with. Those of relight are there
    /// if its [`Source`](super::source::Source) says so, those of normals if the renderer was made to count.
    pub fn count_health(&mut self) -> Outcome {
        let device = self.device;
        #[cfg(feature = "fog")]
        if let Some(fog) = &mut self.fog {
            let mut health = airglow::fog::InputHealth::new(device.context()).map_err(Failure::work)?;
            clear(device, health.counters())?;
            fog.health = Some(health);
        }
        if let Lighting::Relight(lit) = &mut self.lighting {
            if let Some(health) = lit.relight.health() {
                clear(device, health)?;
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

    /// What the radiance pass sampled in the last frame drawn, where there is the pass.
    #[cfg(feature = "radiance")]
    pub fn near_samples(&self, settings: &Settings) -> Outcome<Option<Sampled>> {
        match &self.lighting {
            Lighting::Relight(lit) if !settings.without_relight => {
                lit.near.as_ref().map(|near| near.sampled(self.device)).transpose()
            }
            _ => Ok(None),
        }
    }

    /// Spheres, and what the shadow pass counts of them in a frame, where there is the pass.
    #[cfg(feature = "shadow")]
    pub fn shadow_counts(
        &mut self,
        settings: &Settings,
    ) -> Outcome<Option<(usize, airglow::shadow::Counts)>> {
        let spheres = match &self.lighting {
            Lighting::Relight(lit) if !settings.without_relight && !settings.without_shadow => {
                lit.shadow.as_ref().map(SceneShadow::sphere_count)
            }
            _ => None,
        };
        let Some(spheres) = spheres else { return Ok(None) };
        let settings = Settings { count_shadow: true, ..*settings };
        let Compiled { mut execution, imports, turning, .. } = self.compile(&settings, 1, false)?;
        self.move_to(settings.time)?;
        self.device.frames(&mut execution, &imports, None, 1, |_| Ok(()))?;
        Ok(Some((spheres, shadow::counts(&turning.shadow_counts)?)))
    }
}
