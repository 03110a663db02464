//! The mixtures of single texels in the order that a built texture has them in: what can be measured of it before it is
//! built.

use std::collections::BTreeMap;

use crate::NormalsError;
use crate::fit::{FitSettings, fit};
use crate::map::{NormalMap, Sample};
use crate::mixture::Mixture;

/// Normals that a coarser texel is fitted from here: its mixture only says whose place is whose.
const SAMPLES: usize = 400;
/// The golden ratio less 1, whose multiples are spread evenly and meet no period of a map.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Fits of a map's texels, each kept for those below it.
pub struct Ordered<'a> {
    map: &'a NormalMap,
    settings: FitSettings,
    coarse: BTreeMap<[usize; 3], Mixture>,
}

impl<'a> Ordered<'a> {
    /// Of a map, by these settings.
    pub fn new(map: &'a NormalMap, settings: FitSettings) -> Self {
        Self { map, settings, coarse: BTreeMap::new() }
    }

    /// The mixture of a texel, level, column and row: fitted from all normals under it, then put into the places of the
    /// texels above it, from the coarsest down.
    ///
    /// # Errors
    /// [`NormalsError::Texel`], [`NormalsError::Range`].
    pub fn mixture(&mut self, [level, x, y]: [usize; 3]) -> Result<Mixture, NormalsError> {
        let own = fit(&self.map.footprint(level, x, y)?, &self.settings)?;
        match above(self.map, [level, x, y]) {
            Some(texel) => Ok(own.aligned_to(&self.above(texel)?)),
            None => Ok(own),
        }
    }

    /// The same of a texel above others, by a part of its normals.
    fn above(&mut self, texel: [usize; 3]) -> Result<Mixture, NormalsError> {
        if let Some(known) = self.coarse.get(&texel) {
            return Ok(known.clone());
        }
        let [level, x, y] = texel;
        let mut own = fit(&thinned(self.map.footprint(level, x, y)?), &self.settings)?;
        if let Some(parent) = above(self.map, texel) {
            own = own.aligned_to(&self.above(parent)?);
        }
        self.coarse.insert(texel, own.clone());
        Ok(own)
    }
}

/// The texel of the next coarser level, as the build finds it.
fn above(map: &NormalMap, [level, x, y]: [usize; 3]) -> Option<[usize; 3]> {
    let coarser = level + 1;
    let ([width, height], [columns, rows]) = (map.size(level), map.size(coarser));
    let place = [coarser, (x * columns / width).min(columns - 1), (y * rows / height).min(rows - 1)];
    (coarser < map.levels()).then_some(place)
}

/// At most [`SAMPLES`] of these, of all places.
fn thinned(footprint: Vec<Sample>) -> Vec<Sample> {
    if footprint.len() <= SAMPLES {
        return footprint;
    }
    let total: f64 = footprint.iter().map(|sample| sample.weight).sum();
    let picked = |i: usize| footprint[((GOLDEN * i as f64).fract() * footprint.len() as f64) as usize];
    (0..SAMPLES).map(|i| Sample { weight: total / SAMPLES as f64, ..picked(i) }).collect()
}
