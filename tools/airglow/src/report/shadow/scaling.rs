//! Time by the number of blockers.

use std::collections::BTreeMap;

use airglow::shadow::bench::SphereKernel;
use airglow::shadow::{Blockers, Exponential};
use glam::DMat4;

use super::methods::{crowd, ground, plain};
use super::{Measurement, Rival};
use crate::failure::{Failure, Outcome};
use crate::report::model::Point;

/// Bands.
const ORDER: usize = 4;

impl Measurement<'_> {
    /// Points of so many spheres each, none of which is left out.
    pub fn blockers(&self, counts: &[usize]) -> Outcome<Vec<(f64, Point)>> {
        let mut crowds = BTreeMap::new();
        for &count in counts {
            let blockers = Blockers::default();
            blockers.set(&crowd(count), DMat4::IDENTITY).map_err(Failure::work)?;
            crowds.insert(count.to_string(), blockers);
        }
        let rival = |count: &usize| Rival {
            name: count.to_string(),
            settings: plain(ORDER, Exponential::Adaptive),
            kernel: SphereKernel::Pass,
        };
        let rivals: Vec<Rival> = counts.iter().map(rival).collect();
        let of = |rival: &Rival| crowds.get(&rival.name).cloned().unwrap_or_default();
        let timed = self.interleaved(&rivals, &ground(self.effort.side), None, of)?;
        Ok(counts.iter().zip(timed).map(|(count, (point, _))| (*count as f64, point)).collect())
    }
}
