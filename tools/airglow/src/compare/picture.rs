//! Making pictures pixel by pixel.

use airglow_scene::FloatImage;

/// A picture whose pixel at column `x` and row `y` is `pixel(x, y)`.
pub fn from_fn(width: usize, height: usize, mut pixel: impl FnMut(usize, usize) -> [f32; 3]) -> FloatImage {
    let mut pixels = Vec::with_capacity(width * height);
    for y in 0..height {
        pixels.extend((0..width).map(|x| pixel(x, y)));
    }
    FloatImage { width, height, pixels }
}

/// The picture after `change` on each pixel.
pub fn map(picture: &FloatImage, change: impl Fn([f32; 3]) -> [f32; 3]) -> FloatImage {
    let pixels = picture.pixels.iter().map(|&pixel| change(pixel)).collect();
    FloatImage { width: picture.width, height: picture.height, pixels }
}
