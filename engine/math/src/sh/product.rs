//! Products of functions given by spherical-harmonic coefficients.
//!
//! Stands on Sloan, Kautz, Snyder, "Precomputed Radiance Transfer" (SIGGRAPH 2002), and Snyder, "Code
//! Generation and Factoring for Fast Evaluation of Low-order Spherical Harmonic Products and Squares" (2006):
//! the tensor `gamma_ijk = ∫ Y_i Y_j Y_k` over the sphere. Here it is integrated by a rule that is exact for
//! these polynomials.

use super::{check_order, coefficient_count, evaluate};
use crate::MathError;
use crate::error::check_length;
use crate::quadrature::sphere;

/// Integrals smaller than this are zero by symmetry and hold only rounding.
const ROUNDING: f64 = 1e-12;

/// One non-zero entry of the triple-product tensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Index of the first factor, below `order²`.
    pub i: u32,
    /// Index of the second factor, below `order²`.
    pub j: u32,
    /// Index of the result, below `order²`.
    pub k: u32,
    /// `∫ Y_i Y_j Y_k` over the sphere.
    pub gamma: f64,
}

/// The sparse triple-product tensor of one order: both factors and the result have that order.
#[derive(Clone, Debug, PartialEq)]
pub struct TripleProduct {
    order: usize,
    entries: Vec<Entry>,
}

impl TripleProduct {
    /// Integrates the tensor; at order 8 about ten milliseconds, so make it once and keep it.
    ///
    /// # Errors
    /// [`MathError::Order`].
    pub fn new(order: usize) -> Result<Self, MathError> {
        check_order(order)?;
        let n = coefficient_count(order);
        let tensor = integrate(order)?;
        let mut entries = Vec::new();
        for k in 0..n {
            for i in 0..n {
                for j in 0..n {
                    let mut sorted = [i, j, k];
                    sorted.sort_unstable();
                    let gamma = tensor[place(sorted)];
                    if gamma.abs() >= ROUNDING {
                        entries.push(Entry { i: i as u32, j: j as u32, k: k as u32, gamma });
                    }
                }
            }
        }
        Ok(Self { order, entries })
    }

    /// The order given at creation.
    #[must_use]
    pub fn order(&self) -> usize {
        self.order
    }

    /// All non-zero entries, every permutation of a triple for itself, sorted by k, then i, then j.
    #[must_use]
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Coefficients of `f g`, cut off at the order: `out_k = Σ gamma_ijk f_i g_j`.
    ///
    /// # Errors
    /// [`MathError::Length`] unless all three hold `order²` values.
    pub fn product(&self, f: &[f64], g: &[f64], out: &mut [f64]) -> Result<(), MathError> {
        let n = coefficient_count(self.order);
        check_length("the first factor", n, f.len())?;
        check_length("the second factor", n, g.len())?;
        check_length("the product", n, out.len())?;
        out.fill(0.0);
        for entry in &self.entries {
            out[entry.k as usize] += entry.gamma * f[entry.i as usize] * g[entry.j as usize];
        }
        Ok(())
    }

    /// The symmetric matrix that multiplies by `f`: `M_kj = Σ_i gamma_ijk f_i`, row-major, `order²` squared.
    ///
    /// # Errors
    /// [`MathError::Length`] unless `f` holds `order²` values.
    pub fn matrix(&self, f: &[f64]) -> Result<Vec<f64>, MathError> {
        let n = coefficient_count(self.order);
        check_length("the factor", n, f.len())?;
        let mut matrix = vec![0.0; n * n];
        for entry in &self.entries {
            matrix[entry.k as usize * n + entry.j as usize] += entry.gamma * f[entry.i as usize];
        }
        Ok(matrix)
    }
}

/// Position of a sorted triple `a <= b <= c` in the packed symmetric tensor.
fn place([a, b, c]: [usize; 3]) -> usize {
    c * (c + 1) * (c + 2) / 6 + b * (b + 1) / 2 + a
}

