//! One scene in clear air, in exponential depth fog and in the fog pass, side by side.

use airglow_scene::FloatImage;

use super::picture::Picture;
use super::renderer::Renderer;
use super::settings::{Air, Settings};
use super::strip::joined;
use crate::failure::Outcome;

/// Depth fog with the colour that an artist would match to the fog pass: the mean of its picture as an eye takes it, of
/// the logarithms.
pub fn depth_fog(renderer: &mut Renderer<'_>, settings: &Settings) -> Outcome<Air> {
    let fogged = renderer.draw(&Settings { air: Air::Fog, ..*settings }, 1)?;
    Ok(Air::DepthFog(mean(&fogged.linear)))
}

/// The three pictures in one, from left to right; its times and counts are those of the fog pass.
pub fn side_by_side(renderer: &mut Renderer<'_>, settings: &Settings, frames: usize) -> Outcome<Picture> {
    let depth_fog = depth_fog(renderer, settings)?;
    let clear = renderer.draw(&Settings { air: Air::Clear, ..*settings }, 1)?;
    let depth_fog = renderer.draw(&Settings { air: depth_fog, ..*settings }, 1)?;
    let fog = renderer.draw(&Settings { air: Air::Fog, ..*settings }, frames)?;
    let pictures = [clear, depth_fog, fog];
    let (linear, display) = joined(&pictures);
    let [.., fog] = pictures;
    Ok(Picture { linear, display, ..fog })
}

/// The geometric mean of a picture.
fn mean(picture: &FloatImage) -> [f32; 3] {
    let count = picture.pixels.len().max(1) as f64;
    [0, 1, 2].map(|c| {
        let sum: f64 = picture.pixels.iter().map(|pixel| f64::from(pixel[c].max(1e-6)).ln()).sum();
        (sum / count).exp() as f32
    })
}
