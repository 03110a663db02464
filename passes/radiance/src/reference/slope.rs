//! How spherical harmonics change with direction.
//!
//! The solid harmonics r^l Y_lm are harmonic polynomials, whose derivatives are solid harmonics one band lower (compare
//! Varshalovich, Moskalev, Khersonskii, "Quantum Theory of Angular Momentum", 1988, section 5.8): no angle, no pole.

use airglow_math::sh::{coefficient_count, index};
use glam::DVec3;

/// Gradients on the unit sphere of the basis at the unit `direction`, where its values are `values`; tangent vectors.
pub fn slopes(order: usize, direction: DVec3, values: &[f64]) -> Vec<DVec3> {
    let mut slopes = vec![DVec3::ZERO; coefficient_count(order)];
    for l in 1..order {
        for m in 0..=l {
            let (cosine, sine) = derivatives(l, m, values);
            let radial = l as f64 * direction; // of r^l
            slopes[index(l, m as isize)] = cosine - radial * values[index(l, m as isize)];
            if m > 0 {
                slopes[index(l, -(m as isize))] = sine - radial * values[index(l, -(m as isize))];
            }
        }
    }
    slopes
}

/// Gradients of r^l Y_lm and r^l Y_l,-m at r = 1, from the values of band l - 1.
fn derivatives(l: usize, m: usize, values: &[f64]) -> (DVec3, DVec3) {
    // The two values of order m one band lower, as parts of a complex number; for m = 0 real, times sqrt(2).
    let below = |m: usize| match m {
        _ if m >= l => [0.0, 0.0],
        0 => [std::f64::consts::SQRT_2 * values[index(l - 1, 0)], 0.0],
        _ => [values[index(l - 1, m as isize)], values[index(l - 1, -(m as isize))]],
    };
    let band = (2 * l + 1) as f64 / (2 * l - 1) as f64;
    let root = |square: usize| (band * square as f64).sqrt();
    let raise = 0.5 * root((l - m) * (l - m).saturating_sub(1));
    let up = below(m + 1).map(|value| raise * value);
    let along = root(l * l - m * m);
    if m == 0 {
        let scale = std::f64::consts::SQRT_2;
        return (DVec3::new(scale * up[0], scale * up[1], along * values[index(l - 1, 0)]), DVec3::ZERO);
    }
    let lower = 0.5 * root((l + m) * (l + m - 1));
    let down = below(m - 1).map(|value| lower * value);
    let [z, z_sine] = below(m).map(|value| along * value);
    (DVec3::new(up[0] - down[0], up[1] + down[1], z), DVec3::new(up[1] - down[1], -up[0] - down[0], z_sine))
}

#[cfg(test)]
mod tests {
    use super::*;
    use airglow_math::sh::evaluate;

    #[test]
    fn slopes_are_differences() {
        let (order, step) = (8, 1e-5);
        for direction in
            [DVec3::new(0.3, -0.7, 0.4), DVec3::Z, DVec3::NEG_Z, DVec3::X, DVec3::new(-1.0, 2.0, 0.1)]
        {
            let direction = direction.normalize();
            let at = |direction: DVec3| {
                let mut values = vec![0.0; order * order];
                evaluate(order, direction.normalize(), &mut values).unwrap();
                values
            };
            let slopes = slopes(order, direction, &at(direction));
            let across = direction.any_orthonormal_vector();
            for tangent in [across, direction.cross(across)] {
                let (after, before) = (at(direction + step * tangent), at(direction - step * tangent));
                for (i, slope) in slopes.iter().enumerate() {
                    let expected = (after[i] - before[i]) / (2.0 * step);
                    let actual = slope.dot(tangent);
                    assert!((actual - expected).abs() < 1e-7, "{direction} {i}: {actual} is not {expected}");
                    assert!(slope.dot(direction).abs() < 1e-12, "{i}: {slope} is not tangent");
                }
            }
        }
    }
}
