//! Why a command ended early, and the exit code that says so to scripts.

use std::fmt::Display;
use std::path::Path;

/// The kinds of failure, one exit code each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Files could not be written, or Vulkan refused a call.
    Work,
    /// Options that contradict each other.
    Usage,
    /// A measured value is outside the tolerance asked for.
    Check,
    /// No device fits, or it lacks a required feature.
    Device,
    /// An input file or value was refused.
    Input,
}

/// A failure with a message that names the file or item and the mend.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub struct Failure {
    kind: Kind,
    message: String,
}

impl Failure {
    /// Something went wrong while working.
    pub fn work(message: impl Display) -> Self {
        Self::new(Kind::Work, message)
    }

    /// The command line contradicts itself.
    pub fn usage(message: impl Display) -> Self {
        Self::new(Kind::Usage, message)
    }

    /// A check did not hold.
    pub fn check(message: impl Display) -> Self {
        Self::new(Kind::Check, message)
    }

    /// No device fits.
    pub fn device(message: impl Display) -> Self {
        Self::new(Kind::Device, message)
    }

    /// An input was refused.
    pub fn input(message: impl Display) -> Self {
        Self::new(Kind::Input, message)
    }

    /// A file could not be read or written.
    pub fn file(path: &Path, doing: &str, source: impl Display) -> Self {
        Self::work(format!("{}: {doing} failed: {source}", path.display()))
    }

    fn new(kind: Kind, message: impl Display) -> Self {
        Self { kind, message: message.to_string() }
    }

    /// The process exit code documented in `airglow --help`.
    pub fn exit_code(&self) -> u8 {
        match self.kind {
            Kind::Work => 1,
            Kind::Usage => 2,
            Kind::Check => 3,
            Kind::Device => 4,
            Kind::Input => 5,
        }
    }

    /// The kind as a word for JSON.
    pub fn kind_name(&self) -> &'static str {
        match self.kind {
            Kind::Work => "work",
            Kind::Usage => "usage",
            Kind::Check => "check",
            Kind::Device => "device",
            Kind::Input => "input",
        }
    }
}

/// What every command returns.
pub type Outcome<T = ()> = Result<T, Failure>;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_have_distinct_exit_codes_other_than_success() {
        let failures = [
            Failure::work(""),
            Failure::usage(""),
            Failure::check(""),
            Failure::device(""),
            Failure::input(""),
        ];
        let mut codes: Vec<u8> = failures.iter().map(Failure::exit_code).collect();
        codes.sort_unstable();
        codes.dedup();
        assert_eq!(codes.len(), failures.len());
        assert!(!codes.contains(&0));
    }
}
