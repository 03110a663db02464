//! The exponential as the polynomial of the least degree that is near it wherever the product matrix has eigenvalues.
//!
//! `exp(M) 1` is a sum over eigenvalues (Sun 2008, eq. 5.31), so that a polynomial that is near the exponential on an
//! interval that holds them all serves as well as the series of eq. 5.22, with fewer products. Chebyshev's series of the
//! exponential on an interval has the coefficients of Bessel's functions (Abramowitz and Stegun, 9.6.34), which fall off
//! long before those of the powers do.

use std::f64::consts::PI;

use crate::ShadowError;
use crate::mean::ONE;
use crate::order::{MIN_ORDER, check_order};

/// Largest eigenvalue of the product matrix of a vector without mean and of norm 1, by order from 3 on, rounded up: no
/// eigenvalue of either sign is farther from the mean.
const BOUND: [f64; 4] = [0.4947, 0.6873, 0.8774, 1.0633];
/// Eigenvalues of sums of logarithms of visibility reach this far above 0: ringing.
const RINGING: f64 = 0.2;
/// Largest error of a polynomial, over the exponential at the upper end of its interval.
const TOLERANCE: f64 = 2e-3;
/// The part of it that half widths between those of the table have: an eighth of the square of `ln 2 / STEPS` times the
/// second derivative of `exp(half (t - 1))` by the logarithm of the half width, 0.31 at most.
const BETWEEN: f64 = 3e-4;
/// Half widths of an octave that have a polynomial.
const STEPS: usize = 8;
/// Octaves of half widths.
const OCTAVES: usize = 14;
/// The largest half width: that of the longest vector of order 6.
const WIDEST: f64 = 16.0;
/// The longest that a sum of logarithms may be without its mean; a longer one is scaled to it. Thirty spheres of 20 to 50
/// degrees all around come to 24 at order 6, and lose nothing.
const LONGEST: f64 = 15.0;
/// The highest that the upper end of an interval may be without [`RINGING`]'s bound: what a polynomial is off grows with its
/// exponential, here to [`TOLERANCE`] times 12. Only thirty such spheres come so high, to 2.7.
const HIGHEST: f64 = 2.5;
/// The excess that is taken for rounding and for what series and polynomials are off.
pub(crate) const EXCESS: f64 = 0.05;
/// Added to a mean, so that noise about 0 has no excess.
const NOISE: f64 = 0.02;
/// Floats of a polynomial's row: coefficients by growing power, the degree in the last.
pub const ROW: usize = 16;
/// Rows of the table.
pub const ROWS: usize = STEPS * OCTAVES + 1;

/// Where the eigenvalues of a vector's product matrix lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    /// Its upper end.
    pub top: f64,
    /// Half of its width.
    pub half: f64,
}

impl Interval {
    /// Of a vector with a mean, `f_0 / sqrt(4 pi)`, and a norm without it. Sums of logarithms of visibility keep below
    /// [`RINGING`], and so does the interval, but for half of the way up from the mean.
    ///
    /// # Errors
    /// [`ShadowError::Order`].
    pub(crate) fn new(order: usize, mean: f64, norm: f64) -> Result<Self, ShadowError> {
        check_order(order)?;
        let reach = BOUND[order - MIN_ORDER] * norm;
        let up = reach.min((RINGING - mean).max(0.5 * reach));
        Ok(Self { top: mean + up, half: 0.5 * (up + reach) })
    }
}

/// What a vector with a mean and a norm without it is scaled by, so that it is not longer than [`LONGEST`], and its interval
/// no higher than [`HIGHEST`].
///
/// # Errors
/// [`ShadowError::Order`].
pub(crate) fn shortening(order: usize, mean: f64, norm: f64) -> Result<f64, ShadowError> {
    check_order(order)?;
    let top = mean + 0.5 * BOUND[order - MIN_ORDER] * norm;
    Ok((LONGEST / norm.max(LONGEST)).min(HIGHEST / top.max(HIGHEST)))
}

