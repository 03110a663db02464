//! Mixtures from normals, by expectation and maximisation on the sphere.
//!
//! Banerjee, Dhillon, Ghosh and Sra 2005, algorithm 2 ("soft-moVMF"). Samples that are lobes of a finer level enter with
//! the mean of their log-likelihood, as in Vasconcelos and Lippman, "Learning Mixture Hierarchies" (1998). The seeds
//! come from splitting, not from chance: the widest cluster is cut across its longest axis until there are enough.

use glam::{DMat3, DVec3};

use crate::NormalsError;
use crate::map::Sample;
use crate::mixture::{MAX_LOBES, Mixture, WeightedLobe, check_count};
use crate::vmf::Lobe;

/// Lobes of this weight and less are empty, and stay so.
const EMPTY: f64 = 1e-12;

/// How a mixture is fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitSettings {
    /// Lobes, 1 to 6. Default 4.
    pub lobes: usize,
    /// Steps of expectation and maximisation, 0 to 1000. Default 20.
    pub iterations: usize,
    /// The sharpest lobe while fitting, 1 to 1e8. Likelihood has no bound: it would spend a lobe on any two equal
    /// normals. Default 1000, narrower than the lobes of the glossiest materials filtered. Results are not limited.
    pub sharpest: f64,
}

impl Default for FitSettings {
    fn default() -> Self {
        Self { lobes: 4, iterations: 20, sharpest: 1e3 }
    }
}

impl FitSettings {
    pub(crate) fn check(&self) -> Result<(), NormalsError> {
        check_count(self.lobes)?;
        let within = |what, value: f64, least: f64, most: f64, range| {
            let inside = (least..=most).contains(&value);
            if inside { Ok(()) } else { Err(NormalsError::Range { what, value, range }) }
        };
        within("the number of iterations", self.iterations as f64, 0.0, 1000.0, "0 to 1000")?;
        within("the sharpest lobe", self.sharpest, 1.0, 1e8, "1 to 1e8")
    }
}

/// The mixture of a footprint. The weights sum to that of the samples, and the moments to theirs, exactly but for
/// rounding. Fewer distinct normals than lobes leave lobes empty. The same samples give the same bits.
///
/// # Errors
/// [`NormalsError::Range`] for settings out of range.
pub fn fit(samples: &[Sample], settings: &FitSettings) -> Result<Mixture, NormalsError> {
    settings.check()?;
    fit_from(samples, &split(samples, settings.lobes), settings)
}

/// [`fit`] from given seeds, of which lobe j starts at seed j; empty seeds stay empty.
///
/// # Errors
/// As [`fit`].
pub fn fit_from(
    samples: &[Sample],
    seeds: &Mixture,
    settings: &FitSettings,
) -> Result<Mixture, NormalsError> {
    settings.check()?;
    let mut lobes = seeds.lobes().to_vec();
    for _ in 0..settings.iterations {
        lobes = step(samples, &lobes, settings.sharpest);
    }
    Mixture::new(lobes)
}

/// One step: shares of each sample by the lobes there are, then the lobes of these shares.
fn step(samples: &[Sample], lobes: &[WeightedLobe], sharpest: f64) -> Vec<WeightedLobe> {
    if lobes.iter().all(|lobe| lobe.weight <= EMPTY) {
        return lobes.to_vec();
    }
    let likelihoods: Vec<Likelihood> = lobes.iter().map(|lobe| Likelihood::of(lobe, sharpest)).collect();
    let mut next = vec![WeightedLobe::default(); lobes.len()];
    let mut shares = [0.0; MAX_LOBES];
    for sample in samples {
        let shares = &mut shares[..lobes.len()];
        let mut largest = f64::NEG_INFINITY;
        for (share, likelihood) in shares.iter_mut().zip(&likelihoods) {
            *share = likelihood.log(sample.mean);
            largest = share.max(largest);
        }
        let mut total = 0.0;
        for share in &mut *shares {
            *share = (*share - largest).exp();
            total += *share;
        }
        for (next, share) in next.iter_mut().zip(shares) {
            let weight = sample.weight * *share / total;
            next.weight += weight;
            next.moment += weight * sample.mean;
        }
    }
    next
}

/// Logarithm of a lobe's weight times its density.
struct Likelihood {
    /// Of a direction on the axis; minus infinity for an empty lobe.
    log_height: f64,
    concentration: f64,
    axis: DVec3,
}

impl Likelihood {
    fn of(lobe: &WeightedLobe, sharpest: f64) -> Self {
        let Lobe { axis, concentration } = Lobe::from_mean(lobe.mean());
        let concentration = concentration.min(sharpest);
        let log_height = Lobe { axis, concentration }.log_height() + lobe.weight.ln();
        let log_height = if lobe.weight > EMPTY { log_height } else { f64::NEG_INFINITY };
        Self { log_height, concentration, axis }
    }

    fn log(&self, direction: DVec3) -> f64 {
        self.log_height + self.concentration * (self.axis.dot(direction) - 1.0)
    }
}

/// Clusters of the samples: the one of most variance is cut across its longest axis, `count - 1` times.
fn split(samples: &[Sample], count: usize) -> Mixture {
    let mut clusters = vec![samples.to_vec()];
    while clusters.len() < count {
        let spreads: Vec<f64> = clusters.iter().map(|cluster| spread(cluster)).collect();
        let widest = (1..spreads.len()).fold(0, |w, i| if spreads[i] > spreads[w] { i } else { w });
        if spreads[widest] <= 1e-14 {
            break;
        }
        let (mean, axis) = (mean(&clusters[widest]), longest_axis(&clusters[widest]));
        let (above, below) =
            clusters.swap_remove(widest).into_iter().partition(|sample| axis.dot(sample.mean - mean) > 0.0);
        clusters.extend([below, above]);
    }
    clusters.resize(count, Vec::new());
    Mixture::of(clusters.iter().map(|cluster| total(cluster)).collect())
}

fn total(cluster: &[Sample]) -> WeightedLobe {
    cluster.iter().fold(WeightedLobe::default(), |sum, sample| WeightedLobe {
        weight: sum.weight + sample.weight,
        moment: sum.moment + sample.weight * sample.mean,
    })
}

fn mean(cluster: &[Sample]) -> DVec3 {
    total(cluster).mean()
}

/// The weight of a cluster times its variance.
fn spread(cluster: &[Sample]) -> f64 {
    let mean = mean(cluster);
    cluster.iter().map(|sample| sample.weight * (sample.mean - mean).length_squared()).sum()
}

/// The eigenvector of the largest eigenvalue of the covariance, by powers of the matrix.
fn longest_axis(cluster: &[Sample]) -> DVec3 {
    let mean = mean(cluster);
    let mut covariance = DMat3::ZERO;
    for sample in cluster {
        let offset = sample.mean - mean;
        covariance +=
            sample.weight * DMat3::from_cols(offset * offset.x, offset * offset.y, offset * offset.z);
    }
    // The column of the longest length is never across the axis sought.
    let columns = [covariance.x_axis, covariance.y_axis, covariance.z_axis];
    let longest = columns.into_iter().fold(DVec3::ZERO, |best, column| {
        if column.length_squared() > best.length_squared() { column } else { best }
    });
    let mut axis = longest.try_normalize().unwrap_or(DVec3::X);
    for _ in 0..16 {
        axis = (covariance * axis).try_normalize().unwrap_or(axis);
    }
    axis
}
