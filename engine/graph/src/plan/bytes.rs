//! Bytes of a plan, known before anything is allocated.

use super::{Plan, PlanResource};
use crate::resource::Origin;

/// Bytes of the resources that steps use. Image bytes are of texels; a device may need more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct PlanBytes {
    /// Of imports, which the host holds.
    pub imported: u64,
    /// Of transients, each with memory of its own.
    pub transient: u64,
    /// The largest sum of transients alive at one step: what perfect aliasing would need.
    pub transient_peak: u64,
    /// What sharing memory would save of it ([`Plan::sharing`]): an estimate.
    pub sharing_would_save: u64,
    /// Resources whose size is not known before allocation, and not counted above.
    pub unknown: usize,
}

impl<R> Plan<R> {
    /// Bytes of the resources that steps use.
    pub fn bytes(&self) -> PlanBytes {
        let used = || self.resources.iter().filter(|resource| resource.lifetime.is_some());
        let sum = |imported: bool| {
            let wanted = used().filter(|r| matches!(r.origin, Origin::Imported { .. }) == imported);
            wanted.filter_map(|r| r.bytes).fold(0, u64::saturating_add)
        };
        let alive = |step: usize| {
            let here = used().filter(|r| r.origin == Origin::Transient && alive_at(r, step));
            here.filter_map(|r| r.bytes).fold(0, u64::saturating_add)
        };
        PlanBytes {
            imported: sum(true),
            transient: sum(false),
            transient_peak: (0..self.steps.len()).map(alive).max().unwrap_or(0),
            sharing_would_save: self.sharing().saved(),
            unknown: used().filter(|r| r.bytes.is_none()).count(),
        }
    }
}

fn alive_at(resource: &PlanResource, step: usize) -> bool {
    let end = |last| if !resource.exports.is_empty() { usize::MAX } else { last };
    resource.lifetime.is_some_and(|l| (l.first..=end(l.last)).contains(&step))
}
