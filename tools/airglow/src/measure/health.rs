//! What the passes count while they work: inputs that are not finite, limits that were hit, and the like.

use airglow_gpu::Health;
use serde::Serialize;

use crate::failure::{Failure, Outcome};
use crate::host::device::Device;

/// A counter and its count since it was cleared.
#[derive(Clone, Debug, Serialize)]
pub struct Count {
    name: String,
    count: u32,
}

/// The counts of all frames since.
pub fn collect(device: &Device<'_>, health: &mut Health) -> Outcome<Vec<Count>> {
    let context = device.context();
    device.run(|recorder| health.collect(recorder)).map_err(Failure::work)?;
    // A frame is known to be done when as many as are in flight have begun after it.
    for _ in 0..context.frames_in_flight() {
        device.run(|_| Ok(())).map_err(Failure::work)?;
    }
    let counts = health.latest(context).map_err(Failure::work)?.map_or(Vec::new(), |latest| latest.counts);
    Ok(counts.into_iter().map(|(name, count)| Count { name, count }).collect())
}

impl Count {
    /// A line of the text.
    pub fn line(&self) -> String {
        format!("  {:32} {}\n", self.name, self.count)
    }
}
