//! What this room refuses, and the mend.

use airglow_gpu::GpuError;

/// Why the pass refused its input.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum __Room__Error {
    /// An exposure out of range.
    #[error("__room__: an exposure of {stops} stops: give -{most} to {most}")]
    Stops {
        /// The exposure that was asked for.
        stops: f64,
        /// The most that is accepted.
        most: f64,
    },
    /// A refusal of the device layer.
    #[error("__room__: {0}")]
    Gpu(#[from] GpuError),
}
