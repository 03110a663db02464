//! What of a scene moves by itself, from frame to frame of one plan.

#[cfg(feature = "shadow")]
use super::lighting::Lighting;
use super::renderer::Renderer;
#[cfg(feature = "shadow")]
use super::renderer::{Compiled, Settings};
#[cfg(feature = "shadow")]
use super::shadow::SceneShadow;
use crate::failure::Outcome;
#[cfg(feature = "shadow")]
use crate::measure::shadow::ShadowStat;

impl Renderer<'_> {
    /// Puts the figures where they are at a time, seconds, from the next recording on; plans stay.
    pub fn move_to(&self, seconds: f64) -> Outcome {
        if let Some(skins) = &self.skins {
            skins.set_time(seconds as f32);
        }
        #[cfg(feature = "shadow")]
        if let Lighting::Relight(lit) = &self.lighting
            && let Some(shadow) = &lit.shadow
        {
            shadow.set_time(seconds as f32)?;
        }
        Ok(())
    }

    /// What the shadow pass counts in a frame, where there is the pass.
    #[cfg(feature = "shadow")]
    pub fn shadow_stat(&mut self, settings: &Settings) -> Outcome<Option<ShadowStat>> {
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
        Ok(Some(ShadowStat::new(spheres, super::shadow::counts(&turning.shadow_counts)?)))
    }
}
