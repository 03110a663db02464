//! What this room refuses, and the mend.

use std::path::PathBuf;

use airglow_gpu::{GpuError, Outside};
use airglow_math::MathError;

/// Why an input was refused.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NormalsError {
    /// A map whose size is none, or does not fit its texels.
    #[error("normal map of {width} x {height} with {texels} texels: {mend}")]
    Size {
        /// Its width in texels.
        width: usize,
        /// Its height in texels.
        height: usize,
        /// How many texels came.
        texels: usize,
        /// What to change.
        mend: &'static str,
    },
    /// A texel that the map does not have.
    #[error("normal map: level {level} has no texel ({x}, {y}): it is {width} x {height}")]
    Texel {
        /// The level.
        level: usize,
        /// The column.
        x: usize,
        /// The row.
        y: usize,
        /// Texels of a row at that level.
        width: usize,
        /// Rows at that level.
        height: usize,
    },
    /// A method that has no code on the device.
    #[error(
        "normals: there is no method `{method}` on the device: give vmf:1, vmf:2, vmf:4, vmf:6, vmf:4x4, sh:3, sh:4, sh:5, mip, length, \
         toksvig, roughness, geometric, lean or default"
    )]
    Method {
        /// What was asked for.
        method: String,
    },
    /// A number out of its range.
    #[error("normals: {what} is {value}: give {range}")]
    Range {
        /// What the number is.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What is accepted, in words.
        range: &'static str,
    },
    /// A chain that does not fit its budget.
    #[error("normals: the chain takes {bytes} bytes of {budget}: {mend}")]
    Budget {
        /// What it takes.
        bytes: u64,
        /// What it may take.
        budget: u64,
        /// The next setting that fits.
        mend: String,
    },
    /// Settings that pipelines were not prepared for.
    #[error("normals: {0}")]
    Envelope(#[from] Outside),
    /// A chain that is not of its map.
    #[error("normals: the chain has not the levels of its map: build it from this map with these settings")]
    Chain,
    /// A chain that could not be kept in a file.
    #[error("normals: {0}")]
    Store(#[source] Box<StoreError>),
    /// A refusal of the device layer.
    #[error("normals: {0}")]
    Gpu(#[from] GpuError),
    /// A refusal of the mathematics.
    #[error("normals: {0}")]
    Math(#[from] MathError),
}

impl From<StoreError> for NormalsError {
    fn from(error: StoreError) -> Self {
        Self::Store(Box::new(error))
    }
}

/// Why a chain could not be kept in a file; what was at its path is untouched.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoreError {
    /// The levels are not those of the map.
    #[error("the chain has not the levels of its map: build it from this map with these settings")]
    Shape,
    /// The container refused.
    #[error("the chain cannot be encoded: {0}")]
    Encode(String),
    /// The file system refused.
    #[error("{path}: {source}: choose a folder that can be written")]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The settings are out of range or the chain is over its budget.
    #[error(transparent)]
    Chain(#[from] NormalsError),
}
