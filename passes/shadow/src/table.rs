//! What the kernels look up: band factors of a cap over its height, for its logarithm and its visibility, and the numbers of
//! the optimal linear exponential over the norm.
//!
//! The solid angle of a cap is its height times 2 pi, and its factors grow with it from 0 on. Divided by the height they
//! are smooth down to 0, so that a far sphere is as exact as a near one.

use airglow_math::sh::zonal::factors_from_coefficients;

use crate::ShadowError;
use crate::circle;
use crate::exponential::ONE;
use crate::linear::Linear;
use crate::logarithm::Logarithm;

/// Vectors of the tables of caps: 16 KiB, the smallest uniform range of any device.
pub const ENTRIES: usize = 1024;
/// Steps of the norm in the table of the optimal linear exponential.
pub const LINEAR_STEPS: usize = 256;
/// The height that stands for 0, where the factors are divided by it.
const LEAST: f64 = 1e-7;

/// The tables of one order.
#[derive(Clone, Debug)]
pub struct Tables {
    /// Of the logarithm: `ENTRIES` vec4, one a height from 0 to 1, or two from order 5 on, one component a band.
    pub logarithm: Vec<[f32; 4]>,
    /// Of the visibility less 1, in the same form.
    pub visibility: Vec<[f32; 4]>,
    /// a and b at `LINEAR_STEPS` + 1 norms from 0 to [`Self::linear_end`].
    pub linear: Vec<[f32; 2]>,
    /// The largest norm of [`Self::linear`].
    pub linear_end: f32,
}

impl Tables {
    /// Makes the tables of an order with a clip of eigenvalues; see [`Logarithm::new`].
    ///
    /// # Errors
    /// As [`Logarithm::new`].
    pub fn new(order: usize, clip: f64) -> Result<Self, ShadowError> {
        let inverse = Logarithm::new(order, clip)?;
        let logarithm = caps(order, |height| inverse.of_cap(height))?;
        let visibility = caps(order, |height| {
            let mut zonal = circle::visibility(order, height)?;
            zonal[0] -= ONE;
            Ok(zonal)
        })?;
        let fit = Linear::new(order)?;
        let at =
            |step: usize| fit.at(fit.end() * step as f64 / LINEAR_STEPS as f64).map(|value| value as f32);
        let linear = (0..=LINEAR_STEPS).map(at).collect();
        Ok(Self { logarithm, visibility, linear, linear_end: fit.end() as f32 })
    }
}

/// Factors over the height at every step.
fn caps(
    order: usize,
    zonal: impl Fn(f64) -> Result<Vec<f64>, ShadowError>,
) -> Result<Vec<[f32; 4]>, ShadowError> {
    let parts = order.div_ceil(4);
    let steps = ENTRIES / parts - 1;
    let mut entries = Vec::with_capacity(ENTRIES);
    for step in 0..=steps {
        let height = (step as f64 / steps as f64).max(LEAST);
        let factors = factors_from_coefficients(&zonal(height)?)?;
        let band = |l: usize| factors.get(l).map_or(0.0, |factor| (factor / height) as f32);
        entries.extend((0..parts).map(|part| [0, 1, 2, 3].map(|l| band(4 * part + l))));
    }
    Ok(entries)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CLIP;

    #[test]
    fn entries_between_steps_are_near_the_function() {
        for order in [3, 4, 6] {
            let tables = Tables::new(order, CLIP).unwrap();
            let inverse = Logarithm::new(order, CLIP).unwrap();
            let parts = order.div_ceil(4);
            for height in [1e-5, 0.01, 0.1231, 0.3777, 0.8, 0.9996] {
                let truth = factors_from_coefficients(&inverse.of_cap(height).unwrap()).unwrap();
                let size = truth.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
                let place = height * (ENTRIES / parts - 1) as f64;
                let (entry, t) = (place as usize, place.fract());
                for (l, truth) in truth.iter().enumerate() {
                    let value = |entry: usize| f64::from(tables.logarithm[entry * parts + l / 4][l % 4]);
                    let found = height * ((1.0 - t) * value(entry) + t * value(entry + 1));
                    assert!((found - truth).abs() < 1e-3 * size, "{height}, band {l}: {found} and {truth}");
                }
            }
        }
    }

    #[test]
    fn an_order_has_as_many_entries_as_its_kernels_read() {
        for order in 3..=6 {
            let tables = Tables::new(order, CLIP).unwrap();
            assert_eq!([tables.logarithm.len(), tables.visibility.len()], [ENTRIES; 2]);
            assert_eq!(tables.linear.len(), LINEAR_STEPS + 1);
        }
    }
}
