//! The one error type of the room.

use airglow_gpu::{GpuError, Outside};
use airglow_math::MathError;

/// Why incident radiance could not be sampled or reconstructed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RadianceError {
    /// A spherical-harmonic order, face size or other argument of the mathematics below.
    #[error(transparent)]
    Math(#[from] MathError),
    /// A refusal of the device layer.
    #[error("radiance: {0}")]
    Gpu(#[from] GpuError),
    /// A slice whose length does not fit the other arguments.
    #[error("{what} has {actual} elements but {expected} are needed: resize it")]
    Length {
        /// Which slice.
        what: &'static str,
        /// The length that fits.
        expected: usize,
        /// The length that was given.
        actual: usize,
    },
    /// A value that is NaN or infinite, or a radiance below zero.
    #[error("{what} {index} is {value}: give finite numbers, and no negative radiance")]
    Value {
        /// Which list.
        what: &'static str,
        /// Which element of it.
        index: usize,
        /// The element.
        value: String,
    },
    /// A setting out of range.
    #[error("{name} is {value}: give {range}")]
    Setting {
        /// Name of the setting.
        name: &'static str,
        /// What was given.
        value: String,
        /// What can be given.
        range: &'static str,
    },
    /// Settings that pipelines were not prepared for.
    #[error("radiance: {0}")]
    Envelope(#[from] Outside),
    /// A receiver that the memory budget has no room for.
    #[error("the receiver takes {size} bytes and the memory budget has {left} left: {mend}")]
    Budget {
        /// Bytes needed, those of copies to the device included.
        size: u64,
        /// Bytes left.
        left: u64,
        /// The next settings that fit, in words.
        mend: String,
    },
    /// More vertices than the hierarchy's indices can hold.
    #[error("the receiver has {count} vertices: give at most {limit}")]
    TooMany {
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
    /// Two emitters that cover one another, seen from the point asked for.
    #[error(
        "emitters {first} and {second} overlap as seen from the point: the closed form knows no occlusion; use a cube map"
    )]
    Overlap {
        /// The first of the two.
        first: usize,
        /// The second of the two.
        second: usize,
    },
    /// Emitters that touch each other or the point in single precision, though not in double.
    #[error(
        "emitters touch each other or the point, too closely for a device to tell them apart: use a cube map"
    )]
    Touching,
    /// The caller's progress function asked to stop.
    #[error("building the hierarchy was cancelled")]
    Cancelled,
}

impl RadianceError {
    pub(crate) fn setting(name: &'static str, value: impl ToString, range: &'static str) -> Self {
        Self::Setting { name, value: value.to_string(), range }
    }
}
