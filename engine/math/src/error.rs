//! The one error type of the room: what was wrong with an argument, and how to mend it.

use crate::axis::Axis;
use crate::order::MAX_ORDER;

/// Why a function of this crate refused its input.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MathError {
    /// A spherical-harmonic order outside 1..=[`MAX_ORDER`].
    #[error("spherical-harmonic order {order} is not supported: give 1 to {MAX_ORDER}")]
    Order {
        /// The order that was asked for.
        order: usize,
    },
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
    /// A quaternion that stands for no rotation.
    #[error("quaternion ({x}, {y}, {z}, {w}) is zero or not finite: give a finite one of non-zero length")]
    Quaternion {
        /// First vector component.
        x: f64,
        /// Second vector component.
        y: f64,
        /// Third vector component.
        z: f64,
        /// Scalar component.
        w: f64,
    },
    /// A matrix that is neither a rotation nor a reflection.
    #[error("the matrix departs from an orthogonal one by {deviation}: give a rotation or a reflection")]
    Orthogonal {
        /// Largest element of its transpose times itself less the identity.
        deviation: f64,
    },
    /// Axes of which two lie along the same line.
    #[error(
        "right {right:?}, up {up:?} and forward {forward:?} lie along fewer than three axes: give each its own"
    )]
    Axes {
        /// What points to the right.
        right: Axis,
        /// What points up.
        up: Axis,
        /// What points forward.
        forward: Axis,
    },
    /// A map or table with a side of no texels, or of more than the limit.
    #[error("{what} of {width} x {height} is not supported: give sides of 1 to {limit}")]
    Size {
        /// Which map or table.
        what: &'static str,
        /// Columns asked for.
        width: usize,
        /// Rows asked for.
        height: usize,
        /// The largest side that is accepted.
        limit: usize,
    },
    /// A texel, row or column outside its map.
    #[error("{what} index {index} lies outside 0..{count}: give a smaller one")]
    Index {
        /// Which index.
        what: &'static str,
        /// The index that was given.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// Texels that are NaN or infinite.
    #[error("{count} texels are NaN or infinite, the first at column {column}, row {row}: replace them")]
    NonFiniteTexels {
        /// How many texels have a component that is not finite.
        count: usize,
        /// Column of the first one.
        column: usize,
        /// Row of the first one.
        row: usize,
    },
    /// A scalar argument outside its range.
    #[error("{what} is {value}: give {range}")]
    Range {
        /// Which argument.
        what: &'static str,
        /// The value that was given.
        value: f64,
        /// What is accepted, in words.
        range: &'static str,
    },
    /// An integrand that is NaN or infinite at a node.
    #[error("the integrand is not finite at {at}: split the interval there or remove the singularity")]
    Integrand {
        /// The abscissa.
        at: f64,
    },
    /// An adaptive integration that ran out of intervals.
    #[error(
        "no convergence: the integral is {value} with an error of {error}; loosen the tolerance or split the interval"
    )]
    NoConvergence {
        /// The best estimate so far.
        value: f64,
        /// Its estimated absolute error.
        error: f64,
    },
    /// A name that no preset has.
    #[error("there is no preset \"{name}\": give low, medium, high or reference")]
    Preset {
        /// The name that was given.
        name: String,
    },
    /// A statistic of no samples.
    #[error("{what} needs at least one sample: give some")]
    NoSamples {
        /// Which statistic.
        what: &'static str,
    },
}

/// Accepts `actual == expected`.
pub(crate) fn check_length(what: &'static str, expected: usize, actual: usize) -> Result<(), MathError> {
    if actual == expected { Ok(()) } else { Err(MathError::Length { what, expected, actual }) }
}
