//! A distribution of normals as a mixture of lobes, kept in what is linear.
//!
//! Han, Sun, Ramamoorthi and Grinspun, "Frequency Domain Normal Map Filtering" (2007); Sun 2008, section 5.1.

use glam::DVec3;

use crate::NormalsError;
use crate::map::Sample;

/// Lobes that a mixture may have.
pub const MAX_LOBES: usize = 6;

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

    /// The same lobes in the order that is nearest to `other`'s, of equally many: over all orders, the sum over j of
    /// `w_j W_j |m_j - M_j|^2` is least, so that interpolation widens lobes as little as it can.
    #[must_use]
    pub fn aligned_to(&self, other: &Self) -> Self {
        let count = self.lobes.len();
        if count != other.lobes.len() {
            return self.clone();
        }
        let cost =
            |a: &WeightedLobe, b: &WeightedLobe| a.weight * b.weight * (a.mean() - b.mean()).length_squared();
        let mut order: Vec<usize> = (0..count).collect();
        let mut best = (f64::INFINITY, order.clone());
        permute(&mut order, 0, &mut |order| {
            let total: f64 = order.iter().zip(&other.lobes).map(|(&i, b)| cost(&self.lobes[i], b)).sum();
            if total < best.0 {
                best = (total, order.to_vec());
            }
        });
        Self { lobes: best.1.iter().map(|&i| self.lobes[i]).collect() }
    }
}

/// Refuses mixtures of no lobe or of too many.
pub(crate) fn check_count(count: usize) -> Result<(), NormalsError> {
    if (1..=MAX_LOBES).contains(&count) {
        return Ok(());
    }
    Err(NormalsError::Range { what: "the number of lobes", value: count as f64, range: "1 to 6" })
}

/// Visits every order of the items from `place` on.
fn permute(items: &mut [usize], place: usize, visit: &mut impl FnMut(&[usize])) {
    if place + 1 >= items.len() {
        visit(items);
        return;
    }
    for other in place..items.len() {
        items.swap(place, other);
        permute(items, place + 1, visit);
        items.swap(place, other);
    }
}