/// The symmetric tensor, one value per sorted triple, by a rule exact for the product of three harmonics.
fn integrate(order: usize) -> Result<Vec<f64>, MathError> {
    let n = coefficient_count(order);
    let mut tensor = vec![0.0; place([0, 0, n])];
    let mut basis = vec![0.0; n];
    for (direction, weight) in sphere(3 * (order - 1))? {
        evaluate(order, direction, &mut basis)?;
        let mut values = tensor.iter_mut();
        for c in 0..n {
            for b in 0..=c {
                let outer = weight * basis[c] * basis[b];
                for (value, y) in values.by_ref().take(b + 1).zip(&basis) {
                    *value += outer * y;
                }
            }
        }
    }
    Ok(tensor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sh::{index, project, reconstruct};
    use crate::testing::{assert_all_close, assert_close, coefficients};
    use proptest::prelude::*;
    use std::f64::consts::PI;

    #[test]
    fn has_the_known_number_of_entries() {
        for (order, expected) in (1..).zip([1, 10, 83, 353, 1158, 2907, 6460, 12868]) {
            assert_eq!(TripleProduct::new(order).unwrap().entries().len(), expected, "order {order}");
        }
    }

    #[test]
    fn no_entry_lies_near_the_threshold() {
        let smallest =
            TripleProduct::new(8).unwrap().entries().iter().map(|e| e.gamma.abs()).fold(1.0, f64::min);
        assert!(smallest > 1e-4, "smallest |gamma| {smallest:e}");
    }

    /// ∫ Y_00 Y_10² and ∫ Y_10² Y_20 in closed form.
    #[test]
    fn agrees_with_closed_forms() {
        let product = TripleProduct::new(3).unwrap();
        let gamma = |i: usize, j: usize, k: usize| {
            let found = product.entries().iter().find(|e| [e.i, e.j, e.k] == [i as u32, j as u32, k as u32]);
            found.unwrap().gamma
        };
        let (dc, linear, quadratic) = (index(0, 0), index(1, 0), index(2, 0));
        assert_close("gamma", gamma(dc, linear, linear), 0.5 / PI.sqrt(), 1e-15);
        assert_close("gamma", gamma(linear, linear, quadratic), 1.0 / (5.0 * PI).sqrt(), 1e-15);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn product_with_one_is_identity(f in coefficients(4)) {
            let mut one = vec![0.0; 16];
            one[0] = (4.0 * PI).sqrt();
            let mut out = vec![0.0; 16];
            TripleProduct::new(4).unwrap().product(&f, &one, &mut out).unwrap();
            assert_all_close("f * 1", &out, &f, 1e-13);
        }

        #[test]
        fn is_the_projection_of_the_pointwise_product(f in coefficients(4), g in coefficients(4)) {
            let pointwise = |d| reconstruct(4, &f, d).unwrap() * reconstruct(4, &g, d).unwrap();
            let mut out = vec![0.0; 16];
            TripleProduct::new(4).unwrap().product(&f, &g, &mut out).unwrap();
            assert_all_close("f g", &out, &project(4, 9, pointwise).unwrap(), 1e-13);
        }

        #[test]
        fn the_matrix_is_symmetric_and_multiplies(f in coefficients(3), g in coefficients(3)) {
            let triple = TripleProduct::new(3).unwrap();
            let matrix = triple.matrix(&f).unwrap();
            let mut expected = vec![0.0; 9];
            triple.product(&f, &g, &mut expected).unwrap();
            let actual: Vec<f64> =
                matrix.chunks(9).map(|row| row.iter().zip(&g).map(|(m, g)| m * g).sum()).collect();
            assert_all_close("M g", &actual, &expected, 1e-14);
            for (i, j) in (0..9).flat_map(|i| (0..9).map(move |j| (i, j))) {
                assert_close("M_ij", matrix[i * 9 + j], matrix[j * 9 + i], 1e-15);
            }
        }
    }

    #[test]
    fn refuses_other_orders_and_lengths() {
        assert_eq!(TripleProduct::new(0), Err(MathError::Order { order: 0 }));
        assert_eq!(TripleProduct::new(9), Err(MathError::Order { order: 9 }));
        let product = TripleProduct::new(2).unwrap();
        assert!(matches!(
            product.product(&[0.0; 4], &[0.0; 3], &mut [0.0; 4]),
            Err(MathError::Length { .. })
        ));
        assert!(matches!(product.matrix(&[0.0; 5]), Err(MathError::Length { .. })));
    }
}
