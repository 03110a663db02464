//! The optimal linear exponential: two numbers by the norm of the vector, fitted to single spheres.
//!
//! Ren et al. 2006 (Sun 2008, end of section 5.2.2). With `g` the visibility of a circle, `f` its logarithm, `f^` that
//! without its mean, and `g' = exp(-f_0 / sqrt(4 pi)) g`: `a = g'_0 / sqrt(4 pi)` and `b = g' . f^ / |f^|^2` are the
//! least squares of `a 1 + b f^ = g'`.

use std::f64::consts::FRAC_PI_2;

use crate::ShadowError;
use crate::circle;
use crate::logarithm::{CLIP, Logarithm};
use crate::mean::{ONE, without_mean};

/// Angular radii the fit is made at.
const ANGLES: usize = 256;

/// `a` and `b` over the norm, as far as the norm of a circle's logarithm grows with its radius.
#[derive(Clone, Debug)]
pub struct Linear {
    /// Norm, a, b, by growing norm.
    rows: Vec<[f64; 3]>,
}

impl Linear {
    /// Fits the table of one order.
    ///
    /// # Errors
    /// [`ShadowError::Order`].
    pub fn new(order: usize) -> Result<Self, ShadowError> {
        let logarithm = Logarithm::new(order, CLIP)?;
        let mut rows = vec![[0.0, 1.0, 1.0]];
        for step in 1..=ANGLES {
            let height = circle::height(FRAC_PI_2 * step as f64 / ANGLES as f64)?;
            let visibility = circle::visibility(order, height)?;
            let f = logarithm.of_cap(height)?;
            let norm = without_mean(&f);
            if rows.last().is_some_and(|row| row[0] >= norm) {
                break;
            }
            let mean = (-f[0] / ONE).exp();
            let along: f64 = visibility.iter().zip(&f).skip(1).map(|(g, f)| g * f).sum();
            rows.push([norm, mean * visibility[0] / ONE, mean * along / (norm * norm)]);
        }
        Ok(Self { rows })
    }

    /// The largest norm of the table; beyond, its last entry holds.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.rows.last().map_or(0.0, |row| row[0])
    }

    /// a and b at a norm, linear between the entries.
    #[must_use]
    pub fn at(&self, norm: f64) -> [f64; 2] {
        let above = self.rows.partition_point(|row| row[0] < norm).clamp(1, self.rows.len() - 1);
        let ([low, a, b], [high, next_a, next_b]) = (self.rows[above - 1], self.rows[above]);
        let t = ((norm - low) / (high - low)).clamp(0.0, 1.0);
        [a + t * (next_a - a), b + t * (next_b - b)]
    }

    /// `a 1 + b f` for a vector without mean.
    pub(crate) fn apply(&self, f: &[f64]) -> Vec<f64> {
        let [a, b] = self.at(without_mean(f));
        let mut g: Vec<f64> = f.iter().map(|value| b * value).collect();
        g[0] += a * ONE;
        g
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of an independent table of order 4 (research notes on the authors' method, three decimals).
    #[test]
    fn order_4_has_the_known_values() {
        let linear = Linear::new(4).unwrap();
        for (norm, a, b) in
            [(0.5, 1.0091, 0.8765), (1.0, 1.0336, 0.7730), (2.0, 1.1165, 0.6265), (4.0, 1.3783, 0.4795)]
        {
            let found = linear.at(norm);
            assert!((found[0] - a).abs() < 8e-3 && (found[1] - b).abs() < 2e-3, "{norm}: {found:?}");
        }
        assert!((linear.end() - 6.47).abs() < 0.01, "{}", linear.end());
    }

    #[test]
    fn the_ends_hold_beyond_the_table() {
        for order in 3..=6 {
            let linear = Linear::new(order).unwrap();
            assert_eq!(linear.at(0.0), [1.0, 1.0]);
            assert_eq!(linear.at(100.0), linear.at(linear.end()));
        }
    }
}
