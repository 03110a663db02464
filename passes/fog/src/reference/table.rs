//! The thesis's own evaluator: the table of F(u, v), or of F^k for a power of the phase function's cosine.
//!
//! Sun, thesis (2008), eq. 3.15, 3.16, 3.19 and section 3.5: u from 0 to 10, v from 0 to π/2, square, single precision.
//! It is here to be measured: it overflows where the viewer looks away from a distant light, and ends at u = 10.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use airglow_math::MathError;
use airglow_math::quadrature::gauss_legendre;

/// The largest u of the table.
pub const LARGEST_U: f64 = 10.0;

/// The most entries along a side.
pub const MAX_SIZE: usize = 1024;

/// How entries between the tabulated are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// The nearest one.
    Nearest,
    /// Linear in both coordinates.
    Bilinear,
}

/// `F^k(u, v) = ∫ cos^k(2 x) exp(-u tan x) dx` over x from 0 to v, tabulated.
#[derive(Clone, Debug)]
pub struct Table {
    size: usize,
    /// Row by row of u.
    values: Vec<f32>,
}

impl Table {
    /// The table of `size` by `size` entries for the power `k` of the cosine, 0 for the isotropic phase function.
    ///
    /// # Errors
    /// [`MathError::Size`] unless 2 to [`MAX_SIZE`].
    pub fn new(size: usize, power: u32) -> Result<Self, MathError> {
        if !(2..=MAX_SIZE).contains(&size) {
            let what = "a table of F";
            return Err(MathError::Size { what, width: size, height: size, limit: MAX_SIZE });
        }
        let rule = gauss_legendre(24)?;
        let step = FRAC_PI_2 / (size - 1) as f64;
        let mut values = Vec::with_capacity(size * size);
        for row in 0..size {
            let u = LARGEST_U * row as f64 / (size - 1) as f64;
            let integrand = |x: f64| (2.0 * x).cos().powi(power as i32) * (-u * x.tan()).exp();
            let mut sum = 0.0;
            values.push(0.0);
            for column in 1..size {
                let middle = step * (column as f64 - 0.5);
                let cell: f64 = rule.iter().map(|(x, w)| w * integrand(middle + 0.5 * step * x)).sum();
                sum += 0.5 * step * cell;
                values.push(sum as f32);
            }
        }
        Ok(Self { size, values })
    }

    /// The tabulated value; arguments beyond the table are moved to its edge.
    #[must_use]
    pub fn value(&self, u: f32, v: f32, filter: Filter) -> f32 {
        let last = (self.size - 1) as f32;
        let (x, y) = (v / FRAC_PI_2 as f32 * last, u / LARGEST_U as f32 * last);
        let (x, y) = (x.clamp(0.0, last), y.clamp(0.0, last));
        let at = |row: usize, column: usize| self.values[row * self.size + column];
        if filter == Filter::Nearest {
            return at(y.round() as usize, x.round() as usize);
        }
        let (column, row) = ((x as usize).min(self.size - 2), (y as usize).min(self.size - 2));
        let (x, y) = (x - column as f32, y - row as f32);
        let mix = |a: f32, b: f32| a + x * (b - a);
        let (low, high) =
            (mix(at(row, column), at(row, column + 1)), mix(at(row + 1, column), at(row + 1, column + 1)));
        low + y * (high - low)
    }

    /// Eq. 3.16 in single precision, as a shader would run it: `∫ cos^k exp(-β (x + d)) / d² dx` in 1/m, for a light at
    /// `distance` metres and `gamma` radians, up to `far` metres. May overflow, or be negative.
    #[must_use]
    pub fn airlight(&self, extinction: f32, distance: f32, gamma: f32, far: f32, filter: Filter) -> f32 {
        let (t, t_far) = (extinction * distance, extinction * far);
        let (sine, cosine) = gamma.sin_cos();
        let amplitude = 2.0 * extinction * (-t * cosine).exp() / (t * sine);
        let v = (FRAC_PI_4 as f32) + 0.5 * ((t_far - t * cosine) / (t * sine)).atan();
        let value = |v| self.value(t * sine, v, filter);
        amplitude * (value(v) - value(0.5 * gamma))
    }

    /// The entries, row by row of u, v along a row.
    #[must_use]
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// Bytes of the table.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(self.values.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use airglow_math::quadrature::adaptive;

    use super::super::airlight::{Sight, airlight};
    use super::super::testing::assert_relative;
    use super::*;
    use crate::Phase;

    #[test]
    fn entries_are_the_integral() {
        for power in 0..4 {
            let table = Table::new(17, power).unwrap();
            for (row, column) in [(0, 16), (1, 5), (8, 16), (16, 2), (16, 16)] {
                let (u, v) = (10.0 * row as f64 / 16.0, FRAC_PI_2 * column as f64 / 16.0);
                let integrand = |x: f64| (2.0 * x).cos().powi(power as i32) * (-u * x.tan()).exp();
                let expected = adaptive(integrand, 0.0, v, 1e-12).unwrap().value;
                let actual = f64::from(table.value(u as f32, v as f32, Filter::Nearest));
                let difference = (actual - expected).abs();
                assert!(difference < 2e-7, "F^{power}({u}, {v}): {actual:e} is not {expected:e}");
            }
        }
    }

    #[test]
    fn finer_tables_come_closer_to_the_airlight() {
        let truth = airlight(0.5, Sight::new(3.0, 0.8), 0.0, 7.0, Phase::Isotropic).unwrap();
        let error = |size, filter| {
            let table = Table::new(size, 0).unwrap();
            let actual = f64::from(table.airlight(0.5, 3.0, 0.8, 7.0, filter)) * 0.25 / PI;
            (actual / truth - 1.0).abs()
        };
        let (coarse, fine) = (error(16, Filter::Bilinear), error(256, Filter::Bilinear));
        assert!(coarse < 0.2 && fine < 5e-4, "16: {coarse:e}, 256: {fine:e}");
        assert!(error(64, Filter::Nearest) > error(64, Filter::Bilinear));
    }

    #[test]
    fn powers_of_the_cosine_are_those_of_the_reference() {
        let weights = [0.02, 0.03, 0.05, 0.01];
        let sight = Sight::new(3.0, 1.1);
        let expected = airlight(0.5, sight, 0.0, 7.0, Phase::Polynomial(weights)).unwrap();
        let actual: f64 = (0..4)
            .map(|k| {
                let table = Table::new(512, k).unwrap();
                weights[k as usize] * f64::from(table.airlight(0.5, 3.0, 1.1, 7.0, Filter::Bilinear))
            })
            .sum();
        assert_relative("four powers", actual, expected, 1e-3);
    }

    #[test]
    fn refuses_sizes_that_are_none() {
        assert!(Table::new(1, 0).is_err() && Table::new(MAX_SIZE + 1, 0).is_err());
    }
}
