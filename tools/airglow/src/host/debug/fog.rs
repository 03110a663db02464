//! What the medium leaves of surfaces, and what it adds, by the fog pass itself: over white surfaces that shine by themselves, and
//! over black ones.

use airglow_scene::{Material, MaterialClass, Scene, luminance};

use super::{Shown, View};
use crate::compare::legend::Values;
use crate::failure::{Failure, Outcome};
use crate::host::renderer::Renderer;
use crate::host::source::{Reason, Source};

/// The views.
pub const VIEWS: [View; 3] = [
    View { name: "fog-transmittance", title: "share of a surface's light that is left", high: Some(1.0) },
    View { name: "fog-inscatter", title: "luminance of what the medium adds, w/sr/m2", high: None },
    View { name: "fog-share", title: "share of what the medium adds in the picture", high: Some(1.0) },
];

/// The values of one of them.
pub fn values(shown: &Shown<'_>, name: &str) -> Outcome<Values> {
    if shown.scene.medium.is_none() {
        return Err(Failure::input("the fog pass has nothing to do in this scene: it needs a [medium]"));
    }
    let (black, white) = (shown.shining(0.0)?, shown.shining(1.0)?);
    let left = |pixel: usize| -> Option<f32> {
        let left = [0, 1, 2].map(|c| white[pixel][c] - black[pixel][c]);
        // Where there is no surface both are the same.
        let surface = left.iter().any(|left| *left > 0.0);
        surface.then_some(left.iter().sum::<f32>() / 3.0)
    };
    let added = |pixel: usize| luminance(black[pixel]);
    let pixels = 0..black.len();
    let behind = shown.scene.environment.is_some();
    let values = match name {
        "fog-transmittance" => pixels.map(left).collect(),
        // The sky's own light cannot be told from what the medium adds before it.
        "fog-inscatter" => {
            pixels.map(|pixel| (!behind || left(pixel).is_some()).then(|| added(pixel))).collect()
        }
        _ => {
            let whole = shown.renderer()?.draw(&shown.settings, 1)?.linear.pixels;
            let share = |pixel: usize| {
                let all = luminance(whole[pixel]);
                left(pixel).map(|_| if all > 0.0 { added(pixel) / all } else { 0.0 })
            };
            pixels.map(share).collect()
        }
    };
    Ok(Values { width: shown.settings.size[0] as usize, values })
}

impl Shown<'_> {
    /// The scene through its medium, all surfaces of which send out the same radiance.
    fn shining(&self, radiance: f32) -> Outcome<Vec<[f32; 3]>> {
        let mut scene: Scene = self.scene.clone();
        for material in &mut scene.materials {
            let base_color = [radiance, radiance, radiance, 1.0];
            let name = std::mem::take(&mut material.name);
            *material = Material { name, class: MaterialClass::Unlit, base_color, ..Material::default() };
        }
        let source = Source::Even(Reason::Asked);
        let mut renderer = Renderer::new(self.device, &scene, &source, self.settings.size)?;
        Ok(renderer.draw(&self.settings, 1)?.linear.pixels)
    }
}
