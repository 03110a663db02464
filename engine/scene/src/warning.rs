//! What was left out or mended while loading, so that nothing is dropped in silence.

use std::fmt;
use std::path::{Path, PathBuf};

/// Something the file asked for that the scene does not hold, or that was mended on the way in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The file it stands in.
    pub file: PathBuf,
    /// The item in the file, such as `material 3 "glass"`.
    pub item: String,
    /// What was left out or mended, and what the scene holds instead.
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}: {}: {}", self.file.display(), self.item, self.message)
    }
}

/// The warnings of one file while it is read.
#[derive(Debug)]
pub(crate) struct Warnings<'a> {
    pub(crate) file: &'a Path,
    pub(crate) list: Vec<Warning>,
}

impl<'a> Warnings<'a> {
    pub(crate) fn new(file: &'a Path) -> Self {
        Self { file, list: Vec::new() }
    }

    pub(crate) fn add(&mut self, item: impl Into<String>, message: impl Into<String>) {
        self.list.push(Warning { file: self.file.to_path_buf(), item: item.into(), message: message.into() });
    }

    /// Adds a warning that starts with `count`, unless `count` is 0.
    pub(crate) fn count(&mut self, item: &str, count: usize, message: &str) {
        if count > 0 {
            self.add(item, format!("{count} {message}"));
        }
    }
}
