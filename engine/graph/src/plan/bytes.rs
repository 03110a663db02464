//! Bytes of a plan, known before anything is allocated.

use super::{Plan, PlanAccess, PlanResource};
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

    /// Bytes of the resources that step `index` uses, each once and whole; 0 for a step that is not there. Resources
    /// whose size is not known before allocation are not counted.
    pub fn step_bytes(&self, index: usize) -> u64 {
        let accesses = self.steps.get(index).map_or(&[][..], |step| &step.accesses);
        let first = |(place, access): &(usize, &PlanAccess)| {
            accesses[..*place].iter().all(|before| before.resource != access.resource)
        };
        let once = accesses.iter().enumerate().filter(first);
        let bytes = once.filter_map(|(_, access)| self.resources[access.resource.index()].bytes);
        bytes.fold(0, u64::saturating_add)
    }
}

fn alive_at(resource: &PlanResource, step: usize) -> bool {
    let end = |last| if !resource.exports.is_empty() { usize::MAX } else { last };
    resource.lifetime.is_some_and(|l| (l.first..=end(l.last)).contains(&step))
}

#[cfg(test)]
mod tests {
    use crate::{Access, BufferDesc, Graph, Limits, PassKind};

    #[test]
    fn a_step_counts_each_of_its_resources_once() {
        let mut graph = Graph::new();
        let mut make = graph.pass("make", PassKind::Compute);
        let numbers = make.create_buffer("numbers", BufferDesc::new(64), Access::ComputeStorageWrite);
        let sums = make.create_buffer("sums", BufferDesc::new(16), Access::ComputeStorageWrite);
        make.record(());
        let mut add = graph.pass("add", PassKind::Compute);
        add.read(&numbers, Access::ComputeStorageRead).read(&numbers, Access::ComputeUniform);
        let sums = add.update(sums, Access::ComputeStorageReadWrite);
        add.record(());
        graph.export(sums, Access::VertexBuffer);
        let plan = graph.compile(&Limits::default()).unwrap();
        assert_eq!([0, 1, 2].map(|step| plan.step_bytes(step)), [80, 80, 0]);
    }
}
