//! What the kernels look up: band factors of a cap over the cosine of its angular radius, for its logarithm and its
//! visibility, and the numbers of the optimal linear exponential over the norm.
//!
//! The factors of a cap grow with the square of its sine from 0 on. Divided by that they are smooth down to 0, so that a far
//! sphere is as exact as a near one.

use airglow_math::sh::zonal::factors_from_coefficients;
use half::f16;

use crate::ShadowError;
use crate::circle;
use crate::exponential::ONE;
use crate::linear::Linear;
use crate::logarithm::Logarithm;

/// Vectors of the tables of caps: 16 KiB, the smallest uniform range of any device.
pub const ENTRIES: usize = 1024;
/// Steps of the norm in the table of the optimal linear exponential.
pub const LINEAR_STEPS: usize = 256;
/// The height of a cap that stands for 0, where factors are divided by the square of the sine.
const LEAST: f64 = 1e-7;

/// The tables of one order.
#[derive(Clone, Debug)]
pub struct Tables {
    /// Of the logarithm: `ENTRIES` words of four times two halves, the factors of the bands and their growth to the next
    /// step; from order 5 on two words a step, the second for the growth.
    pub logarithm: Vec<[u32; 4]>,
    /// Of the visibility less 1, in the same form.
    pub visibility: Vec<[u32; 4]>,
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

/// Factors over the square of the sine, at every step of the cosine, and their growth.
fn caps(
    order: usize,
    zonal: impl Fn(f64) -> Result<Vec<f64>, ShadowError>,
) -> Result<Vec<[u32; 4]>, ShadowError> {
    let steps = steps(order);
    let at = |step: usize| -> Result<[f64; 6], ShadowError> {
        let height = (1.0 - step as f64 / steps as f64).max(LEAST);
        let factors = factors_from_coefficients(&zonal(height)?)?;
        let sine2 = height * (2.0 - height);
        Ok(std::array::from_fn(|l| factors.get(l).map_or(0.0, |factor| factor / sine2)))
    };
    let mut entries = Vec::with_capacity(ENTRIES);
    let mut here = at(0)?;
    for step in 1..=steps {
        let next = at(step)?;
        let pair = |l: usize, values: [f64; 6]| halves([values[l], values[l + 1]]);
        let growth = std::array::from_fn(|l| next[l] - here[l]);
        if order > 4 {
            entries.push([pair(0, here), pair(2, here), pair(4, here), 0]);
            entries.push([pair(0, growth), pair(2, growth), pair(4, growth), 0]);
        } else {
            entries.push([pair(0, here), pair(2, here), pair(0, growth), pair(2, growth)]);
        }
        here = next;
    }
    Ok(entries)
}

/// Steps of the cosine.
fn steps(order: usize) -> usize {
    if order > 4 { ENTRIES / 2 } else { ENTRIES }
}

/// The factors of a cap's bands as the kernels look them up.
pub(crate) fn looked_up(order: usize, table: &[[u32; 4]], height: f64) -> Vec<f64> {
    let steps = steps(order);
    let place = (1.0 - height).max(0.0) * steps as f64;
    let entry = (place as usize).min(steps - 1);
    let t = place - entry as f64;
    let word = |at: usize| table.get(at).copied().unwrap_or_default();
    let (values, growth) = match order > 4 {
        true => (word(2 * entry), word(2 * entry + 1)),
        false => (word(entry), [word(entry)[2], word(entry)[3], 0, 0]),
    };
    let sine2 = height * (2.0 - height);
    (0..order).map(|l| sine2 * (half(values[l / 2], l % 2) + t * half(growth[l / 2], l % 2))).collect()
}

/// Two numbers as halves, as `packHalf2x16` does.
fn halves(values: [f64; 2]) -> u32 {
    let [low, high] = values.map(|value| u32::from(f16::from_f64(value).to_bits()));
    low | high << 16
}

/// One of two halves.
fn half(word: u32, place: usize) -> f64 {
    f16::from_bits((word >> (16 * place)) as u16).to_f64()
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
            for height in [1e-5, 0.01, 0.1231, 0.3777, 0.8, 0.9996] {
                let truth = factors_from_coefficients(&inverse.of_cap(height).unwrap()).unwrap();
                let size = truth.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
                let found = looked_up(order, &tables.logarithm, height);
                for (l, (found, truth)) in found.iter().zip(&truth).enumerate() {
                    assert!((found - truth).abs() < 2e-3 * size, "{height}, band {l}: {found} and {truth}");
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
