//! What of a scene moves by itself, from frame to frame of one plan, or is moved between plans.

#[cfg(feature = "radiance")]
use std::sync::Arc;

#[cfg(feature = "radiance")]
use glam::Mat4;

#[cfg(feature = "radiance")]
use super::emitters;
#[cfg(any(feature = "radiance", feature = "shadow"))]
use super::lighting::Lighting;
use super::renderer::Renderer;
use crate::failure::Outcome;

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

    /// Moves the emitters to `part` of their ways, in what is drawn and in what lights it, for frames declared from now on.
    #[cfg(feature = "radiance")]
    pub fn move_emitters(&mut self, part: f32) {
        let Lighting::Relight(lit) = &mut self.lighting else { return };
        let Some(near) = &mut lit.near else { return };
        near.move_emitters(part);
        let draws = &mut Arc::make_mut(&mut self.scene).draws;
        let first = draws.len().saturating_sub(near.emitters().len());
        for (draw, emitter) in draws[first..].iter_mut().zip(near.emitters()) {
            draw.material.place(Mat4::from_translation(emitters::offset(emitter, part)));
        }
    }

    /// Has the next frame take all samples of near emitters anew, as if they had moved.
    #[cfg(feature = "radiance")]
    pub fn forget_samples(&self) {
        if let Lighting::Relight(lit) = &self.lighting {
            lit.near.iter().for_each(|near| near.receiver().forget_samples());
        }
    }
}
