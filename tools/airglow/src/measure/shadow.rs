//! What the shadow pass found near its receivers.

use airglow::shadow::Counts;
use serde::Serialize;

/// Counts of one frame, the same on every machine.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ShadowStat {
    /// Spheres of the frame.
    spheres: usize,
    /// Clusters of up to 64 receivers.
    clusters: u64,
    /// Clusters out of reach of every sphere, which run no exponential.
    open_clusters: u64,
    /// Spheres that were looked at, over the clusters that have some.
    spheres_per_cluster: f64,
    /// Receivers whose visibility was clamped to one that there can be.
    clamped: u64,
}

impl ShadowStat {
    /// Of a frame with so many spheres.
    pub fn new(spheres: usize, counts: Counts) -> Self {
        let Counts { clusters, open, clamped, .. } = counts;
        let spheres_per_cluster = counts.spheres as f64 / (clusters - open).max(1) as f64;
        Self { spheres, clusters, open_clusters: open, spheres_per_cluster, clamped }
    }

    /// The same for people.
    pub fn line(&self) -> String {
        let Self { spheres, clusters, open_clusters, spheres_per_cluster, clamped } = self;
        format!(
            "  shadow: {spheres} spheres; {open_clusters} of {clusters} clusters out of reach, {spheres_per_cluster:.1} \
             spheres in each other; {clamped} receivers clamped\n"
        )
    }
}
