//! The exponential integral by its power series and its continued fraction (Abramowitz and Stegun, *Handbook of
//! Mathematical Functions*, 5.1.11 and 5.1.22).
//!
//! `exp(z) E1(z) = ∫ exp(-q) / (z + q) dq` over q >= 0, for z = w - i u in the closed quarter plane w, u >= 0. Both roads
//! carry the real part and the imaginary part divided by u, so that the latter keeps its relative precision as u -> 0.

use crate::MathError;

const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;

/// Where the continued fraction takes over from the power series.
const SERIES_RADIUS: f64 = 1.0;

/// `exp(z) E1(z)` at z = w - i u.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scaled {
    /// The real part, `∫ exp(-q) (w + q) / (u² + (w + q)²) dq`.
    pub real: f64,
    /// The imaginary part divided by u, `∫ exp(-q) / (u² + (w + q)²) dq`.
    pub imaginary_over_u: f64,
}

/// `exp(z) E1(z)` at `z = w - i u`, to about 1e-13 of each part.
///
/// # Errors
/// [`MathError::Range`] unless w and u are finite and not negative, and not both so small that 1/z² overflows.
pub fn scaled_exponential_integral(w: f64, u: f64) -> Result<Scaled, MathError> {
    for (what, value) in [("the real part of z", w), ("the negated imaginary part of z", u)] {
        if !(0.0..=1e300).contains(&value) {
            return Err(MathError::Range { what, value, range: "0 to 1e300" });
        }
    }
    let modulus = w.hypot(u);
    if modulus < 1e-150 {
        return Err(MathError::Range { what: "the modulus of z", value: modulus, range: "1e-150 or more" });
    }
    Ok(if modulus < SERIES_RADIUS { series(w, u, modulus) } else { continued_fraction(w, u, modulus) })
}

/// `E1(x)` of a real argument.
///
/// # Errors
/// [`MathError::Range`] unless x is 1e-150 to 1e300.
pub fn exponential_integral(x: f64) -> Result<f64, MathError> {
    Ok((-x).exp() * scaled_exponential_integral(x, 0.0)?.real)
}

/// `exp(z) (-gamma - ln z + Ein(z))`.
fn series(w: f64, u: f64, modulus: f64) -> Scaled {
    // Ein(z) = Σ -(-z)^k / (k k!), as real part a and imaginary part u b; power = (-z)^k / k!, likewise.
    let (mut a, mut b) = (0.0, 0.0);
    let mut power = (1.0, 0.0);
    for k in 1..=30 {
        let k = f64::from(k);
        power = ((-w * power.0 - u * u * power.1) / k, (power.0 - w * power.1) / k);
        a -= power.0 / k;
        b -= power.1 / k;
    }
    let real = a - EULER_GAMMA - modulus.ln();
    let angle_over_u = if u > 0.0 { u.atan2(w) / u } else { w.recip() };
    let imaginary_over_u = b + angle_over_u;
    // exp(z) = exp(w) (cos u - i u sinc u).
    let (cosine, sine_over_u) = (u.cos(), if u > 0.0 { u.sin() / u } else { 1.0 });
    Scaled {
        real: w.exp() * (cosine * real + u * u * sine_over_u * imaginary_over_u),
        imaginary_over_u: w.exp() * (cosine * imaginary_over_u - sine_over_u * real),
    }
}

