//! Rotation of spherical-harmonic coefficients by block-diagonal matrices.
//!
//! Stands on Ivanic and Ruedenberg, "Rotation Matrices for Real Spherical Harmonics. Direct Determination by
//! Recursion" (J. Phys. Chem. 100, 1996), Tables 1 and 2, with the additions and corrections of J. Phys.
//! Chem. A 102 (1998); in V for m < 0 the second factor reads sqrt(1 + delta_{m,-1}), without which the
//! matrices are not orthogonal.

use glam::{DMat3, DQuat};

use super::{check_order, coefficient_count};
use crate::MathError;
use crate::error::check_length;

/// The rotation of coefficient vectors that turns a function with a quaternion: `rotated(s) = f(q⁻¹ s)`.
///
/// Holds one orthogonal matrix of `(2l+1) x (2l+1)` per band, f64, row-major, rows and columns by
/// m = -l..=l, the bands one after another.
#[derive(Clone, Debug, PartialEq)]
pub struct Rotation {
    order: usize,
    bands: Vec<f64>,
}

impl Rotation {
    /// The rotation of a quaternion, which is normalised first; `q` and `-q` give the same.
    ///
    /// # Errors
    /// [`MathError::Order`]; [`MathError::Quaternion`] when `q` is zero or not finite.
    pub fn from_quaternion(order: usize, q: DQuat) -> Result<Self, MathError> {
        check_order(order)?;
        let refused = MathError::Quaternion { x: q.x, y: q.y, z: q.z, w: q.w };
        let largest = q.to_array().into_iter().map(f64::abs).fold(0.0, f64::max);
        if !q.is_finite() || largest == 0.0 {
            return Err(refused);
        }
        // Dividing twice keeps the squares of very large and very small quaternions in range.
        let unit = DQuat::from_array(q.to_array().map(|c| c / largest)).normalize();
        Ok(Self { order, bands: bands_of(order, DMat3::from_quat(unit)) })
    }

    /// The same for any orthogonal matrix, `turned(s) = f(matrix⁻¹ s)`: a reflection is a rotation and an inversion,
    /// which changes the sign of odd bands.
    ///
    /// # Errors
    /// [`MathError::Order`]; [`MathError::Orthogonal`] when the matrix is not orthogonal to 1e-6.
    pub fn from_matrix(order: usize, matrix: DMat3) -> Result<Self, MathError> {
        check_order(order)?;
        let deviation = (matrix.transpose() * matrix - DMat3::IDENTITY).to_cols_array();
        let deviation = deviation.into_iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        if !matrix.is_finite() || deviation > 1e-6 {
            return Err(MathError::Orthogonal { deviation });
        }
        Ok(Self { order, bands: bands_of(order, matrix) })
    }

    /// The order given at creation.
    #[must_use]
    pub fn order(&self) -> usize {
        self.order
    }

    /// The matrices of all bands, laid out as the type says: `order(4 order² - 1)/3` values; band `l` starts
    /// at `l(4l² - 1)/3`.
    #[must_use]
    pub fn matrices(&self) -> &[f64] {
        &self.bands
    }

    /// The row-major matrix of band `l`; empty when `l` is not below the order.
    #[must_use]
    pub fn band(&self, l: usize) -> &[f64] {
        if l >= self.order {
            return &[];
        }
        &self.bands[band_start(l)..band_start(l + 1)]
    }

