//! Confidence intervals by resampling: the percentile bootstrap of Efron and Tibshirani, *An Introduction to
//! the Bootstrap* (1993), chapter 13. Deterministic: the same seed gives the same interval.

use super::quantile::{median, of_sorted};
use crate::MathError;

/// The most samples times resamples that are drawn.
const MAX_DRAWS: usize = 1 << 31;

/// An estimate with its confidence interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The statistic of the samples themselves.
    pub estimate: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// Whether `value` lies in the closed interval.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }
}

/// Interval of the median of `samples` at `confidence` (such as 0.95), from so many resamples (1000 to 10 000
/// are usual).
///
/// # Errors
/// [`MathError::NoSamples`]; [`MathError::Range`] for a confidence outside (0, 1), for no resamples, for more
/// than 2^31 draws in all, and for a sample that is not finite.
pub fn bootstrap_interval(
    samples: &[f64],
    confidence: f64,
    resamples: usize,
    seed: u64,
) -> Result<Interval, MathError> {
    let estimate = median(samples)?;
    check(samples, confidence, resamples)?;
    let mut random = SplitMix64(seed);
    let mut drawn = vec![0.0; samples.len()];
    let mut medians = Vec::with_capacity(resamples);
    for _ in 0..resamples {
        for value in &mut drawn {
            *value = samples[random.below(samples.len())];
        }
        drawn.sort_unstable_by(f64::total_cmp);
        medians.push(of_sorted(&drawn, 0.5));
    }
    medians.sort_unstable_by(f64::total_cmp);
    let tail = 0.5 * (1.0 - confidence);
    Ok(Interval { estimate, low: of_sorted(&medians, tail), high: of_sorted(&medians, 1.0 - tail) })
}

/// Interval of the median of `a_i / b_i` over pairs measured together, so that what disturbs both cancels.
/// The two differ at that confidence when the interval does not contain 1.
///
/// # Errors
/// As [`bootstrap_interval`]; [`MathError::Length`] when the lengths differ; [`MathError::Range`] for a ratio
/// that is not finite, such as over zero.
pub fn paired_ratio_interval(
    a: &[f64],
    b: &[f64],
    confidence: f64,
    resamples: usize,
    seed: u64,
) -> Result<Interval, MathError> {
    crate::error::check_length("the second of the paired samples", a.len(), b.len())?;
    let ratios: Vec<f64> = a.iter().zip(b).map(|(a, b)| a / b).collect();
    bootstrap_interval(&ratios, confidence, resamples, seed)
}

fn check(samples: &[f64], confidence: f64, resamples: usize) -> Result<(), MathError> {
    if let Some(&value) = samples.iter().find(|s| !s.is_finite()) {
        return Err(MathError::Range { what: "a sample", value, range: "finite numbers" });
    }
    if !(confidence > 0.0 && confidence < 1.0) {
        let (what, range) = ("the confidence", "a number between 0 and 1");
        return Err(MathError::Range { what, value: confidence, range });
    }
    if resamples == 0 || samples.len().saturating_mul(resamples) > MAX_DRAWS {
        let (what, range) = ("the number of resamples", "at least 1, at most 2^31 draws in all");
        return Err(MathError::Range { what, value: resamples as f64, range });
    }
    Ok(())
}

/// The generator of Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators" (2014).
struct SplitMix64(u64);

impl SplitMix64 {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    /// A number below `count`, by the upper half of a product; the bias is below `count / 2^64`.
    fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.next()) * count as u128) >> 64) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Roughly normal samples of mean 0 and variance 1: the sum of twelve uniform numbers, less 6.
    fn normal(count: usize, seed: u64) -> Vec<f64> {
        let mut random = SplitMix64(seed);
        let mut uniform = || (random.next() >> 11) as f64 / (1_u64 << 53) as f64;
        (0..count).map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0).collect()
    }

    /// Of many 95 % intervals about 95 % hold the true median.
    #[test]
    fn covers_the_true_median_as_often_as_it_says() {
        let trials = 400;
        let covering = (0..trials)
            .filter(|&t| bootstrap_interval(&normal(41, 1000 + t), 0.95, 400, t).unwrap().contains(0.0))
            .count() as f64;
        let coverage = covering / trials as f64;
        assert!((0.91..=0.99).contains(&coverage), "coverage {coverage} instead of 0.95");
    }

    /// The width agrees with the normal law of a sample median: 2 * 1.96 * sqrt(pi / 2n).
    #[test]
    fn has_the_asymptotic_width() {
        let n = 4001;
        let interval = bootstrap_interval(&normal(n, 5), 0.95, 500, 1).unwrap();
        let expected = 2.0 * 1.96 * (std::f64::consts::FRAC_PI_2 / n as f64).sqrt();
        let width = interval.high - interval.low;
        assert!((0.7..1.3).contains(&(width / expected)), "width {width}, expected {expected}");
        assert!(interval.contains(interval.estimate), "{interval:?}");
    }

    #[test]
    fn pairing_cancels_what_disturbs_both() {
        let noise: Vec<f64> = normal(30, 9).iter().map(|x| (0.5 * x).exp()).collect();
        let slower: Vec<f64> = noise.iter().map(|x| 1.01 * x).collect();
        let interval = paired_ratio_interval(&slower, &noise, 0.95, 1000, 3).unwrap();
        assert!(!interval.contains(1.0) && interval.contains(interval.estimate), "{interval:?}");
        let same = paired_ratio_interval(&noise, &noise, 0.95, 1000, 3).unwrap();
        assert_eq!(same, Interval { estimate: 1.0, low: 1.0, high: 1.0 });
    }

    #[test]
    fn repeats_with_its_seed() {
        let samples = normal(25, 2);
        let interval = |seed| bootstrap_interval(&samples, 0.9, 200, seed).unwrap();
        assert_eq!(interval(7), interval(7));
        assert_ne!(interval(7), interval(8));
    }

    #[test]
    fn refuses_what_it_cannot_resample() {
        assert!(matches!(bootstrap_interval(&[], 0.95, 10, 0), Err(MathError::NoSamples { .. })));
        assert!(matches!(bootstrap_interval(&[f64::NAN], 0.95, 10, 0), Err(MathError::Range { .. })));
        assert!(matches!(bootstrap_interval(&[1.0], 1.0, 10, 0), Err(MathError::Range { .. })));
        assert!(matches!(bootstrap_interval(&[1.0], 0.95, 0, 0), Err(MathError::Range { .. })));
        assert!(matches!(bootstrap_interval(&[1.0], 0.95, usize::MAX, 0), Err(MathError::Range { .. })));
        assert!(matches!(paired_ratio_interval(&[1.0], &[0.0], 0.95, 9, 0), Err(MathError::Range { .. })));
        assert!(matches!(paired_ratio_interval(&[1.0], &[], 0.95, 9, 0), Err(MathError::Length { .. })));
    }
}
