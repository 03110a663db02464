//! Equirectangular maps.
//!
//! (u, v) in [0, 1]², v downwards: `phi = 2 pi (u - 1/2)`, `theta = pi v`,
//! `d = (sin theta sin phi, cos theta, -sin theta cos phi)`. The centre looks down -Z, u grows towards +X, the
//! first row is up (+Y). Images are row-major, the first row at v = 0.

mod basis;
mod projector;

pub use basis::EquirectBasis;
pub use projector::Projector;

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::MathError;

/// The longest side of a map, in texels.
pub const MAX_SIDE: usize = 65_536;

/// Unit direction of a point of the map; u outside [0, 1] goes round, v is meant to lie inside.
#[must_use]
pub fn direction(u: f64, v: f64) -> DVec3 {
    let (sin_phi, cos_phi) = (TAU * (u - 0.5)).sin_cos();
    let (sin_theta, cos_theta) = (PI * v).sin_cos();
    DVec3::new(sin_theta * sin_phi, cos_theta, -sin_theta * cos_phi)
}

/// Point (u, v) of the map in a direction of any length; u is 1/2 at the poles. NaN in, NaN out.
#[must_use]
pub fn uv(direction: DVec3) -> [f64; 2] {
    let DVec3 { x, y, z } = direction;
    let horizontal = x.hypot(z);
    let phi = if horizontal == 0.0 { 0.0 } else { x.atan2(-z) };
    [phi / TAU + 0.5, horizontal.atan2(y) / PI]
}

/// Exact solid angle, in steradians, of each texel in a row.
///
/// # Errors
/// [`MathError::Size`] for an empty or too large map, [`MathError::Index`] for a row outside it.
pub fn texel_solid_angle(width: usize, height: usize, row: usize) -> Result<f64, MathError> {
    check_size(width, height)?;
    if row >= height {
        return Err(MathError::Index { what: "row", index: row, count: height });
    }
    // cos a - cos b as 2 sin((a+b)/2) sin((b-a)/2), which cancels nowhere.
    let half = 0.5 * PI / height as f64;
    Ok(TAU / width as f64 * 2.0 * ((2 * row + 1) as f64 * half).sin() * half.sin())
}

fn check_size(width: usize, height: usize) -> Result<(), MathError> {
    let sides = 1..=MAX_SIDE;
    if sides.contains(&width) && sides.contains(&height) {
        return Ok(());
    }
    Err(MathError::Size { what: "an equirectangular map", width, height, limit: MAX_SIDE })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::adaptive;
    use crate::testing::{assert_close, direction as any_direction};
    use proptest::prelude::*;

    #[test]
    fn faces_the_stated_way() {
        let known = [
            (0.5, 0.5, DVec3::NEG_Z),
            (0.75, 0.5, DVec3::X),
            (0.25, 0.5, DVec3::NEG_X),
            (0.0, 0.5, DVec3::Z),
            (1.0, 0.5, DVec3::Z),
            (0.3, 0.0, DVec3::Y),
            (0.3, 1.0, DVec3::NEG_Y),
        ];
        for (u, v, expected) in known {
            let actual = direction(u, v);
            assert!(actual.distance(expected) < 1e-15, "({u}, {v}): {actual} instead of {expected}");
        }
    }

    proptest! {
        #[test]
        fn uv_inverts_direction(d in any_direction()) {
            let [u, v] = uv(3.0 * d);
            let again = direction(u, v);
            prop_assert!(again.distance(d) < 1e-14, "{again} instead of {d}");
        }
    }

    #[test]
    fn the_poles_have_a_point() {
        assert_eq!(uv(DVec3::Y), [0.5, 0.0]);
        assert_eq!(uv(DVec3::NEG_Y), [0.5, 1.0]);
    }

    #[test]
    fn solid_angles_fill_the_sphere() {
        for (width, height) in [(1, 1), (1, 8192), (8192, 1), (7, 3), (64, 32)] {
            let rows = (0..height).map(|row| texel_solid_angle(width, height, row).unwrap());
            let sum = rows.sum::<f64>() * width as f64;
            assert_close(&format!("{width} x {height}"), sum, 4.0 * PI, 1e-12);
        }
    }

    #[test]
    fn a_solid_angle_agrees_with_quadrature() {
        for row in [0, 5, 15] {
            let (top, bottom) = (PI * row as f64 / 16.0, PI * (row + 1) as f64 / 16.0);
            let band = adaptive(f64::sin, top, bottom, 1e-13).unwrap().value;
            assert_close("solid angle", texel_solid_angle(32, 16, row).unwrap(), band * TAU / 32.0, 1e-15);
        }
    }

    #[test]
    fn refuses_what_is_no_map() {
        for (width, height) in [(0, 4), (4, 0), (MAX_SIDE + 1, 4), (4, usize::MAX)] {
            assert!(matches!(texel_solid_angle(width, height, 0), Err(MathError::Size { .. })));
        }
        assert!(matches!(texel_solid_angle(4, 2, 2), Err(MathError::Index { .. })));
    }
}
