//! Automatic exposure from the log-average luminance: Reinhard, Stark, Shirley and Ferwerda, "Photographic
//! Tone Reproduction for Digital Images", SIGGRAPH 2002, equations 1 and 2.

use crate::image::luminance;

/// The key of an average scene.
pub const MIDDLE_GREY: f32 = 0.18;

/// How scene-linear values are scaled before the tone map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    /// The log-average luminance is brought to `key`; see [`automatic`].
    Automatic {
        /// Positive; 0.18 is a middle grey.
        key: f32,
    },
    /// Multiplied by a fixed scale.
    Fixed {
        /// Positive; 2^EV.
        scale: f32,
    },
}

impl Default for Exposure {
    fn default() -> Self {
        Self::Automatic { key: MIDDLE_GREY }
    }
}

/// The scale that brings the log-average luminance of `pixels` (linear RGB) to `key`.
///
/// Where the paper adds a small number to keep black pixels from the logarithm, black pixels are left out here:
/// a background without light should not brighten the object in front of it. Non-finite and negative pixels are
/// left out too. 1 if no pixel is left. The sum is taken in f64 in the order of the pixels: same pixels, same bits.
pub fn automatic(pixels: &[[f32; 3]], key: f32) -> f32 {
    let mut sum = 0.0;
    let mut count = 0_u64;
    for &pixel in pixels {
        let value = luminance(pixel);
        if value > 0.0 && value.is_finite() {
            sum += f64::from(value).ln();
            count += 1;
        }
    }
    if count == 0 {
        return 1.0;
    }
    (f64::from(key) / (sum / count as f64).exp()) as f32
}

/// The scale of exposure value `ev`, in stops: 2^ev.
pub fn scale_of_ev(ev: f32) -> f32 {
    ev.exp2()
}

impl Exposure {
    /// The scale for a picture of `pixels` (linear RGB).
    pub fn scale(&self, pixels: &[[f32; 3]]) -> f32 {
        match *self {
            Self::Automatic { key } => automatic(pixels, key),
            Self::Fixed { scale } => scale,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grey_picture_is_brought_to_the_key() {
        for level in [1e-4_f32, 0.18, 3.0, 1e5] {
            let scale = automatic(&[[level; 3]; 7], MIDDLE_GREY);
            let found = scale * level;
            assert!((found - MIDDLE_GREY).abs() < 1e-6, "level {level} became {found}");
        }
    }

    #[test]
    fn the_average_is_geometric_and_black_does_not_count() {
        let pixels = [[0.01; 3], [100.0; 3], [0.0; 3], [f32::NAN; 3], [-1.0; 3]];
        let scale = automatic(&pixels, 0.5);
        assert!((scale - 0.5).abs() < 1e-5, "{scale}, expected 0.5: the geometric mean of 0.01 and 100 is 1");
        assert_eq!(automatic(&[[0.0; 3]], 0.5), 1.0);
        assert_eq!(automatic(&[], 0.5), 1.0);
    }

    #[test]
    fn stops_are_powers_of_two() {
        assert_eq!(scale_of_ev(0.0), 1.0);
        assert_eq!(scale_of_ev(-2.0), 0.25);
        assert_eq!(Exposure::Fixed { scale: 3.0 }.scale(&[[1.0; 3]]), 3.0);
    }
}