    /// The opposite rotation.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let mut inverse = self.clone();
        for l in 0..self.order {
            let side = 2 * l + 1;
            let (source, target) = (self.band(l), &mut inverse.bands[band_start(l)..]);
            for row in 0..side {
                for column in 0..side {
                    target[row * side + column] = source[column * side + row];
                }
            }
        }
        inverse
    }

    /// Rotates `order²` coefficients from `f` into `out`.
    ///
    /// # Errors
    /// [`MathError::Length`] unless both hold `order²` values.
    pub fn apply(&self, f: &[f64], out: &mut [f64]) -> Result<(), MathError> {
        check_length("the rotated input", coefficient_count(self.order), f.len())?;
        check_length("the rotated output", coefficient_count(self.order), out.len())?;
        for l in 0..self.order {
            let side = 2 * l + 1;
            let source = &f[l * l..l * l + side];
            for (row, value) in self.band(l).chunks_exact(side).zip(&mut out[l * l..]) {
                *value = row.iter().zip(source).map(|(r, s)| r * s).sum();
            }
        }
        Ok(())
    }

    /// Rotates `order²` RGB coefficients.
    ///
    /// # Errors
    /// [`MathError::Length`] unless `f` holds `order²` values.
    pub fn apply_rgb(&self, f: &[[f64; 3]]) -> Result<Vec<[f64; 3]>, MathError> {
        let mut rotated = vec![[0.0; 3]; f.len()];
        let mut out = vec![0.0; f.len()];
        for channel in 0..3 {
            let plane: Vec<f64> = f.iter().map(|rgb| rgb[channel]).collect();
            self.apply(&plane, &mut out)?;
            for (rgb, value) in rotated.iter_mut().zip(&out) {
                rgb[channel] = *value;
            }
        }
        Ok(rotated)
    }
}

/// Where band `l` starts: the sum of (2k+1)² over the bands k below.
fn band_start(l: usize) -> usize {
    l * (2 * l + 1) * (2 * l).saturating_sub(1) / 3
}

/// All bands of a rotation matrix, by recursion from band 1, in the convention with (-1)^m.
fn bands_of(order: usize, rotation: DMat3) -> Vec<f64> {
    let axis = |m: i32| match m {
        -1 => 1, // y
        0 => 2,  // z
        _ => 0,  // x
    };
    let first = Band::from_fn(1, |m, n| rotation.col(axis(n))[axis(m)]);
    let mut band = Band::from_fn(0, |_, _| 1.0);
    let mut bands = Vec::with_capacity(band_start(order));
    for l in 0..order {
        match l {
            0 => {}
            1 => band = first.clone(),
            _ => band = next_band(&first, &band),
        }
        let l = l as i32;
        for m in -l..=l {
            for n in -l..=l {
                // The paper has no Condon-Shortley factor; here it multiplies both m and n.
                let sign = if (m + n) % 2 == 0 { 1.0 } else { -1.0 };
                bands.push(sign * band.at(m, n));
            }
        }
    }
    bands
}

/// One band's matrix with rows and columns counted from -l to l.
#[derive(Clone)]
struct Band {
    l: i32,
    values: Vec<f64>,
}

impl Band {
    fn from_fn(l: i32, value: impl Fn(i32, i32) -> f64) -> Self {
        let values = (-l..=l).flat_map(|m| (-l..=l).map(move |n| (m, n))).map(|(m, n)| value(m, n)).collect();
        Self { l, values }
    }

    fn at(&self, m: i32, n: i32) -> f64 {
        self.values[((m + self.l) * (2 * self.l + 1) + n + self.l) as usize]
    }
}

/// Equation 8.1 of the paper: band l from bands 1 and l-1.
fn next_band(first: &Band, below: &Band) -> Band {
    let l = below.l + 1;
    Band::from_fn(l, |m, n| {
        let (u, v, w) = weights(l, m, n);
        let p = |i, mu| partial(first, below, i, mu, n);
        let mut sum = 0.0;
        if u != 0.0 {
            sum += u * p(0, m);
        }
        if v != 0.0 {
            sum += v * v_term(m, p);
        }
        if w != 0.0 {
            let side = m.signum();
            sum += w * (p(1, m + side) + f64::from(side) * p(-1, -m - side));
        }
        sum
    })
}

