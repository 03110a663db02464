//! Evaluation of the real spherical-harmonic basis.
//!
//! Stands on the stable recursion of Press et al., *Numerical Recipes*, section 6.7 (normalised Legendre
//! functions, upwards in the band), with sin^m(theta) e^{i m phi} grown as powers of `x + iy` as in Sloan,
//! "Efficient Spherical Harmonic Evaluation" (JCGT 2013), so that no angle and no pole needs care.

use std::ops::{Add, Mul, Sub};

use glam::{DVec3, Vec3};

use super::{MAX_ORDER, check_order, coefficient_count};
use crate::MathError;
use crate::error::check_length;

/// Values of the basis at a direction, in f64.
///
/// `direction` must have unit length: it is not normalised here, and a longer or shorter one yields the
/// basis' polynomials at that point, which are no harmonics. NaN in, NaN out. `out` receives `order²` values.
///
/// # Errors
/// [`MathError::Order`]; [`MathError::Length`] unless `out` holds `order²` values.
pub fn evaluate(order: usize, direction: DVec3, out: &mut [f64]) -> Result<(), MathError> {
    evaluate_as(order, direction.to_array(), out)
}

/// Values of the basis at a direction, in f32; otherwise as [`evaluate`].
///
/// # Errors
/// As [`evaluate`].
pub fn evaluate_f32(order: usize, direction: Vec3, out: &mut [f32]) -> Result<(), MathError> {
    evaluate_as(order, direction.to_array(), out)
}

/// Factors of the recursion in the band l at fixed m, for `K_l^m(z)`, the harmonic divided by
/// `Re (x+iy)^m`: `K_l = first[l][m] z K_{l-1} - second[l][m] K_{l-2}`, starting from `K_m = start[m]`.
struct Recursion<T> {
    start: [T; MAX_ORDER],
    first: [[T; MAX_ORDER]; MAX_ORDER],
    second: [[T; MAX_ORDER]; MAX_ORDER],
}

const RECURSION: Recursion<f64> = {
    let mut start = [0.0; MAX_ORDER];
    let mut first = [[0.0; MAX_ORDER]; MAX_ORDER];
    let mut second = [[0.0; MAX_ORDER]; MAX_ORDER];
    start[0] = sqrt(0.25 * std::f64::consts::FRAC_1_PI);
    let mut m = 0;
    while m < MAX_ORDER {
        if m > 0 {
            let m_ = m as f64;
            // The sqrt(2) of the real basis enters once, between m = 0 and m = 1.
            let real = if m == 1 { 2.0 } else { 1.0 };
            start[m] = -sqrt(real * (2.0 * m_ + 1.0) / (2.0 * m_)) * start[m - 1];
        }
        let mut l = m + 1;
        while l < MAX_ORDER {
            let (l2, m2, below2) = ((l * l) as f64, (m * m) as f64, ((l - 1) * (l - 1)) as f64);
            first[l][m] = sqrt((4.0 * l2 - 1.0) / (l2 - m2));
            second[l][m] = first[l][m] * sqrt((below2 - m2) / (4.0 * below2 - 1.0).abs());
            l += 1;
        }
        m += 1;
    }
    Recursion { start, first, second }
};

const RECURSION_F32: Recursion<f32> = {
    let mut narrow = Recursion {
        start: [0.0; MAX_ORDER],
        first: [[0.0; MAX_ORDER]; MAX_ORDER],
        second: [[0.0; MAX_ORDER]; MAX_ORDER],
    };
    let mut l = 0;
    while l < MAX_ORDER {
        narrow.start[l] = RECURSION.start[l] as f32;
        let mut m = 0;
        while m < MAX_ORDER {
            narrow.first[l][m] = RECURSION.first[l][m] as f32;
            narrow.second[l][m] = RECURSION.second[l][m] as f32;
            m += 1;
        }
        l += 1;
    }
    narrow
};

/// Square root at compile time, by Newton's iteration from above; within an ulp for the ratios used here.
const fn sqrt(x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    let mut root = if x > 1.0 { x } else { 1.0 };
    loop {
        let next = 0.5 * (root + x / root);
        if next >= root {
            return root;
        }
        root = next;
    }
}

/// The two float types the basis is evaluated in.
trait Real: Copy + Add<Output = Self> + Mul<Output = Self> + Sub<Output = Self> + 'static {
    const ZERO: Self;
    const ONE: Self;
    const RECURSION: &'static Recursion<Self>;
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const RECURSION: &'static Recursion<Self> = &RECURSION;
}

impl Real for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const RECURSION: &'static Recursion<Self> = &RECURSION_F32;
}

