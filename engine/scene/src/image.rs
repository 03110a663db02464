//! Pictures in memory: 8-bit textures and linear float images, with the sRGB transfer function between them.

use crate::error::{SceneError, at_most};
use crate::limits::{MAX_IMAGE_PIXELS, MAX_IMAGE_SIDE};
use std::path::Path;

/// A decoded texture: 8-bit RGBA, rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// The file's name, or `image N`.
    pub name: String,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// How red, green and blue are stored; alpha is always linear.
    pub encoding: Encoding,
    /// width * height pixels.
    pub pixels: Vec<[u8; 4]>,
}

/// How 8-bit values stand for numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Encoding {
    /// IEC 61966-2-1, for colours.
    Srgb,
    /// value / 255, for data such as normals.
    Linear,
}

impl Image {
    /// The pixel at column `x` and row `y` as linear numbers in [0, 1]; `None` outside.
    pub fn linear(&self, x: u32, y: u32) -> Option<[f32; 4]> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let pixel = self.pixels.get(y as usize * self.width as usize + x as usize)?;
        let [red, green, blue, alpha] = pixel.map(|value| f32::from(value) / 255.0);
        Some(match self.encoding {
            Encoding::Srgb => [srgb_decode(red), srgb_decode(green), srgb_decode(blue), alpha],
            Encoding::Linear => [red, green, blue, alpha],
        })
    }
}

/// A picture in linear Rec. 709 RGB, f32, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct FloatImage {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// width * height pixels.
    pub pixels: Vec<[f32; 3]>,
}

impl FloatImage {
    /// The pixel at column `x` and row `y`; `None` outside.
    pub fn get(&self, x: usize, y: usize) -> Option<[f32; 3]> {
        if x >= self.width {
            return None;
        }
        self.pixels.get(y.checked_mul(self.width)?.checked_add(x)?).copied()
    }
}

/// Refuses a picture beyond the limits, before memory is taken for it.
pub(crate) fn check_size(file: &Path, item: &str, width: u64, height: u64) -> Result<(), SceneError> {
    const MEND: &str = "resize the image";
    at_most(file, item, width.max(height), MAX_IMAGE_SIDE, "pixels on the longest side", MEND)?;
    at_most(file, item, width.saturating_mul(height), MAX_IMAGE_PIXELS, "pixels", MEND)?;
    if width == 0 || height == 0 {
        return Err(crate::error::invalid(file, item, "the image has no pixels", "save it again"));
    }
    Ok(())
}

/// Linear value of an sRGB-encoded one (IEC 61966-2-1), both in [0, 1]; continued beyond.
pub fn srgb_decode(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// sRGB-encoded value of a linear one (IEC 61966-2-1), both in [0, 1]; continued beyond.
pub fn srgb_encode(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Relative luminance of linear Rec. 709 RGB.
pub fn luminance(rgb: [f32; 3]) -> f32 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_matches_known_points_and_returns() {
        // 0.5 encodes to 188 of 255 and 0.18 to 118, as tables of the standard have it.
        for (linear, encoded) in [(0.0_f32, 0.0_f32), (0.18, 118.0), (0.5, 188.0), (1.0, 255.0)] {
            let found = (255.0 * srgb_encode(linear)).round();
            assert_eq!(found, encoded, "srgb_encode({linear}) gives {found}, expected {encoded}");
        }
        for byte in 0..=255 {
            let encoded = byte as f32 / 255.0;
            let back = srgb_encode(srgb_decode(encoded));
            assert!((back - encoded).abs() < 1e-6, "{encoded} came back as {back}");
        }
    }

    #[test]
    fn colours_are_decoded_and_alpha_is_not() {
        let pixels = vec![[255, 188, 0, 128]];
        let image = Image { name: String::new(), width: 1, height: 1, encoding: Encoding::Srgb, pixels };
        let [red, green, blue, alpha] = image.linear(0, 0).unwrap();
        assert_eq!((red, blue), (1.0, 0.0));
        assert!((green - 0.5).abs() < 0.005, "{green}");
        assert!((alpha - 128.0 / 255.0).abs() < 1e-6, "{alpha}");
        assert_eq!(image.linear(1, 0), None);
    }
}
