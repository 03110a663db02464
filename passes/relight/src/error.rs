//! What this room refuses, and the mend.

use airglow_gpu::{GpuError, Outside};
use airglow_math::MathError;

/// Why relighting refused its input.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RelightError {
    /// An order outside 1..=6.
    #[error("relight: order {order} is not supported: give 1 to {max}", max = crate::order::MAX_ORDER)]
    Order {
        /// The order that was asked for.
        order: usize,
    },
    /// A combination of settings that has no kernel.
    #[error("relight: {what}: {mend}")]
    Settings {
        /// What does not go together.
        what: &'static str,
        /// What to choose instead.
        mend: &'static str,
    },
    /// Settings that pipelines were not prepared for.
    #[error("relight: {0}")]
    Envelope(#[from] Outside),
    /// A slice whose length does not fit.
    #[error("relight: {what} of \"{name}\" has {actual} values but {expected} are needed: resize it")]
    Length {
        /// The mesh or image.
        name: String,
        /// Which slice.
        what: &'static str,
        /// Values needed.
        expected: usize,
        /// Values given.
        actual: usize,
    },
    /// Values that the arithmetic cannot carry.
    #[error("relight: {count} of the {what} of \"{name}\" are {problem}, the first at {first}: replace them")]
    Values {
        /// The mesh or image.
        name: String,
        /// Which values.
        what: &'static str,
        /// NaN, infinite, negative or past the range of half floats.
        problem: &'static str,
        /// How many.
        count: usize,
        /// Index of the first one.
        first: usize,
    },
    /// A mesh or image with a size out of range.
    #[error("relight: \"{name}\" has {what} of {actual}: give {allowed}")]
    Size {
        /// The mesh or image.
        name: String,
        /// Which measure.
        what: &'static str,
        /// Its value.
        actual: u64,
        /// What is accepted, in words.
        allowed: String,
    },
    /// A mesh that the memory budget has no room for.
    #[error(
        "relight: the vectors of \"{name}\" take {size} bytes and the memory budget has {left} left: {mend}"
    )]
    Budget {
        /// The mesh.
        name: String,
        /// Bytes needed, those of the copy to the device included.
        size: u64,
        /// Bytes left.
        left: u64,
        /// The next settings that fit, in words.
        mend: String,
    },
    /// A mesh that was dropped, or belongs to another `Relight`.
    #[error("relight: mesh {index} is not here any more: use the id that `add_mesh` returned last")]
    UnknownMesh {
        /// Index in the id.
        index: u32,
    },
    /// An instance whose inputs do not fit the settings.
    #[error("relight: instance {instance}: {what}: {mend}")]
    Instance {
        /// Index of the instance in the frame.
        instance: usize,
        /// What is wrong.
        what: &'static str,
        /// What to do about it.
        mend: &'static str,
    },
    /// A matrix that is no rotation with a uniform scale.
    #[error("relight: the instance's matrix {problem}: bake its transfer in world space instead")]
    Matrix {
        /// Why it cannot be used.
        problem: &'static str,
    },
    /// A refusal of the mathematics, such as a zero quaternion.
    #[error("relight: {0}")]
    Math(#[from] MathError),
    /// A refusal of the device layer.
    #[error("relight: {0}")]
    Gpu(#[from] GpuError),
}