/// The numbers u, v, w of Table 1; zero exactly where the term they weigh does not exist.
fn weights(l: i32, m: i32, n: i32) -> (f64, f64, f64) {
    let denominator = f64::from(if n.abs() == l { 2 * l * (2 * l - 1) } else { (l + n) * (l - n) });
    let a = m.abs();
    let root = |numerator: i32| (f64::from(numerator) / denominator).sqrt();
    let u = root((l + m) * (l - m));
    let v = if m == 0 { -0.5 * root(2 * l * (l - 1)) } else { 0.5 * root((l + a - 1) * (l + a)) };
    let w = if m == 0 { 0.0 } else { -0.5 * root((l - a - 1) * (l - a)) };
    (u, v, w)
}

/// The function V of Table 2, corrected.
fn v_term(m: i32, p: impl Fn(i32, i32) -> f64) -> f64 {
    match m {
        0 => p(1, 1) + p(-1, -1),
        1 => std::f64::consts::SQRT_2 * p(1, 0),
        -1 => std::f64::consts::SQRT_2 * p(-1, 0),
        2.. => p(1, m - 1) - p(-1, 1 - m),
        _ => p(1, m + 1) + p(-1, -m - 1),
    }
}

/// The function P of Table 2: products of band 1 and the band below.
fn partial(first: &Band, below: &Band, i: i32, mu: i32, n: i32) -> f64 {
    let k = below.l;
    if n == k + 1 {
        first.at(i, 1) * below.at(mu, k) - first.at(i, -1) * below.at(mu, -k)
    } else if n == -k - 1 {
        first.at(i, 1) * below.at(mu, -k) + first.at(i, -1) * below.at(mu, k)
    } else {
        first.at(i, 0) * below.at(mu, n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sh::{index, project, reconstruct};
    use crate::testing::{assert_all_close, assert_close, coefficients, direction};
    use glam::DVec3;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    /// Random unit quaternions, half-turns among them.
    fn quaternion() -> impl Strategy<Value = DQuat> {
        let half_turn = direction().prop_map(|axis| DQuat::from_axis_angle(axis, PI));
        let any = (direction(), -PI..PI).prop_map(|(axis, angle)| DQuat::from_axis_angle(axis, angle));
        prop_oneof![4 => any, 1 => half_turn]
    }

    fn rotate(order: usize, q: DQuat, f: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; f.len()];
        Rotation::from_quaternion(order, q).unwrap().apply(f, &mut out).unwrap();
        out
    }

    fn norm(f: &[f64]) -> f64 {
        f.iter().map(|c| c * c).sum::<f64>().sqrt()
    }

    proptest! {
        #[test]
        fn commutes_with_evaluation(q in quaternion(), f in coefficients(8), s in direction()) {
            let expected = reconstruct(8, &f, q.inverse() * s).unwrap();
            assert_close("rotated(s)", reconstruct(8, &rotate(8, q, &f), s).unwrap(), expected, 1e-12);
        }

        #[test]
        fn composes(p in quaternion(), q in quaternion(), f in coefficients(8)) {
            assert_all_close("p q", &rotate(8, p * q, &f), &rotate(8, p, &rotate(8, q, &f)), 1e-12);
        }

        #[test]
        fn preserves_the_norm_of_each_band(q in quaternion(), f in coefficients(8)) {
            let rotated = rotate(8, q, &f);
            for l in 0..8 {
                let band = l * l..(l + 1) * (l + 1);
                assert_close(&format!("band {l}"), norm(&rotated[band.clone()]), norm(&f[band]), 1e-12);
            }
        }

        #[test]
        fn the_inverse_undoes(q in quaternion(), f in coefficients(8)) {
            let rotation = Rotation::from_quaternion(8, q).unwrap();
            let mut back = vec![0.0; 64];
            rotation.inverse().apply(&rotate(8, q, &f), &mut back).unwrap();
            assert_all_close("f", &back, &f, 1e-12);
        }

        #[test]
        fn length_and_sign_of_the_quaternion_do_not_matter(q in quaternion(), exponent in -1000..1000_i32) {
            let unit = Rotation::from_quaternion(6, q).unwrap();
            let scaled = Rotation::from_quaternion(6, -q * f64::from(exponent).exp2()).unwrap();
            assert_all_close("matrix", scaled.matrices(), unit.matrices(), 1e-13);
        }
    }

    #[test]
    fn agrees_with_quadrature() {
        let q = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 1.1);
        let rotation = Rotation::from_quaternion(5, q).unwrap();
        for j in 0..25 {
            let mut one = vec![0.0; 25];
            one[j] = 1.0;
            let expected = project(5, 8, |s| reconstruct(5, &one, q.inverse() * s).unwrap()).unwrap();
            let mut column = vec![0.0; 25];
            rotation.apply(&one, &mut column).unwrap();
            assert_all_close(&format!("column {j}"), &column, &expected, 1e-13);
        }
    }

    /// A quarter turn about +Y takes +Z to +X; a half-turn about +X flips the signs of y and z.
    #[test]
    fn turns_the_right_way() {
        let mut up_z = [0.0; 4];
        up_z[index(1, 0)] = 1.0;
        let turned = rotate(2, DQuat::from_rotation_y(PI / 2.0), &up_z);
        assert_all_close("z to x", &turned, &[0.0, 0.0, 0.0, -1.0], 1e-15);
        let flipped = rotate(2, DQuat::from_rotation_x(PI), &[1.0, 2.0, 3.0, 4.0]);
        assert_all_close("half-turn", &flipped, &[1.0, -2.0, -3.0, 4.0], 1e-14);
    }

    #[test]
    fn the_identity_is_exact() {
        let f: Vec<f64> = (0..64).map(f64::from).collect();
        assert_all_close("f", &rotate(8, DQuat::IDENTITY, &f), &f, 1e-13);
    }

    #[test]
    fn bands_lie_where_the_layout_says() {
        let rotation = Rotation::from_quaternion(8, DQuat::from_rotation_y(0.4)).unwrap();
        assert_eq!(rotation.matrices().len(), 8 * (4 * 64 - 1) / 3);
        for l in 0..8 {
            assert_eq!(rotation.band(l).len(), (2 * l + 1) * (2 * l + 1));
            assert_eq!(rotation.band(l)[0], rotation.matrices()[band_start(l)]);
        }
        assert!(rotation.band(8).is_empty());
    }

    #[test]
    fn rgb_is_three_channels() {
        let rotation = Rotation::from_quaternion(2, DQuat::from_rotation_x(0.3)).unwrap();
        let plane = [1.0, -2.0, 0.5, 3.0];
        let mut expected = [0.0; 4];
        rotation.apply(&plane, &mut expected).unwrap();
        let rgb = rotation.apply_rgb(&plane.map(|c| [c, 2.0 * c, 0.0])).unwrap();
        for (actual, e) in rgb.iter().zip(expected) {
            assert_all_close("rgb", actual, &[e, 2.0 * e, 0.0], 1e-15);
        }
    }

    #[test]
    fn refuses_no_rotation_and_other_orders() {
        let zero = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
        assert!(matches!(Rotation::from_quaternion(3, zero), Err(MathError::Quaternion { .. })));
        for bad in [f64::NAN, f64::INFINITY] {
            let q = DQuat::from_xyzw(0.0, bad, 0.0, 1.0);
            assert!(matches!(Rotation::from_quaternion(3, q), Err(MathError::Quaternion { .. })));
        }
        for order in [0, 9] {
            assert_eq!(Rotation::from_quaternion(order, DQuat::IDENTITY), Err(MathError::Order { order }));
        }
        let rotation = Rotation::from_quaternion(2, DQuat::IDENTITY).unwrap();
        assert!(matches!(rotation.apply(&[0.0; 4], &mut [0.0; 3]), Err(MathError::Length { .. })));
        assert!(matches!(rotation.apply_rgb(&[[0.0; 3]; 5]), Err(MathError::Length { .. })));
    }
}