fn evaluate_as<T: Real>(order: usize, [x, y, z]: [T; 3], out: &mut [T]) -> Result<(), MathError> {
    check_order(order)?;
    check_length("the basis output", coefficient_count(order), out.len())?;
    let Recursion { start, first, second } = T::RECURSION;
    let (mut cosine, mut sine) = (T::ONE, T::ZERO); // real and imaginary part of (x + iy)^m
    for m in 0..order {
        let (mut below, mut value) = (T::ZERO, start[m]);
        for l in m..order {
            if l > m {
                (below, value) = (value, first[l][m] * z * value - second[l][m] * below);
            }
            out[l * (l + 1) - m] = value * sine;
            out[l * (l + 1) + m] = value * cosine; // after the sine, which for m = 0 is the same place
        }
        (cosine, sine) = (x * cosine - y * sine, x * sine + y * cosine);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::sphere;
    use crate::testing::{assert_all_close, assert_close, direction};
    use proptest::prelude::*;
    use std::f64::consts::PI;

    /// Bands 0 to 3 as DirectXMath's SHMath writes them, from Sloan's "Stupid Spherical Harmonics Tricks"
    /// (2008), appendix A2.
    fn explicit(d: DVec3) -> [f64; 16] {
        let DVec3 { x, y, z } = d;
        let root = |a: f64| a.sqrt();
        [
            root(1.0 / (4.0 * PI)),
            -root(3.0 / (4.0 * PI)) * y,
            root(3.0 / (4.0 * PI)) * z,
            -root(3.0 / (4.0 * PI)) * x,
            root(15.0 / (4.0 * PI)) * x * y,
            -root(15.0 / (4.0 * PI)) * y * z,
            root(5.0 / (16.0 * PI)) * (3.0 * z * z - 1.0),
            -root(15.0 / (4.0 * PI)) * x * z,
            root(15.0 / (16.0 * PI)) * (x * x - y * y),
            -root(35.0 / (32.0 * PI)) * y * (3.0 * x * x - y * y),
            root(105.0 / (4.0 * PI)) * x * y * z,
            -root(21.0 / (32.0 * PI)) * y * (5.0 * z * z - 1.0),
            root(7.0 / (16.0 * PI)) * z * (5.0 * z * z - 3.0),
            -root(21.0 / (32.0 * PI)) * x * (5.0 * z * z - 1.0),
            root(105.0 / (16.0 * PI)) * z * (x * x - y * y),
            -root(35.0 / (32.0 * PI)) * x * (x * x - 3.0 * y * y),
        ]
    }

    proptest! {
        #[test]
        fn agrees_with_the_explicit_polynomials(d in direction()) {
            let mut basis = [0.0; 16];
            evaluate(4, d, &mut basis).unwrap();
            assert_all_close("Y", &basis, &explicit(d), 2e-15);
        }

        /// Unsöld's theorem: the squares of a band sum to (2l+1)/4pi.
        #[test]
        fn each_band_has_constant_energy(d in direction()) {
            let mut basis = [0.0; 64];
            evaluate(8, d, &mut basis).unwrap();
            for l in 0..8 {
                let energy: f64 = basis[l * l..(l + 1) * (l + 1)].iter().map(|y| y * y).sum();
                assert_close("band energy", energy, (2 * l + 1) as f64 / (4.0 * PI), 1e-13);
            }
        }

        #[test]
        fn single_precision_agrees(d in direction()) {
            let narrow = d.as_vec3();
            let (mut basis, mut basis_f32) = ([0.0; 64], [0.0; 64]);
            evaluate(8, narrow.as_dvec3(), &mut basis).unwrap();
            evaluate_f32(8, narrow, &mut basis_f32).unwrap();
            assert_all_close("Y", &basis_f32.map(f64::from), &basis, 5e-6);
        }
    }

    #[test]
    fn is_orthonormal() {
        let mut gram = vec![0.0; 64 * 64];
        let mut basis = [0.0; 64];
        for (d, weight) in sphere(14).unwrap() {
            evaluate(8, d, &mut basis).unwrap();
            for i in 0..64 {
                for j in 0..64 {
                    gram[i * 64 + j] += weight * basis[i] * basis[j];
                }
            }
        }
        for i in 0..64 {
            for j in 0..64 {
                let expected = f64::from(u8::from(i == j));
                assert_close(&format!("<Y_{i}, Y_{j}>"), gram[i * 64 + j], expected, 1e-13);
            }
        }
    }

    #[test]
    fn the_poles_need_no_care() {
        let mut basis = [f64::NAN; 64];
        for (pole, sign) in [(DVec3::Z, 1.0_f64), (DVec3::NEG_Z, -1.0)] {
            evaluate(8, pole, &mut basis).unwrap();
            for l in 0..8_usize {
                for m in -(l as isize)..=l as isize {
                    let zonal = sign.powi(l as i32) * ((2 * l + 1) as f64 / (4.0 * PI)).sqrt();
                    let expected = if m == 0 { zonal } else { 0.0 };
                    assert_close("Y at a pole", basis[crate::sh::index(l, m)], expected, 1e-14);
                }
            }
        }
    }

    #[test]
    fn refuses_other_orders_and_lengths() {
        assert_eq!(evaluate(0, DVec3::Z, &mut []), Err(MathError::Order { order: 0 }));
        assert_eq!(evaluate(9, DVec3::Z, &mut [0.0; 81]), Err(MathError::Order { order: 9 }));
        assert!(matches!(evaluate(2, DVec3::Z, &mut [0.0; 3]), Err(MathError::Length { .. })));
    }
}
