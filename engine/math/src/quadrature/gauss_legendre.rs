//! Gauss-Legendre rules by Newton's iteration on the Legendre polynomial (Press et al., *Numerical Recipes*,
//! section 4.6), and the product rule they give on the sphere.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::MathError;

/// The largest rule; its nodes cost O(n²) operations.
pub const MAX_POINTS: usize = 10_000;

/// Nodes (ascending, in (-1, 1)) and weights (of sum 2) of the rule of `n` points, which is exact for
/// polynomials of degree 2n - 1.
///
/// # Errors
/// [`MathError::Range`] unless `n` is 1 to [`MAX_POINTS`].
pub fn gauss_legendre(n: usize) -> Result<Vec<(f64, f64)>, MathError> {
    if n == 0 || n > MAX_POINTS {
        return Err(MathError::Range { what: "the number of points", value: n as f64, range: "1 to 10000" });
    }
    let mut rule = vec![(0.0, 0.0); n];
    for i in 0..n.div_ceil(2) {
        let (node, weight) = node(n, i);
        rule[i] = (-node, weight);
        rule[n - 1 - i] = (node, weight);
    }
    Ok(rule)
}

/// The i-th largest node, and its weight; `i` is below half of n, rounded up.
fn node(n: usize, i: usize) -> (f64, f64) {
    let mut x = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
    if 2 * i + 1 == n {
        x = 0.0; // the middle one, exactly
    }
    // Newton converges quadratically from this start: 3 or 4 steps; the bound only guards against a cycle in
    // the last bit.
    for _ in 0..10 {
        let (value, slope) = legendre(n, x);
        let step = value / slope;
        x -= step;
        if step.abs() < 1e-15 {
            break;
        }
    }
    let (_, slope) = legendre(n, x);
    (x, 2.0 / ((1.0 - x * x) * slope * slope))
}

/// `P_n(x)` and its derivative, for |x| < 1.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut below, mut value) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (below, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * below) / k);
    }
    (value, n as f64 * (below - x * value) / (1.0 - x * x))
}

/// Unit directions and weights (of sum 4 pi) of a rule on the sphere that is exact for polynomials in x, y, z
/// up to `degree`: Gauss-Legendre in z times equal steps in the azimuth.
///
/// # Errors
/// [`MathError::Range`] for a degree above 2000 (two million directions).
pub fn sphere(degree: usize) -> Result<Vec<(DVec3, f64)>, MathError> {
    if degree > 2000 {
        let (what, value) = ("the degree of a rule on the sphere", degree as f64);
        return Err(MathError::Range { what, value, range: "0 to 2000" });
    }
    let columns = degree + 1;
    let step = TAU / columns as f64;
    let mut rule = Vec::with_capacity(columns * (degree / 2 + 1));
    for (z, weight) in gauss_legendre(degree / 2 + 1)? {
        let radius = ((1.0 - z) * (1.0 + z)).sqrt();
        for column in 0..columns {
            let (sine, cosine) = ((column as f64 + 0.5) * step).sin_cos();
            rule.push((DVec3::new(radius * cosine, radius * sine, z), weight * step));
        }
    }
    Ok(rule)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::assert_close;

    #[test]
    fn integrates_polynomials_exactly() {
        for n in [1, 2, 3, 7, 10, 31, 64] {
            let rule = gauss_legendre(n).unwrap();
            for power in 0..2 * n {
                let sum: f64 = rule.iter().map(|(x, w)| w * x.powi(power as i32)).sum();
                let expected = if power % 2 == 0 { 2.0 / (power + 1) as f64 } else { 0.0 };
                assert_close(&format!("x^{power} by {n} points"), sum, expected, 1e-14);
            }
        }
    }

    #[test]
    fn nodes_of_two_and_three_points_are_the_closed_forms() {
        let two = gauss_legendre(2).unwrap();
        assert_close("node", two[1].0, (1.0_f64 / 3.0).sqrt(), 1e-15);
        assert_close("weight", two[1].1, 1.0, 1e-15);
        let three = gauss_legendre(3).unwrap();
        assert_close("node", three[0].0, -(0.6_f64).sqrt(), 1e-15);
        assert_close("middle node", three[1].0, 0.0, 0.0);
        assert_close("middle weight", three[1].1, 8.0 / 9.0, 1e-15);
    }

    #[test]
    fn large_rules_stay_accurate() {
        for n in [1000, 4001] {
            let rule = gauss_legendre(n).unwrap();
            assert!(rule.windows(2).all(|pair| pair[0].0 < pair[1].0), "{n}: nodes do not ascend");
            let sum: f64 = rule.iter().map(|(x, w)| w * x.exp()).sum();
            assert_close("integral of exp", sum, 1.0_f64.exp() - (-1.0_f64).exp(), 1e-12);
        }
    }

    #[test]
    fn the_sphere_rule_is_exact_for_monomials() {
        // ∫ x^a y^b z^c = 2 G((a+1)/2) G((b+1)/2) G((c+1)/2) / G((a+b+c+3)/2) for even powers.
        let expected = [([0, 0, 0], 4.0 * PI), ([2, 0, 0], 4.0 * PI / 3.0), ([0, 2, 2], 4.0 * PI / 15.0)];
        let more = [([2, 2, 2], 4.0 * PI / 105.0), ([0, 0, 6], 4.0 * PI / 7.0), ([1, 2, 3], 0.0)];
        let rule = sphere(6).unwrap();
        for ([a, b, c], integral) in expected.into_iter().chain(more) {
            let sum: f64 = rule.iter().map(|(d, w)| w * d.x.powi(a) * d.y.powi(b) * d.z.powi(c)).sum();
            assert_close(&format!("x^{a} y^{b} z^{c}"), sum, integral, 1e-14);
        }
    }

    #[test]
    fn refuses_no_points_and_too_many() {
        assert!(matches!(gauss_legendre(0), Err(MathError::Range { .. })));
        assert!(matches!(gauss_legendre(MAX_POINTS + 1), Err(MathError::Range { .. })));
        assert!(matches!(sphere(2001), Err(MathError::Range { .. })));
    }
}
