//! One scene at several moments, side by side, while its emitters move.

use airglow_scene::FloatImage;

use super::picture::Picture;
#[cfg(feature = "radiance")]
use super::renderer::Renderer;
#[cfg(feature = "radiance")]
use super::settings::Settings;
#[cfg(feature = "radiance")]
use crate::failure::Outcome;

/// So many pictures in one, from left to right, emitters at the beginning of their ways in the first and at the end in
/// the last; times and counts are those of the last.
#[cfg(feature = "radiance")]
pub fn of_moving_emitters(
    renderer: &mut Renderer<'_>,
    settings: &Settings,
    moments: u32,
    frames: usize,
) -> Outcome<Picture> {
    let mut pictures = Vec::new();
    for moment in 0..moments {
        renderer.move_emitters(moment as f32 / moments.saturating_sub(1).max(1) as f32);
        let last = moment + 1 == moments;
        pictures.push(renderer.draw(settings, if last { frames } else { 1 })?);
    }
    let whole = joined(&pictures);
    let Some(last) = pictures.pop() else { return renderer.draw(settings, frames) };
    Ok(Picture { linear: whole.0, display: whole.1, ..last })
}

/// Pictures of one size in one, from left to right.
pub fn joined(pictures: &[Picture]) -> (FloatImage, Vec<[u8; 3]>) {
    let [width, height] = pictures.first().map_or([0; 2], |first| [first.linear.width, first.linear.height]);
    let linear: Vec<_> = pictures.iter().map(|picture| &picture.linear.pixels[..]).collect();
    let display: Vec<_> = pictures.iter().map(|picture| &picture.display[..]).collect();
    let pixels = join(&linear, width);
    (FloatImage { width: pictures.len() * width, height, pixels }, join(&display, width))
}

/// Rows of `width` pixels of each picture behind one another.
fn join<P: Copy>(pictures: &[&[P]], width: usize) -> Vec<P> {
    let height = pictures.first().map_or(0, |first| first.len() / width.max(1));
    let row = |y: usize| pictures.iter().flat_map(move |pixels| &pixels[y * width..(y + 1) * width]);
    (0..height).flat_map(row).copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stand_side_by_side() {
        assert_eq!(
            join(&[&[1, 2, 3, 4], &[5, 6, 7, 8], &[9, 0, 1, 2]], 2),
            [1, 2, 5, 6, 9, 0, 3, 4, 7, 8, 1, 2]
        );
        assert!(join::<u8>(&[], 0).is_empty());
    }
}
