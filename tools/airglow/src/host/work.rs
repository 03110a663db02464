//! What each pass of a frame did, in counts that are the same on every machine.

use airglow_gpu::{Counts, Execution};

/// What a pass did in the frame recorded last.
#[derive(Clone, Debug)]
pub struct PassWork {
    /// Its name.
    pub name: String,
    /// Its counts.
    pub counts: Counts,
}

/// The work of every pass, in the plan's order.
pub fn of_frame(execution: &Execution) -> Vec<PassWork> {
    let passes = execution.plan().steps().iter().zip(execution.counts());
    passes.map(|(step, &counts)| PassWork { name: step.name.clone(), counts }).collect()
}
