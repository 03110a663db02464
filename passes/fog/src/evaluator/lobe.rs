//! The glow of a light through a reflecting lobe: the f32 twin of what fills the table of G_n, and how the table is laid
//! out.
//!
//! Sun, thesis (2008), eq. 3.23, with the polar axis on the light ([`crate::reference::surface`]) and the scaled exponential
//! integral of [`super::poles`]. The thesis tabulates over T from 0 to 10; the logarithm of `exp(T) G_n` over
//! `ln(1 + 8 √T)` and the chord of the angle is smooth and as flat over all T, and G_n is its exponential less T.

use std::f32::consts::PI;

use super::poles;

/// The optical distance of the table's far edge: exp(-100) is 0 in single precision.
pub const LARGEST_DISTANCE: f32 = 100.0;

/// The least of the near edge, at which G_n is its limit.
pub const SMALLEST_DISTANCE: f32 = 1e-6;

/// √T enters the table's logarithm times this.
const SPREAD: f32 = 8.0;

/// A lobe ends where it has fallen to exp(-16).
const END: f32 = 16.0;

/// Coordinates in the table, each in [0, 1], of a light at an optical distance, whose direction is `chord` from the axis of
/// the lobe `cos^exponent`: the length of the difference of the two unit vectors, 0 to 2.
pub fn coordinates(optical_distance: f32, chord: f32, exponent: f32) -> [f32; 2] {
    let distance = optical_distance.clamp(0.0, LARGEST_DISTANCE).sqrt();
    let full = (1.0 + SPREAD * LARGEST_DISTANCE.sqrt()).ln();
    let root = exponent.sqrt();
    [inverse_sinh(0.5 * root * chord) / inverse_sinh(root), (1.0 + SPREAD * distance).ln() / full]
}

/// Chord and optical distance at such coordinates: the inverse of [`coordinates`].
pub fn place([x, y]: [f32; 2], exponent: f32) -> [f32; 2] {
    let full = (1.0 + SPREAD * LARGEST_DISTANCE.sqrt()).ln();
    let distance = ((y * full).exp() - 1.0) / SPREAD;
    let root = exponent.sqrt();
    let grown = (x * inverse_sinh(root)).exp();
    let chord = (grown - grown.recip()) / root;
    [chord.min(2.0), (distance * distance).max(SMALLEST_DISTANCE)]
}

fn inverse_sinh(x: f32) -> f32 {
    (x + (x * x + 1.0).sqrt()).ln()
}

/// The table's entry, `T + ln G_n`.
pub fn entry(optical_distance: f32, chord: f32, exponent: f32) -> f32 {
    scaled_glow(optical_distance, chord, exponent).ln()
}

/// `exp(T) G_n` by three panels of Gauss-Legendre about the light, and one in every ring about it.
pub fn scaled_glow(optical_distance: f32, chord: f32, exponent: f32) -> f32 {
    let cosine = 1.0 - 0.5 * chord * chord;
    let sine = chord * (1.0 - 0.25 * chord * chord).max(0.0).sqrt();
    let theta = sine.atan2(cosine);
    // The lobe's rim, at most the horizon.
    let rim_cosine = (-END / exponent).exp();
    let rim = (1.0 - rim_cosine * rim_cosine).sqrt().atan2(rim_cosine);
    // Rings about the light meet the rim between |θ - rim| and the same about the far pole.
    let near = (theta - rim).abs();
    let far = PI - (PI - theta - rim).abs();
    let first = if theta > rim { near } else { 0.0 };
    let last = if theta + rim > PI { PI } else { far };
    let ring = |gamma: f32| {
        let (ring_sine, ring_cosine) = gamma.sin_cos();
        let (a, b) = (cosine * ring_cosine, sine * ring_sine);
        let level = (rim_cosine - a) / b.max(1e-30);
        let end = if level <= -1.0 {
            PI
        } else if level >= 1.0 {
            return 0.0;
        } else {
            (1.0 - level * level).sqrt().atan2(level)
        };
        let sum: f32 = NODES
            .iter()
            .map(|&(node, weight)| {
                let lobe = (a + b * (end * node).cos()).max(0.0);
                weight * lobe.powf(exponent)
            })
            .sum();
        // 1 - cos γ without its cancellation.
        let half = (0.5 * gamma).sin();
        let glow = poles::endless(optical_distance, ring_sine.max(1e-9), 2.0 * half * half, poles::REFERENCE);
        2.0 * end * sum * ring_sine * glow
    };
    let mut total = 0.0;
    for (a, b) in [(first, near), (near, far), (far, last)] {
        for &(node, weight) in &NODES {
            // The glow falls fast beside the light.
            let (place, slope) = if a == 0.0 { (node * node, 2.0 * node) } else { (node, 1.0) };
            total += (b - a) * weight * slope * ring(a + (b - a) * place);
        }
    }
    total
}

/// Gauss-Legendre on [0, 1].
const NODES: [(f32, f32); 16] = super::taps::NODES_16;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::surface::scaled_lobe_glow;

    #[test]
    fn entries_are_the_reference() {
        for exponent in [1.0_f32, 20.0, 1000.0] {
            for optical in [SMALLEST_DISTANCE, 0.1, 3.0, 100.0] {
                for theta in [0.0, 1e-3, 0.7, 1.6, std::f64::consts::PI] {
                    let chord = (2.0 * f64::sin(0.5 * theta)) as f32;
                    let actual = f64::from(scaled_glow(optical, chord, exponent));
                    let expected = scaled_lobe_glow(optical.into(), theta, exponent.into()).unwrap();
                    let error = (actual / expected - 1.0).abs();
                    let what = format!("T {optical:e}, theta {theta}, exponent {exponent}");
                    assert!(error < 1e-3, "{what}: {actual:e} is not {expected:e}, {error:e}");
                }
            }
        }
    }

    #[test]
    fn places_and_coordinates_invert_each_other() {
        for exponent in [1.0_f32, 50.0, 1000.0] {
            for (x, y) in [(0.0, 0.2), (0.3, 0.5), (0.9, 0.99), (1.0, 1.0)] {
                let [chord, distance] = place([x, y], exponent);
                let again = coordinates(distance, chord, exponent);
                assert!(
                    (again[0] - x).abs() < 1e-5 && (again[1] - y).abs() < 1e-5,
                    "{again:?} is not {x}, {y}"
                );
            }
        }
        assert_eq!(coordinates(1e6, 2.0, 10.0), [1.0, 1.0]);
    }
}