/// The logarithm of the integral of a function's square over that of the function. That of a function from 0 to 1 is 0 at
/// most, and of its projection still less. The exponential of spheres that hide the same part of the sky has more: the
/// ringing beside it, a little above 1, counts once for each of them, and grows with their number. Near the logarithm of the
/// largest eigenvalue, once that outgrows all others.
pub(crate) fn excess(g: &[f64]) -> f64 {
    let square: f64 = g.iter().map(|value| value * value).sum();
    (square.max(1e-30) / (ONE * g[0].max(0.0) + NOISE * ONE * ONE)).ln()
}

/// A polynomial in `t` from -1 to 1 that stands for `exp(half (t - 1))`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Polynomial {
    /// The half width it is made for: what was asked for, but the least of the table at least.
    pub half: f64,
    /// By growing power; one more than the degree, 2 at least.
    pub coefficients: Vec<f64>,
}

impl Polynomial {
    /// For eigenvalues within a half width, of which [`WIDEST`] is the largest there is: of the two rows of the table next
    /// to it, so that it changes steadily, where its degree changes, too, and what moves does not step.
    pub(crate) fn for_half(half: f64) -> Self {
        let last = (ROWS - 1) as f64;
        let place = (STEPS as f64 * (half / WIDEST).log2() + last).clamp(0.0, last);
        let upper = (place.ceil() as usize).max(1);
        let share = place - (upper - 1) as f64;
        let (low, high) = (of_row(upper - 1), of_row(upper));
        let between =
            |(k, high): (usize, &f64)| share * high + (1.0 - share) * low.get(k).copied().unwrap_or_default();
        let coefficients = high.iter().enumerate().map(between).collect();
        Self { half: WIDEST * ((place - last) / STEPS as f64).exp2(), coefficients }
    }
}

/// The coefficients of a row of the table.
fn of_row(row: usize) -> Vec<f64> {
    let half = WIDEST * ((row as f64 - (ROWS - 1) as f64) / STEPS as f64).exp2();
    let series = chebyshev(half);
    let tail = |degree: usize| series.iter().skip(degree + 1).map(|value| value.abs()).sum::<f64>();
    let near = |degree: &usize| tail(*degree) <= TOLERANCE - BETWEEN;
    let degree = (1..ROW - 2).find(near).unwrap_or(ROW - 2);
    monomials(&series[..=degree])
}

/// The table that kernels read, [`ROWS`] times [`ROW`].
pub(crate) fn table() -> Vec<f32> {
    let mut table = vec![0.0; ROWS * ROW];
    for (row, values) in table.chunks_exact_mut(ROW).enumerate() {
        let coefficients = of_row(row);
        values.iter_mut().zip(&coefficients).for_each(|(value, c)| *value = *c as f32);
        values[ROW - 1] = (coefficients.len() - 1) as f32;
    }
    table
}

/// Coefficients of Chebyshev's series of `exp(half (t - 1))`: `2 exp(-half) I_k(half)`, half of it at k = 0, by the
/// trapezoidal rule over the angle, which is exact to rounding here.
fn chebyshev(half: f64) -> Vec<f64> {
    const POINTS: usize = 128;
    let coefficient = |k: usize| {
        let sum: f64 = (0..POINTS)
            .map(|i| {
                let angle = PI * (i as f64 + 0.5) / POINTS as f64;
                (half * (angle.cos() - 1.0)).exp() * (k as f64 * angle).cos()
            })
            .sum();
        sum / POINTS as f64 * if k == 0 { 1.0 } else { 2.0 }
    };
    (0..2 * ROW).map(coefficient).collect()
}

/// The powers of a sum of Chebyshev's polynomials.
fn monomials(series: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; series.len()];
    let (mut before, mut here) = (vec![0.0; series.len()], vec![0.0; series.len()]);
    here[0] = 1.0;
    for (k, coefficient) in series.iter().enumerate() {
        sum.iter_mut().zip(&here).for_each(|(sum, value)| *sum += coefficient * value);
        // T_{k+1} = 2 t T_k - T_{k-1}, and T_1 = t.
        let factor = if k == 0 { 1.0 } else { 2.0 };
        let shifted = |i: usize| if i == 0 { 0.0 } else { factor * here[i - 1] };
        let next = (0..series.len()).map(|i| shifted(i) - before[i]).collect();
        before = std::mem::replace(&mut here, next);
    }
    sum
}

