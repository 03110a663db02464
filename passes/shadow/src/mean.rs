//! The mean of a function given by spherical harmonics, and what is left without it.

/// `sqrt(4 pi)`, the first coefficient of the constant 1.
pub(crate) const ONE: f64 = 3.544_907_701_811_032;

/// `|f^|`, the norm of all coefficients but the first.
pub(crate) fn without_mean(f: &[f64]) -> f64 {
    f.iter().skip(1).map(|value| value * value).sum::<f64>().sqrt()
}
