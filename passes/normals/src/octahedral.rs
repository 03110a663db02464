//! Lobes as axis, width and weight in four bytes, for textures that are sampled with filters and decoded after.
//!
//! Axes are unfolded from an octahedron (Meyer, Süßmuth, Sußner, Stamminger and Greiner, "On Floating-Point Normal Vectors",
//! 2010), so that all bits go to directions; the width is `sqrt(1 - r)`, which is linear in the angle. None of this is
//! linear in the normals: between texels whose lobes lie in the same places it is near enough, and the seam of the unfolding
//! lies below the horizon.

use glam::{DVec2, DVec3, Vec2Swizzles};

use crate::mixture::WeightedLobe;

/// Codes of the flat normal: there is one in the middle of an odd number of steps.
const MIDDLE: f64 = 127.0;
const LARGEST: f64 = 255.0;

/// A lobe in four bytes: axis, width, weight.
#[must_use]
pub fn encode(lobe: WeightedLobe) -> [u8; 4] {
    let mean = lobe.mean();
    let axis = mean.try_normalize().unwrap_or(DVec3::Z);
    let unfolded = axis.truncate() / axis.abs().element_sum();
    let folded = match axis.z < 0.0 {
        true => (DVec2::ONE - unfolded.yx().abs()) * signs(unfolded),
        false => unfolded,
    };
    let code = |value: f64| (value + 0.5).floor().clamp(0.0, LARGEST) as u8;
    let width = (1.0 - mean.length()).clamp(0.0, 1.0).sqrt();
    [
        code(MIDDLE * folded.x + MIDDLE),
        code(MIDDLE * folded.y + MIDDLE),
        code(LARGEST * width),
        code(LARGEST * lobe.weight),
    ]
}

/// The lobe of four sampled components, 0 to 1: `normals_octahedral` of `lobe.glsl`.
#[must_use]
pub fn decode([x, y, width, weight]: [f64; 4]) -> WeightedLobe {
    let unfolded = (LARGEST * DVec2::new(x, y) - MIDDLE) / MIDDLE;
    let z = 1.0 - unfolded.abs().element_sum();
    let across = if z < 0.0 { (DVec2::ONE - unfolded.yx().abs()) * signs(unfolded) } else { unfolded };
    let axis = across.extend(z).normalize();
    WeightedLobe { weight, moment: weight * (1.0 - width * width) * axis }
}

fn signs(vector: DVec2) -> DVec2 {
    vector.map(|component| if component < 0.0 { -1.0 } else { 1.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use airglow_math::sequence::{hammersley, uniform_sphere};

    #[test]
    fn directions_and_widths_come_back() {
        let mut largest: f64 = 0.0;
        for i in 0..2000 {
            let axis = uniform_sphere(hammersley(i, 2000));
            let lobe = WeightedLobe { weight: 0.6, moment: 0.6 * 0.99 * axis };
            let bytes = encode(lobe);
            let found = decode(bytes.map(|byte| f64::from(byte) / LARGEST));
            largest = largest.max(found.mean().normalize().distance(axis));
            assert!(
                (found.mean().length() - 0.99).abs() < 1e-3 && (found.weight - 0.6).abs() < 2e-3,
                "{found:?}"
            );
        }
        println!("largest angle {largest:.4}");
        assert!(largest < 0.016, "{largest}");
        let flat = decode(
            encode(WeightedLobe { weight: 1.0, moment: DVec3::Z }).map(|byte| f64::from(byte) / LARGEST),
        );
        assert_eq!((flat.moment, flat.weight), (DVec3::Z, 1.0));
    }
}
