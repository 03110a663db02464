//! What this room refuses, and the mend.

use airglow_gpu::{GpuError, Outside};
use airglow_math::MathError;

/// Why the room refused its input.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ShadowError {
    /// An order for which there are no tables.
    #[error("shadow: order {order}: give 3 to 6")]
    Order {
        /// The order that was asked for.
        order: usize,
    },
    /// A number out of its range.
    #[error("shadow: {what} is {value}: give {range}")]
    Range {
        /// Which number.
        what: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
    /// A list that is not as long as another asks for.
    #[error("shadow: {what}: {expected} are needed, {actual} were given")]
    Length {
        /// Which list.
        what: &'static str,
        /// Its length as it should be.
        expected: usize,
        /// Its length.
        actual: usize,
    },
    /// A method by a name that is not known.
    #[error("shadow: method `{method}`: expected {known}")]
    Method {
        /// What was asked for.
        method: String,
        /// What there is.
        known: &'static str,
    },
    /// Settings that pipelines were not prepared for.
    #[error("shadow: {0}")]
    Envelope(#[from] Outside),
    /// A refusal of the mathematics.
    #[error("shadow: {0}")]
    Math(#[from] MathError),
    /// A refusal of the device layer.
    #[error("shadow: {0}")]
    Gpu(#[from] GpuError),
}
