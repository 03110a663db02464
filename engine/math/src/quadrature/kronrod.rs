//! Adaptive integration with an error estimate: the 7-point Gauss, 15-point Kronrod pair, always splitting
//! the interval of the largest error. Stands on Piessens et al., *QUADPACK* (1983), routine QAG.

use crate::MathError;

/// Kronrod nodes of [0, 1], descending, the pair's weights: Kronrod, then Gauss (zero where it has no node).
const NODES: [(f64, f64, f64); 8] = [
    (0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0),
    (0.949_107_912_342_758_5, 0.063_092_092_629_978_55, 0.129_484_966_168_869_7),
    (0.864_864_423_359_769_1, 0.104_790_010_322_250_18, 0.0),
    (0.741_531_185_599_394_4, 0.140_653_259_715_525_92, 0.279_705_391_489_276_7),
    (0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0),
    (0.405_845_151_377_397_2, 0.190_350_578_064_785_4, 0.381_830_050_505_118_9),
    (0.207_784_955_007_898_47, 0.204_432_940_075_298_9, 0.0),
    (0.0, 0.209_482_141_084_727_82, 0.417_959_183_673_469_4),
];

/// Intervals after which an integration is given up.
const MAX_INTERVALS: usize = 2000;

/// The result of an adaptive integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integral {
    /// The integral.
    pub value: f64,
    /// Estimated absolute error; for smooth integrands far above the true one.
    pub error: f64,
    /// How often the integrand was called.
    pub evaluations: usize,
}

/// `∫ f` from `a` to `b` (negative when `b < a`), until the estimated error is below `tolerance ∫|f|`.
///
/// The tolerance is thus relative, without losing its meaning when the integral is zero. `f` is not called
/// at the ends, so an integrable singularity may lie there.
///
/// # Errors
/// [`MathError::Range`] unless the bounds are finite and the tolerance is 1e-14 to 1; [`MathError::Integrand`]
/// when `f` is not finite; [`MathError::NoConvergence`] after 2000 intervals.
pub fn adaptive(
    mut f: impl FnMut(f64) -> f64,
    a: f64,
    b: f64,
    tolerance: f64,
) -> Result<Integral, MathError> {
    for (what, value) in [("the lower bound", a), ("the upper bound", b), ("the interval", b - a)] {
        if !value.is_finite() {
            return Err(MathError::Range { what, value, range: "a finite number" });
        }
    }
    if !(1e-14..=1.0).contains(&tolerance) {
        return Err(MathError::Range { what: "the tolerance", value: tolerance, range: "1e-14 to 1" });
    }
    let mut pieces = vec![Piece::new(&mut f, a, b)?];
    loop {
        let total = |part: fn(&Piece) -> f64| pieces.iter().map(part).sum::<f64>();
        let (value, error, absolute) = (total(|p| p.value), total(|p| p.error), total(|p| p.absolute));
        if error <= tolerance * absolute {
            return Ok(Integral { value, error, evaluations: 15 * (2 * pieces.len() - 1) });
        }
        let worst = (1..pieces.len()).fold(0, |w, i| if pieces[i].error > pieces[w].error { i } else { w });
        let piece = pieces[worst];
        let middle = 0.5 * (piece.a + piece.b);
        let indivisible = middle == piece.a || middle == piece.b;
        if indivisible || pieces.len() >= MAX_INTERVALS {
            return Err(MathError::NoConvergence { value, error });
        }
        pieces[worst] = Piece::new(&mut f, piece.a, middle)?;
        pieces.push(Piece::new(&mut f, middle, piece.b)?);
    }
}

/// One interval with its estimates.
#[derive(Clone, Copy)]
struct Piece {
    a: f64,
    b: f64,
    value: f64,
    error: f64,
    /// The integral of |f|.
    absolute: f64,
}

