//! What this room refuses, and the mend.

use airglow_gpu::{GpuError, Outside};
use airglow_math::MathError;

/// Why the pass refused its input.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FogError {
    /// A number out of its range.
    #[error("fog: {field} is {value}: give {range}")]
    Range {
        /// The field of the settings, the medium, the camera or a light, such as `lights[2].radius`.
        field: String,
        /// Its value.
        value: f64,
        /// What is accepted, in words.
        range: &'static str,
    },
    /// More lights than a frame holds.
    #[error("fog: {count} lights: give at most {max}, those that matter most", max = crate::limits::MAX_LIGHTS)]
    TooManyLights {
        /// How many were given.
        count: usize,
    },
    /// A medium that the settings have no kernel for.
    #[error("fog: the medium {what}, the settings have no kernel for it: {mend}")]
    Kernel {
        /// What it has.
        what: &'static str,
        /// What to set.
        mend: &'static str,
    },
    /// What pipelines were not prepared for.
    #[error("fog: {0}")]
    Envelope(#[from] Outside),
    /// A frame that needs another plan than the one it is put into.
    #[error("fog: {what}: declare the frame anew")]
    Plan {
        /// What is different.
        what: &'static str,
    },
    /// A refusal of the mathematics.
    #[error("fog: {0}")]
    Math(#[from] MathError),
    /// A refusal of the device layer.
    #[error("fog: {0}")]
    Gpu(#[from] GpuError),
}

/// Refuses a value for which `allowed` does not hold; NaN never is allowed.
pub(crate) fn check(
    field: impl FnOnce() -> String,
    value: f64,
    allowed: bool,
    range: &'static str,
) -> Result<(), FogError> {
    if allowed && !value.is_nan() { Ok(()) } else { Err(FogError::Range { field: field(), value, range }) }
}
