//! From scene-linear values to the display: exposure, the Khronos PBR Neutral tone map and sRGB.
//!
//! The tone map stands on the Khronos Group's "PBR Neutral Tone Mapping" specification (2024,
//! github.com/KhronosGroup/ToneMapping): it keeps base colours below 0.8 as they are, less the 4 percent that
//! a dielectric reflects at normal incidence, and compresses what is brighter towards white.

use crate::image::{FloatImage, srgb_encode};

/// Reflectance of a dielectric at normal incidence.
const F0: f32 = 0.04;
/// Where compression begins.
const START: f32 = 0.8 - F0;
/// How fast bright colours lose their saturation.
const DESATURATION: f32 = 0.15;

/// Exposed linear RGB, not negative, to display-linear RGB in [0, 1].
///
/// With x = min(r, g, b): the offset o = x - x^2 / (4 F0) for x < 2 F0, else F0, is taken from each channel.
/// With p = max(r, g, b) of the rest: as it is for p < START; else scaled to the peak
/// n = 1 - (1 - START)^2 / (p + 1 - 2 START), then mixed with n white by 1 - 1 / (DESATURATION (p - n) + 1).
/// NaN and negative channels count as 0, infinite ones as the largest number.
pub fn tone_map(rgb: [f32; 3]) -> [f32; 3] {
    let rgb = rgb.map(|value| if value > 0.0 { value.min(f32::MAX) } else { 0.0 });
    let low = rgb[0].min(rgb[1]).min(rgb[2]);
    let offset = if low < 2.0 * F0 { low - low * low / (4.0 * F0) } else { F0 };
    let rgb = rgb.map(|value| value - offset);
    let peak = rgb[0].max(rgb[1]).max(rgb[2]);
    if peak < START {
        return rgb;
    }
    let room = 1.0 - START;
    let new_peak = 1.0 - room * room / (peak + room - START);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    rgb.map(|value| {
        let scaled = value / peak * new_peak;
        scaled + (new_peak - scaled) * white
    })
}

/// Exposes, tone-maps and encodes a picture for an 8-bit sRGB file, rounding to the nearest value.
pub fn encode(picture: &FloatImage, exposure: f32) -> Vec<[u8; 3]> {
    let byte = |value: f32| (255.0 * srgb_encode(value)).round().clamp(0.0, 255.0) as u8;
    let pixel = |rgb: &[f32; 3]| tone_map(rgb.map(|value| value * exposure)).map(byte);
    picture.pixels.iter().map(pixel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: [f32; 3], expected: [f32; 3]) {
        let same = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5);
        assert!(same, "found {found:?}, expected {expected:?}");
    }

    #[test]
    fn known_points() {
        close(tone_map([0.0; 3]), [0.0; 3]);
        // Grey of 0.08 and brighter loses 0.04; grey of 0.04 keeps x^2 / 0.16.
        close(tone_map([0.5; 3]), [0.46; 3]);
        close(tone_map([0.04; 3]), [0.01; 3]);
        // A saturated colour below the start is untouched.
        close(tone_map([0.7, 0.3, 0.0]), [0.7, 0.3, 0.0]);
        // Grey of 1: p = 0.96, n = 1 - 0.0576 / 0.44.
        close(tone_map([1.0; 3]), [1.0 - 0.0576 / 0.44; 3]);
    }

    #[test]
    fn grey_is_monotonic_continuous_and_bounded() {
        let mut last = 0.0;
        for step in 1..40_000 {
            let value = step as f32 * 1e-4;
            let [found, ..] = tone_map([value; 3]);
            assert!(found >= last && found - last < 3e-4 && found <= 1.0, "{value}: {last} then {found}");
            last = found;
        }
        for value in [1e6, f32::MAX, f32::INFINITY] {
            let found = tone_map([value, 0.0, 0.0]);
            assert!(found.iter().all(|x| (0.99..=1.0).contains(x)), "{value} became {found:?}");
        }
        close(tone_map([f32::NAN, -1.0, f32::NEG_INFINITY]), [0.0; 3]);
    }

    #[test]
    fn pictures_become_bytes() {
        let picture = FloatImage { width: 2, height: 1, pixels: vec![[0.0; 3], [0.27; 3]] };
        // 0.27 * 2 - 0.04 = 0.5, which sRGB encodes as 188.
        assert_eq!(encode(&picture, 2.0), vec![[0; 3], [188; 3]]);
    }
}
