//! Exponentials of functions given by spherical harmonics, in f64.
//!
//! Sun 2008, section 5.2.2, after Ren et al. 2006. `*` is the product cut off at the order. All but the plain series set
//! the mean apart (eq. 5.25): `exp(f) = exp(f_0 / sqrt(4 pi)) exp(f^)`, and all that scale and square (eq. 5.26) put the
//! share of the mean into what is squared, so that nothing overflows on the way.

use airglow_math::sh::coefficient_count;
use airglow_math::sh::product::TripleProduct;

use crate::ShadowError;
use crate::eigen;
use crate::linear::Linear;
use crate::mean::{ONE, without_mean};
use crate::polynomial::{EXCESS, Interval, Polynomial, excess, normalized, shortening};

/// Largest degree of a series.
pub const MAX_DEGREE: usize = 32;

/// A way to the exponential.
#[derive(Default, Clone, Copy, Debug, PartialEq)]
pub enum Exponential {
    /// PS-p: the product series (eq. 5.22) of a degree, of the whole vector.
    Series {
        /// 1 to [`MAX_DEGREE`].
        degree: usize,
    },
    /// PS*-p: mean set apart, scaled to a norm of at most 1/8 (`p = max(0, ceil(log2 |f^| + 3))`), the factored series
    /// of eq. 5.27, squarings.
    ScaledSeries {
        /// 1 to [`MAX_DEGREE`].
        degree: usize,
    },
    /// Mean set apart, scaled to a norm of at most `norm`, the series of `degree` by Horner's rule, squarings.
    Horner {
        /// 1 to [`MAX_DEGREE`].
        degree: usize,
        /// Largest norm of what the series is given, above 0.
        norm: f64,
    },
    /// The default: by Horner's rule the polynomial of the least degree that is within 2e-3 of the exponential wherever
    /// the product matrix may have an eigenvalue, by a bound of them from mean and norm, without squarings: those cut off
    /// more than a step of a polynomial does. A vector longer than 15 without its mean is scaled down to that; and where the
    /// result is none that a visibility can have, because spheres in one place were counted for each, once more, by the
    /// excess of its square.
    #[default]
    Adaptive,
    /// OL: `a(|f^|) 1 + b(|f^|) f^`.
    OptimalLinear,
    /// HYB: scaled to a norm of at most `threshold`, OL, squarings.
    Hybrid {
        /// Above 0.
        threshold: f64,
    },
    /// The exponential of the product matrix (eq. 5.31), by its eigenvalues: the limit of the product series.
    Operator,
}

/// Evaluates exponentials of one order.
#[derive(Clone, Debug)]
pub struct Evaluator {
    product: TripleProduct,
    linear: Linear,
}

impl Evaluator {
    /// Makes the tensor and the table of OL.
    ///
    /// # Errors
    /// [`ShadowError::Order`].
    pub fn new(order: usize) -> Result<Self, ShadowError> {
        Ok(Self { linear: Linear::new(order)?, product: TripleProduct::new(order)? })
    }

    /// The exponential of a vector of `order^2` coefficients.
    ///
    /// # Errors
    /// [`ShadowError::Math`] for another length, [`ShadowError::Range`] for a parameter out of range.
    pub fn exponential(&self, method: Exponential, f: &[f64]) -> Result<Vec<f64>, ShadowError> {
        method.check()?;
        let count = coefficient_count(self.product.order());
        if f.len() != count {
            return Err(ShadowError::Length { what: "the coefficients", expected: count, actual: f.len() });
        }
        match method {
            Exponential::Series { degree } => self.horner(degree, f),
            Exponential::Operator => self.squared(f, f64::INFINITY, |scaled| self.operator(scaled)),
            Exponential::ScaledSeries { degree } => {
                self.squared(f, 0.125, |scaled| self.factored(degree, scaled))
            }
            Exponential::Horner { degree, norm } => {
                self.squared(f, norm, |scaled| self.horner(degree, scaled))
            }
            Exponential::Adaptive => self.polynomial(f),
            Exponential::OptimalLinear => {
                self.squared(f, f64::INFINITY, |scaled| Ok(self.linear.apply(scaled)))
            }
            Exponential::Hybrid { threshold } => {
                self.squared(f, threshold, |scaled| Ok(self.linear.apply(scaled)))
            }
        }
    }

    /// The product of two vectors (eq. 5.8).
    ///
    /// # Errors
    /// [`ShadowError::Math`] for another length.
    pub fn product(&self, f: &[f64], g: &[f64]) -> Result<Vec<f64>, ShadowError> {
        let mut out = vec![0.0; f.len()];
        self.product.product(f, g, &mut out)?;
        Ok(out)
    }