/// `1 / (z + 1 - 1 / (z + 3 - 4 / (z + 5 - …)))`, from its far end: no step cancels in the imaginary part.
fn continued_fraction(w: f64, u: f64, modulus: f64) -> Scaled {
    // The error falls as exp(-4 √(n |z|) cos(π/4)).
    let depth = 20 + (200.0 / modulus) as u32;
    let (mut real, mut imaginary) = (0.0, 0.0);
    for k in (0..=depth).rev() {
        let square = f64::from(k + 1) * f64::from(k + 1);
        let (a, b) = (w + f64::from(2 * k + 1) - square * real, -1.0 - square * imaginary);
        // Divided twice rather than by a square that may overflow.
        let size = a.hypot(u * b);
        (real, imaginary) = (a / size / size, -b / size / size);
    }
    Scaled { real, imaginary_over_u: imaginary }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    use crate::quadrature::adaptive;
    use crate::testing::assert_close;
    use proptest::prelude::*;

    #[test]
    fn agrees_with_the_handbook() {
        // Table 5.1 of the handbook; beyond 2 it prints x exp(x) E1(x).
        for (x, expected) in [(0.1, 1.822_923_958_4), (0.5, 0.559_773_594_8), (1.0, 0.219_383_934_4)] {
            assert_close(&format!("E1({x})"), exponential_integral(x).unwrap(), expected, 1e-10);
        }
        let ten = 10.0 * scaled_exponential_integral(10.0, 0.0).unwrap().real;
        assert_close("10 exp(10) E1(10)", ten, 0.915_633_339_4, 1e-10);
    }

    /// The two integrals that define the parts, cut where the exponential is spent.
    fn by_quadrature(w: f64, u: f64) -> Scaled {
        let (mut real, mut imaginary_over_u) = (0.0, 0.0);
        let modulus = w.hypot(u);
        let (mut a, mut b) = (0.0, (0.5 * modulus).min(1.0));
        while a < 45.0 {
            let weight = |q: f64| (-q).exp() / (u * u + (w + q) * (w + q));
            imaginary_over_u += adaptive(weight, a, b, 1e-13).unwrap().value;
            real += adaptive(|q| (w + q) * weight(q), a, b, 1e-13).unwrap().value;
            (a, b) = (b, 2.0 * b);
        }
        Scaled { real, imaginary_over_u }
    }

    proptest! {
        #[test]
        fn agrees_with_quadrature(exponent in -8.0..3.0_f64, angle in 0.0..=FRAC_PI_2) {
            let modulus = 10_f64.powf(exponent);
            let (w, u) = (modulus * angle.cos().max(0.0), modulus * angle.sin());
            let (actual, expected) = (scaled_exponential_integral(w, u).unwrap(), by_quadrature(w, u));
            assert_close(&format!("real part at {w}, {u}"), actual.real / expected.real, 1.0, 1e-12);
            let ratio = actual.imaginary_over_u / expected.imaginary_over_u;
            assert_close(&format!("imaginary part at {w}, {u}"), ratio, 1.0, 1e-12);
        }
    }

    #[test]
    fn both_roads_agree_where_they_meet() {
        for angle in [0.0, 0.4, 1.0, FRAC_PI_2] {
            let (w, u) = (SERIES_RADIUS * angle.cos(), SERIES_RADIUS * angle.sin());
            let (a, b) = (series(w, u, SERIES_RADIUS), continued_fraction(w, u, SERIES_RADIUS));
            assert_close("real part", a.real, b.real, 1e-13);
            assert_close("imaginary part", a.imaginary_over_u, b.imaginary_over_u, 1e-13);
        }
    }

    #[test]
    fn keeps_its_precision_at_both_ends() {
        // As z -> infinity, exp(z) E1(z) -> 1/z; as z -> 0, the imaginary part -> its angle.
        let far = scaled_exponential_integral(1e200, 1e200).unwrap();
        assert_close("far", far.real * 2e200, 1.0, 1e-14);
        let near = scaled_exponential_integral(1e-20, 1e-30).unwrap();
        assert_close("near", near.imaginary_over_u * 1e-20, 1.0, 1e-14);
    }

    #[test]
    fn refuses_the_rest_of_the_plane() {
        for (w, u) in [(-1.0, 0.0), (0.0, -1.0), (f64::NAN, 1.0), (1.0, f64::INFINITY), (0.0, 0.0)] {
            let refused = scaled_exponential_integral(w, u);
            assert!(matches!(refused, Err(MathError::Range { .. })), "{w}, {u}: {refused:?}");
        }
    }
}