impl Piece {
    fn new(f: &mut impl FnMut(f64) -> f64, a: f64, b: f64) -> Result<Self, MathError> {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let (mut kronrod, mut gauss, mut absolute) = (0.0, 0.0, 0.0);
        let mut add = |x: f64, kronrod_weight: f64, gauss_weight: f64| {
            let y = f(x);
            if !y.is_finite() {
                return Err(MathError::Integrand { at: x });
            }
            kronrod += kronrod_weight * y;
            gauss += gauss_weight * y;
            absolute += kronrod_weight * y.abs();
            Ok(())
        };
        for (node, kronrod_weight, gauss_weight) in NODES {
            add(middle + half * node, kronrod_weight, gauss_weight)?;
            if node > 0.0 {
                add(middle - half * node, kronrod_weight, gauss_weight)?;
            }
        }
        let error = ((kronrod - gauss) * half).abs();
        Ok(Self { a, b, value: kronrod * half, error, absolute: absolute * half.abs() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::gauss_legendre;
    use crate::testing::assert_close;
    use std::f64::consts::PI;

    fn check(what: &str, f: impl FnMut(f64) -> f64, a: f64, b: f64, expected: f64) {
        let integral = adaptive(f, a, b, 1e-11).unwrap();
        assert_close(what, integral.value, expected, 1e-10 * expected.abs().max(1.0));
        let actual_error = (integral.value - expected).abs();
        assert!(
            actual_error <= integral.error + 1e-13,
            "{what}: {actual_error:e} > estimate {:e}",
            integral.error
        );
    }

    #[test]
    fn agrees_with_closed_forms() {
        check("exp", f64::exp, 0.0, 1.0, 1.0_f64.exp() - 1.0);
        check("reversed", f64::exp, 1.0, 0.0, 1.0 - 1.0_f64.exp());
        check("empty", f64::exp, 1.0, 1.0, 0.0);
        check("odd, zero", |x| x.powi(3) - x, -1.0, 1.0, 0.0);
        check("oscillating", |x| (100.0 * x).sin(), 0.0, PI / 2.0, 0.0);
        check("narrow peak", |x| 1e-4 / (x * x + 1e-8), -1.0, 1.0, 2.0 * 1e4_f64.atan());
        check("kink", |x| (x - 0.3).abs(), 0.0, 1.0, (0.09 + 0.49) / 2.0);
        check("singular end", |x| 1.0 / x.sqrt(), 0.0, 1.0, 2.0);
        check("logarithm", f64::ln, 0.0, 1.0, -1.0);
    }

    /// Fifteen Kronrod nodes integrate degree 22, and the Gauss half is the 7-point rule.
    #[test]
    fn the_pair_is_the_published_one() {
        for power in (0..=22).step_by(2) {
            let piece = Piece::new(&mut |x: f64| x.powi(power), -1.0, 1.0).unwrap();
            assert_close(&format!("x^{power}"), piece.value, 2.0 / f64::from(power + 1), 1e-15);
        }
        let mut gauss: Vec<(f64, f64)> = NODES.iter().filter(|n| n.2 > 0.0).map(|n| (n.0, n.2)).collect();
        gauss.reverse();
        for ((node, weight), (expected_node, expected_weight)) in
            gauss.into_iter().zip(gauss_legendre(7).unwrap().into_iter().skip(3))
        {
            assert_close("node", node, expected_node, 1e-15);
            assert_close("weight", weight, expected_weight, 1e-15);
        }
    }

    #[test]
    fn refuses_what_it_cannot_integrate() {
        assert!(matches!(adaptive(|x| x, 0.0, f64::INFINITY, 1e-6), Err(MathError::Range { .. })));
        assert!(matches!(adaptive(|x| x, f64::NAN, 1.0, 1e-6), Err(MathError::Range { .. })));
        assert!(matches!(adaptive(|x| x, 0.0, 1.0, 0.0), Err(MathError::Range { .. })));
        assert_eq!(adaptive(|x| 1.0 / x, -1.0, 1.0, 1e-6), Err(MathError::Integrand { at: 0.0 }));
        // Divergent: halving towards the pole ends where 1/x overflows.
        assert!(matches!(adaptive(|x| 1.0 / x, 0.0, 1.0, 1e-6), Err(MathError::Integrand { .. })));
        let too_many_waves = adaptive(|x| (1e6 * x).sin(), 0.0, 1.0, 1e-6);
        assert!(matches!(too_many_waves, Err(MathError::NoConvergence { .. })), "{too_many_waves:?}");
    }
}