    /// Eq. 5.25 and 5.26 around `small`, the exponential of what has no mean and a norm of at most `norm`.
    fn squared(
        &self,
        f: &[f64],
        norm: f64,
        small: impl Fn(&[f64]) -> Result<Vec<f64>, ShadowError>,
    ) -> Result<Vec<f64>, ShadowError> {
        let squarings = squarings(f, norm);
        let scale = (-f64::from(squarings)).exp2();
        let mut scaled: Vec<f64> = f.iter().map(|value| scale * value).collect();
        let mean = (scaled[0] / ONE).exp();
        scaled[0] = 0.0;
        let mut g: Vec<f64> = small(&scaled)?.into_iter().map(|value| mean * value).collect();
        for _ in 0..squarings {
            g = self.product(&g, &g)?;
        }
        Ok(g)
    }

    /// `1 + f * (1 + f/2 * (1 + f/3 * ...))`: the series of eq. 5.22, whose powers are amassed from left to right.
    fn horner(&self, degree: usize, f: &[f64]) -> Result<Vec<f64>, ShadowError> {
        let mut g = f.iter().map(|value| value / degree as f64).collect::<Vec<_>>();
        g[0] += ONE;
        for k in (1..degree).rev() {
            g = self.product(f, &g)?;
            g.iter_mut().for_each(|value| *value /= k as f64);
            g[0] += ONE;
        }
        Ok(g)
    }

    /// The polynomial of the vector's own interval; where the result has an excess, that of as much less of the vector.
    fn polynomial(&self, f: &[f64]) -> Result<Vec<f64>, ShadowError> {
        let scale = shortening(self.product.order(), f[0] / ONE, without_mean(f))?;
        let g = self.polynomial_of(f, scale)?;
        match excess(&g) {
            more if more > EXCESS => self.polynomial_of(f, scale * EXCESS / more),
            _ => Ok(g),
        }
    }

    /// The exponential of a scaled vector by Horner's rule.
    fn polynomial_of(&self, f: &[f64], scale: f64) -> Result<Vec<f64>, ShadowError> {
        let scaled: Vec<f64> = f.iter().map(|value| scale * value).collect();
        let interval = Interval::new(self.product.order(), scaled[0] / ONE, without_mean(&scaled))?;
        let Polynomial { half, coefficients } = Polynomial::for_half(interval.half);
        let t = normalized(&scaled, interval, half);
        let mut g = vec![0.0; f.len()];
        for coefficient in coefficients.iter().rev() {
            g = self.product(&t, &g)?;
            g[0] += coefficient * ONE;
        }
        let factor = interval.top.exp();
        g.iter_mut().for_each(|value| *value *= factor);
        Ok(g)
    }

    /// Even and odd powers apart (eq. 5.27).
    fn factored(&self, degree: usize, f: &[f64]) -> Result<Vec<f64>, ShadowError> {
        let mut even = vec![0.0; f.len()];
        even[0] = ONE;
        let mut odd = even.clone();
        let square = self.product(f, f)?;
        let mut power = square.clone();
        let mut factorial = 1.0;
        for k in 2..=degree {
            factorial *= k as f64;
            let sum = if k % 2 == 0 { &mut even } else { &mut odd };
            sum.iter_mut().zip(&power).for_each(|(sum, value)| *sum += value / factorial);
            if k % 2 == 1 && k < degree {
                power = self.product(&power, &square)?;
            }
        }
        // The odd part is `f * 1` as long as it has no more terms.
        let odd = if degree < 3 { f.to_vec() } else { self.product(f, &odd)? };
        even.iter_mut().zip(odd).for_each(|(sum, value)| *sum += value);
        Ok(even)
    }

    /// Eq. 5.31: `1 + R^T q(D) R f`, `q(x) = (exp x - 1) / x`.
    fn operator(&self, f: &[f64]) -> Result<Vec<f64>, ShadowError> {
        let mut g = vec![0.0; f.len()];
        g[0] = ONE;
        for (value, vector) in eigen::symmetric(f.len(), &self.product.matrix(f)?) {
            let along: f64 = vector.iter().zip(f).map(|(v, f)| v * f).sum();
            let factor = along * if value.abs() < 1e-12 { 1.0 } else { value.exp_m1() / value };
            g.iter_mut().zip(&vector).for_each(|(sum, v)| *sum += factor * v);
        }
        Ok(g)
    }
}

/// Squarings that bring the norm without the mean to at most `norm` (eq. 5.26).
pub(crate) fn squarings(f: &[f64], norm: f64) -> u32 {
    let ratio = without_mean(f) / norm;
    if ratio > 1.0 { ratio.log2().ceil() as u32 } else { 0 }
}

