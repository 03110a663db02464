//! Why a cache file was not used or not written.

use std::path::PathBuf;

/// Why a file could not be used. None of these is an error: the bake is made again.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Miss {
    /// There is no such file.
    #[error("no cache file yet")]
    Absent,
    /// The file cannot be read.
    #[error("the cache file cannot be read: {0}")]
    Unreadable(#[source] std::io::Error),
    /// Not a safetensors file, cut short, or damaged.
    #[error("the cache file is damaged: {0}")]
    Damaged(String),
    /// A sound safetensors file that is no bake.
    #[error("the file is not such a cache of airglow")]
    Foreign,
    /// Written by another version.
    #[error("the cache file has schema {found}, which this version does not write")]
    OtherSchema {
        /// Its schema.
        found: u32,
    },
    /// Another mesh, other occluders or other settings.
    #[error("the cache file belongs to another mesh, other occluders or other settings")]
    OtherInput,
    /// Stored in the other precision.
    #[error("the cache file is stored in the other precision")]
    OtherPrecision,
}

/// Why a file could not be written. The previous file, if any, is as it was.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CacheError {
    /// The system refused.
    #[error("cannot write the cache {path}: {source}; check that its folder exists and has room")]
    Write {
        /// The target.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The transfer's arrays do not have the shape it states.
    #[error("the transfer has {found} coefficients where order² · vertices = {expected}")]
    Shape {
        /// Values present.
        found: usize,
        /// Values stated.
        expected: usize,
    },
    /// The container library refused.
    #[error("cannot encode the cache: {0}")]
    Encode(String),
}
