//! A distribution of normals as a mixture of lobes, kept in what is linear.
//!
//! Han, Sun, Ramamoorthi and Grinspun, "Frequency Domain Normal Map Filtering" (2007); Sun 2008, section 5.1.

use glam::DVec3;

use crate::NormalsError;
use crate::map::Sample;

/// Lobes that a mixture may have.
pub const MAX_LOBES: usize = 6;

/// Turns in which each lobe looks for a better place.
const SWEEPS: usize = 4;
/// An empty place without a trace is for what is farther than this from all others, a variance.
const APART: f64 = 1e-4;
/// What the lobe of a place weighs while others are sorted into it.
const PRESENCE: f64 = 0.1;
/// The weight that an empty place keeps of the coarser lobe, so that finer texels know whose place it is.
const TRACE: f64 = 1e-6;

/// A share of the normals with their weighted mean. Adding, averaging and interpolating both is exact: the lobe then
/// has the mean of all normals that it stands for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WeightedLobe {
    /// Share of the footprint. A lobe of weight 0 is empty.
    pub weight: f64,
    /// The weight times the mean vector of the lobe's normals; its length is at most the weight.
    pub moment: DVec3,
}

impl WeightedLobe {
    /// The mean vector of the lobe's normals; 0 of an empty lobe.
    #[must_use]
    pub fn mean(&self) -> DVec3 {
        if self.weight > 0.0 { self.moment / self.weight } else { DVec3::ZERO }
    }

    /// Weight times squared length of the mean: what a sum of lobes loses of it is spread.
    fn narrowness(&self) -> f64 {
        if self.weight > 0.0 { self.moment.length_squared() / self.weight } else { 0.0 }
    }

    /// The sum with a lobe, or the difference from it.
    fn plus(&self, lobe: &Self, sign: f64) -> Self {
        Self { weight: self.weight + sign * lobe.weight, moment: self.moment + sign * lobe.moment }
    }

    /// `(x, y, z, w)` as textures hold it: moment and weight in f32.
    #[must_use]
    pub fn packed(&self) -> [f32; 4] {
        [self.moment.x as f32, self.moment.y as f32, self.moment.z as f32, self.weight as f32]
    }
}

impl From<[f32; 4]> for WeightedLobe {
    /// What [`WeightedLobe::packed`] holds.
    fn from(packed: [f32; 4]) -> Self {
        let [x, y, z, weight] = packed.map(f64::from);
        Self { weight, moment: DVec3::new(x, y, z) }
    }
}

/// Lobes whose weights sum to 1; lobe j of a texel corresponds to lobe j of its neighbours and of coarser levels.
#[derive(Clone, Debug, PartialEq)]
pub struct Mixture {
    lobes: Vec<WeightedLobe>,
}

impl Mixture {
    /// Of 1 to [`MAX_LOBES`] lobes.
    ///
    /// # Errors
    /// [`NormalsError::Range`].
    pub fn new(lobes: Vec<WeightedLobe>) -> Result<Self, NormalsError> {
        check_count(lobes.len())?;
        Ok(Self { lobes })
    }

    /// Of a number of lobes already checked.
    pub(crate) fn of(lobes: Vec<WeightedLobe>) -> Self {
        Self { lobes }
    }

    /// The lobes.
    #[must_use]
    pub fn lobes(&self) -> &[WeightedLobe] {
        &self.lobes
    }

    /// Each lobe as a sample, for the mixture of a coarser level, scaled by the share that this one is of it.
    pub fn samples(&self, share: f64) -> impl Iterator<Item = Sample> {
        let sample = move |lobe: &WeightedLobe| Sample { weight: share * lobe.weight, mean: lobe.mean() };
        self.lobes.iter().filter(|lobe| lobe.weight > 0.0).map(sample)
    }

    /// The mixture as hardware interpolates it: lobe by lobe. Lobes that the shorter does not have are empty there.
    #[must_use]
    pub fn mix(&self, other: &Self, share: f64) -> Self {
        let lobe = |lobes: &[WeightedLobe], j: usize| lobes.get(j).copied().unwrap_or_default();
        let mixed = |j| {
            let (a, b) = (lobe(&self.lobes, j), lobe(&other.lobes, j));
            let weight = a.weight + (b.weight - a.weight) * share;
            WeightedLobe { weight, moment: a.moment.lerp(b.moment, share) }
        };
        Self { lobes: (0..self.lobes.len().max(other.lobes.len())).map(mixed).collect() }
    }

    /// The same lobes in the places of `other`'s, of equally many, for interpolation between the two and between all that
    /// have the places of `other`.
    ///
    /// Lobes of one place become one: where there are fewer modes than in `other`, lobes that differ little share a
    /// place rather than take that of a mode which is not theirs. Places are chosen so that the mixture halfway stays as
    /// narrow as it can: the sum over places of `|M|^2 / W` of all that lies there is most, as far as exchanging lobes
    /// one by one finds (Hartigan, "Clustering Algorithms", 1975). A place that stays empty keeps 1e-6 of `other`'s lobe.
    #[must_use]
    pub fn aligned_to(&self, other: &Self) -> Self {
        let count = self.lobes.len();
        if count != other.lobes.len() {
            return self.clone();
        }
        let scaled = |lobe: &WeightedLobe, weight: f64| match lobe.weight > 0.0 {
            true => WeightedLobe { weight, moment: weight * lobe.mean() },
            false => WeightedLobe::default(),
        };
        let mut filled: Vec<_> = other.lobes.iter().map(|lobe| scaled(lobe, PRESENCE)).collect();
        let mut places: Vec<Option<usize>> = vec![None; count];
        for _ in 0..SWEEPS {
            for (lobe, place) in self.lobes.iter().zip(&mut places) {
                if let Some(old) = *place {
                    filled[old] = filled[old].plus(lobe, -1.0);
                }
                let gain = |to: &WeightedLobe| {
                    let apart = if to.weight <= 0.0 { APART * lobe.weight } else { 0.0 };
                    to.plus(lobe, 1.0).narrowness() - to.narrowness() - apart
                };
                let gains: Vec<f64> = filled.iter().map(gain).collect();
                let best = (1..count).fold(0, |best, j| if gains[j] > gains[best] { j } else { best });
                filled[best] = filled[best].plus(lobe, 1.0);
                *place = Some(best);
            }
        }
        let mut lobes = vec![WeightedLobe::default(); count];
        for (lobe, place) in self.lobes.iter().zip(places) {
            let place = place.unwrap_or_default();
            lobes[place] = lobes[place].plus(lobe, 1.0);
        }
        for (lobe, coarse) in lobes.iter_mut().zip(&other.lobes).filter(|(lobe, _)| lobe.weight <= TRACE) {
            *lobe = scaled(coarse, TRACE);
        }
        Self { lobes }
    }
}

/// Refuses mixtures of no lobe or of too many.
pub(crate) fn check_count(count: usize) -> Result<(), NormalsError> {
    if (1..=MAX_LOBES).contains(&count) {
        return Ok(());
    }
    Err(NormalsError::Range { what: "the number of lobes", value: count as f64, range: "1 to 6" })
}