impl Exponential {
    pub(crate) fn check(self) -> Result<(), ShadowError> {
        let (degree, norm) = match self {
            Self::Series { degree } | Self::ScaledSeries { degree } => (degree, 1.0),
            Self::Horner { degree, norm } => (degree, norm),
            Self::Hybrid { threshold } => (1, threshold),
            Self::Adaptive | Self::OptimalLinear | Self::Operator => (1, 1.0),
        };
        if degree == 0 || degree > MAX_DEGREE {
            let (what, value) = ("the degree of a series", degree as f64);
            return Err(ShadowError::Range { what, value, range: "1 to 32" });
        }
        if !(norm > 0.0 && norm.is_finite()) {
            return Err(ShadowError::Range {
                what: "a norm to scale to",
                value: norm,
                range: "a number above 0",
            });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn norm(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
    }

    fn vector(count: usize, size: f64) -> Vec<f64> {
        let raw: Vec<f64> = (0..count).map(|i| ((i * i * 7 + 3) % 11) as f64 - 5.0).collect();
        let length = raw.iter().map(|value| value * value).sum::<f64>().sqrt();
        raw.iter().map(|value| size / length * value).collect()
    }

    #[test]
    fn every_method_agrees_on_small_vectors() {
        for order in 3..=6 {
            let evaluator = Evaluator::new(order).unwrap();
            let f = vector(order * order, 0.1);
            let truth = evaluator.exponential(Exponential::Operator, &f).unwrap();
            for (method, allowed) in [
                (Exponential::Series { degree: 9 }, 1e-13),
                (Exponential::ScaledSeries { degree: 9 }, 1e-7),
                (Exponential::ScaledSeries { degree: 2 }, 1e-3),
                (Exponential::Horner { degree: 9, norm: 2.0 }, 1e-13),
                (Exponential::Adaptive, 1e-2),
                (Exponential::OptimalLinear, 2e-2),
                (Exponential::Hybrid { threshold: 0.25 }, 2e-2),
            ] {
                let error = norm(&evaluator.exponential(method, &f).unwrap(), &truth);
                assert!(error < allowed, "order {order}, {method:?}: {error:e}");
            }
        }
    }

    #[test]
    fn a_constant_is_a_number() {
        let evaluator = Evaluator::new(4).unwrap();
        let mut f = vec![0.0; 16];
        for value in [-40.0, -1.0, 0.0, 2.0_f64] {
            f[0] = value * ONE;
            for method in [
                Exponential::Operator,
                Exponential::OptimalLinear,
                Exponential::ScaledSeries { degree: 2 },
                Exponential::Horner { degree: 4, norm: 1.0 },
            ] {
                let found = evaluator.exponential(method, &f).unwrap();
                assert!((found[0] / ONE / value.exp() - 1.0).abs() < 1e-12, "{method:?}: {found:?}");
                assert!(found[1..].iter().all(|value| *value == 0.0), "{method:?}: {found:?}");
            }
        }
    }

    #[test]
    fn the_constant_is_that_of_the_basis() {
        assert!((ONE / (4.0 * std::f64::consts::PI).sqrt() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn spheres_in_one_place_stay_near_one_of_them() {
        for order in 3..=6 {
            let reference = crate::reference::Reference::new(order).unwrap();
            for degrees in [20.0_f64, 45.0] {
                let height = crate::circle::height(degrees.to_radians()).unwrap();
                let cap = crate::Cap { axis: glam::DVec3::Z, height };
                let truth = reference.chain(&[cap]).unwrap();
                let one = reference.log_visibility(&[cap]).unwrap();
                for count in [24.0, 1000.0] {
                    let f: Vec<f64> = one.iter().map(|value| count * value).collect();
                    let found = reference.evaluator().exponential(Exponential::Adaptive, &f).unwrap();
                    let error = norm(&found, &truth) / ONE;
                    println!("order {order}, {count} of {degrees} degrees: {error:.3}");
                    assert!(error < 0.2, "order {order}, {count} of {degrees} degrees: {error}");
                }
            }
        }
    }

    #[test]
    fn the_series_converges_to_the_operator() {
        let evaluator = Evaluator::new(4).unwrap();
        let f = vector(16, 4.0);
        let truth = evaluator.exponential(Exponential::Operator, &f).unwrap();
        let series = evaluator.exponential(Exponential::Series { degree: 32 }, &f).unwrap();
        assert!(norm(&series, &truth) < 1e-11, "{series:?} and {truth:?}");
    }

    #[test]
    fn what_is_out_of_range_is_refused() {
        let evaluator = Evaluator::new(3).unwrap();
        for method in [
            Exponential::Series { degree: 0 },
            Exponential::ScaledSeries { degree: 33 },
            Exponential::Horner { degree: 2, norm: 0.0 },
            Exponential::Hybrid { threshold: f64::NAN },
        ] {
            assert!(evaluator.exponential(method, &[0.0; 9]).is_err(), "{method:?}");
        }
        assert!(evaluator.exponential(Exponential::Operator, &[0.0; 4]).is_err());
        assert!(Evaluator::new(2).is_err());
    }
}
