//! What the kernel counts while it runs, one record a cluster, in a fixed order and without atomics.

/// Sums over the clusters of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Clusters of up to 64 receivers.
    pub clusters: u64,
    /// Clusters out of reach of every sphere, which run no exponential.
    pub open: u64,
    /// Spheres, summed over clusters.
    pub spheres: u64,
    /// Receivers whose result was none that a visibility can have.
    pub clamped: u64,
}

impl Counts {
    /// Sums the records of a frame as they were read back: spheres and clamped receivers of each cluster.
    #[must_use]
    pub fn of(records: &[[u32; 2]]) -> Self {
        records.iter().fold(Self::default(), |sum, &[spheres, clamped]| Self {
            clusters: sum.clusters + 1,
            open: sum.open + u64::from(spheres == 0),
            spheres: sum.spheres + u64::from(spheres),
            clamped: sum.clamped + u64::from(clamped),
        })
    }
}
