//! What can go wrong, each case naming the file, the item in it and the mend.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a file could not be read or written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The file system refused to read.
    #[error("{}: cannot be read: {source}; check the path and its permissions", file.display())]
    Read {
        /// The file asked for.
        file: PathBuf,
        /// What the file system said.
        source: io::Error,
    },
    /// The file system refused to write; the target is as it was before.
    #[error("{}: cannot be written: {source}; check that the folder exists, is writable and has room", file.display())]
    Write {
        /// The file asked for.
        file: PathBuf,
        /// What the file system said.
        source: io::Error,
    },
    /// The content breaks the rules of its format or has no meaning.
    #[error("{}: {item}: {problem}; {mend}", file.display())]
    Invalid {
        /// The file at fault.
        file: PathBuf,
        /// The item in the file, such as `mesh 2 "roof", primitive 0`.
        item: String,
        /// What is wrong.
        problem: String,
        /// How to put it right.
        mend: String,
    },
    /// The content is legal, but this crate does not read it.
    #[error("{}: {item}: {feature} is not supported; {mend}", file.display())]
    Unsupported {
        /// The file at fault.
        file: PathBuf,
        /// The item in the file.
        item: String,
        /// What is not supported.
        feature: String,
        /// What to do instead.
        mend: String,
    },
    /// A size exceeds a cap of [`crate::limits`]; found before memory was taken.
    #[error("{}: {item}: {found} {unit} exceed the limit of {limit}; {mend}", file.display())]
    TooLarge {
        /// The file at fault.
        file: PathBuf,
        /// The item in the file.
        item: String,
        /// The size asked for, in `unit`.
        found: u64,
        /// The cap, in `unit`.
        limit: u64,
        /// What is counted.
        unit: &'static str,
        /// How to make it smaller.
        mend: &'static str,
    },
    /// A scene file does not follow the schema of this crate's README.
    #[error("{}:{line}:{column}: {problem}", file.display())]
    SceneFile {
        /// The scene file.
        file: PathBuf,
        /// Line of the fault, from 1.
        line: usize,
        /// Column of the fault in characters, from 1.
        column: usize,
        /// What is wrong and what is expected there.
        problem: String,
    },
    /// An environment holds NaN, infinite or negative radiance.
    #[error(
        "{}: {count} pixels are NaN, infinite or negative, first at column {x}, row {y}: {value:?}; clamp them to finite, non-negative values and save again",
        file.display()
    )]
    Radiance {
        /// The image.
        file: PathBuf,
        /// How many pixels are at fault.
        count: usize,
        /// Column of the first, from 0 at the left.
        x: usize,
        /// Row of the first, from 0 at the top.
        y: usize,
        /// Its red, green and blue.
        value: [f32; 3],
    },
}

/// Makes a [`SceneError::Invalid`].
pub(crate) fn invalid(
    file: &Path,
    item: impl Into<String>,
    problem: impl Into<String>,
    mend: impl Into<String>,
) -> SceneError {
    SceneError::Invalid {
        file: file.to_path_buf(),
        item: item.into(),
        problem: problem.into(),
        mend: mend.into(),
    }
}

/// Makes a [`SceneError::Unsupported`].
pub(crate) fn unsupported(
    file: &Path,
    item: impl Into<String>,
    feature: impl Into<String>,
    mend: impl Into<String>,
) -> SceneError {
    SceneError::Unsupported {
        file: file.to_path_buf(),
        item: item.into(),
        feature: feature.into(),
        mend: mend.into(),
    }
}

/// Refuses `found` above `limit`.
pub(crate) fn at_most(
    file: &Path,
    item: impl Into<String>,
    found: u64,
    limit: u64,
    unit: &'static str,
    mend: &'static str,
) -> Result<(), SceneError> {
    if found <= limit {
        return Ok(());
    }
    Err(SceneError::TooLarge { file: file.to_path_buf(), item: item.into(), found, limit, unit, mend })
}