/// `f` as `t`, its eigenvalues from -1 to 1.
pub(crate) fn normalized(f: &[f64], interval: Interval, half: f64) -> Vec<f64> {
    let mut t: Vec<f64> = f.iter().map(|value| value / half).collect();
    t[0] -= (interval.top / half - 1.0) * ONE;
    t
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eigen;
    use airglow_math::sh::product::TripleProduct;

    #[test]
    fn the_bound_of_eigenvalues_holds_and_is_reached() {
        for order in MIN_ORDER..=6 {
            let tensor = TripleProduct::new(order).unwrap();
            let count = order * order;
            let mut largest = 0.0_f64;
            for start in 1..4 {
                let mut f: Vec<f64> = (0..count).map(|i| ((i * i * start + 3) % 11) as f64 - 5.0).collect();
                // The vector that a quadratic form is largest with, for the eigenvector of the one before.
                for _ in 0..60 {
                    f[0] = 0.0;
                    let norm = f.iter().map(|value| value * value).sum::<f64>().sqrt();
                    f.iter_mut().for_each(|value| *value /= norm);
                    let pairs = eigen::symmetric(count, &tensor.matrix(&f).unwrap());
                    let (value, vector) =
                        pairs.into_iter().reduce(|a, b| if b.0 > a.0 { b } else { a }).unwrap();
                    largest = largest.max(value);
                    tensor.product(&vector, &vector, &mut f).unwrap();
                }
            }
            let bound = BOUND[order - MIN_ORDER];
            assert!(largest <= bound && largest > bound - 2e-4, "order {order}: {largest} and {bound}");
        }
    }

    #[test]
    fn the_longest_vector_has_a_polynomial_and_a_visibility_no_excess() {
        for order in MIN_ORDER..=6 {
            let interval = Interval::new(order, 1e3, LONGEST).unwrap();
            assert!(interval.half <= WIDEST, "order {order}: {}", interval.half);
            for height in [0.0, 1e-3, 0.1, 0.5, 1.0] {
                let mut g = vec![0.0; order * order];
                let zonal = crate::circle::visibility(order, height).unwrap();
                zonal.iter().enumerate().for_each(|(l, value)| g[l * (l + 1)] = *value);
                assert!(excess(&g) <= 0.0, "order {order}, {height}: {}", excess(&g));
            }
        }
    }

    #[test]
    fn polynomials_are_near_the_exponential() {
        for half in [0.0, 0.01, 0.3, 1.0, 2.7, 7.9, 16.0] {
            let Polynomial { half: made, coefficients } = Polynomial::for_half(half);
            assert!((made - half).abs() < 2e-3 && coefficients.len() >= 2, "{made} for {half}");
            for step in 0..=40 {
                let t = f64::from(step) / 20.0 - 1.0;
                let found = coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c);
                let truth = (made * (t - 1.0)).exp();
                assert!((found - truth).abs() <= 1.01 * TOLERANCE, "{half} at {t}: {found} and {truth}");
            }
        }
        // Steadily, over every row and the steps of the degree at some.
        for row in 1..ROWS - 1 {
            let half = WIDEST * ((row as f64 - (ROWS - 1) as f64) / STEPS as f64).exp2();
            let [before, after] = [1.0 - 1e-6, 1.0 + 1e-6].map(|factor| Polynomial::for_half(factor * half));
            let at = |polynomial: &Polynomial, t: f64| {
                polynomial.coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c)
            };
            for t in [-1.0, -0.3, 0.8, 1.0] {
                let step = (at(&after, t) - at(&before, t)).abs();
                assert!(step < 1e-5, "{half} at {t}: {step:e}");
            }
        }
        let degrees = table().chunks(ROW).map(|row| row[ROW - 1]).collect::<Vec<_>>();
        assert!(degrees[0] == 1.0 && degrees.windows(2).all(|pair| pair[0] <= pair[1]), "{degrees:?}");
    }
}
