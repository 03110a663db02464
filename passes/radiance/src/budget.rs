//! What a receiver takes, and the settings that fit.

use crate::gpu::RefineState;
use crate::pass_settings::PassSettings;
use crate::{RadianceError, Settings};

/// Fewest samples that halving the limit ends at.
const FEWEST: usize = 64;

impl PassSettings {
    /// Bytes that the samples of a receiver take whose tree has so many nodes, one less than twice its vertices.
    #[must_use]
    pub fn sample_bytes(&self, nodes: usize) -> u64 {
        let (shape, samples) = (self.shape(), self.refinement.limit.min(nodes));
        let words = 4 * (nodes + 4 * samples) as u64;
        let each = 4 * samples as u64 + shape.light_bytes(samples) + shape.gradient_bytes(samples);
        // Those of the frame before are there as well where samples are kept.
        words + (each + size_of::<RefineState>() as u64) * (1 + u64::from(self.keep > 0.0))
    }

    /// The settings nearest below these whose samples fit `bytes`: half as many, and half again, before samples without
    /// gradients, which cost more error. None when not even those fit: split the receiver.
    #[must_use]
    pub fn next_that_fits(&self, nodes: usize, bytes: u64) -> Option<Self> {
        let limit = self.refinement.limit.min(nodes);
        let limits = std::iter::successors(Some(limit), |limit| (limit / 2 >= FEWEST).then_some(limit / 2));
        let limits: Vec<usize> = limits.collect();
        let with =
            |gradients, limit| Self { gradients, refinement: Settings { limit, ..self.refinement }, ..*self };
        let below = limits.iter().map(|limit| with(self.gradients, *limit));
        let coarser = limits.iter().filter(|_| self.gradients).map(|limit| with(false, *limit));
        below.chain(coarser).find(|settings| settings.sample_bytes(nodes) <= bytes)
    }

    /// Refuses a receiver that a budget has no room for, and says which settings have: `beside` bytes are not samples.
    pub(crate) fn check_budget(
        &self,
        nodes: usize,
        beside: u64,
        left: Option<u64>,
    ) -> Result<(), RadianceError> {
        let size = beside.saturating_add(self.sample_bytes(nodes));
        let Some(left) = left.filter(|left| size > *left) else { return Ok(()) };
        let mend = match self.next_that_fits(nodes, left.saturating_sub(beside)) {
            Some(next) if next.gradients == self.gradients => {
                format!("a limit of {} samples would fit", next.refinement.limit)
            }
            Some(next) => {
                format!("a limit of {} samples without gradients would fit", next.refinement.limit)
            }
            None => "no setting fits; raise the budget or split the receiver".to_owned(),
        };
        Err(RadianceError::Budget { size, left, mend })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_halved_before_gradients_go() {
        let settings = PassSettings::default();
        let next = |bytes| {
            let next = settings.next_that_fits(10_000, bytes)?;
            assert!(next.sample_bytes(10_000) <= bytes, "{next:?}");
            Some((next.refinement.limit, next.gradients))
        };
        let limit = settings.refinement.limit;
        let whole = settings.sample_bytes(10_000);
        assert_eq!(next(whole), Some((limit, true)));
        assert_eq!(next(whole - 1), Some((limit / 2, true)));
        // With one of the fewest limits samples hold no gradients.
        assert!(!next(80_000).unwrap().1, "{:?}", next(80_000));
        assert_eq!(next(40_000), None, "the nodes alone take as much");
    }
}
