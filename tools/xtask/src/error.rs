//! What can go wrong in a developer command.

use std::path::{Path, PathBuf};

/// An error whose message names the file and what to do.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file could not be read or written.
    #[error("{path}: {source}")]
    Io {
        /// The file.
        path: PathBuf,
        /// The operating system's answer.
        source: std::io::Error,
    },
    /// The manifest is malformed.
    #[error("{path}: {message}")]
    Manifest {
        /// The manifest.
        path: PathBuf,
        /// What is wrong in it, and the mend.
        message: String,
    },
    /// GLSL was refused; the log names file and line.
    #[error("{module} does not compile:\n{log}")]
    Compile {
        /// The module's name.
        module: String,
        /// The compiler's messages, with `file:line`.
        log: String,
    },
    /// The committed SPIR-V is not what the GLSL compiles to.
    #[error(
        "{0} of the SPIR-V files are not what their GLSL compiles to; run `cargo run -p xtask -- shaders`"
    )]
    Stale(usize),
    /// The committed table of translations is not what the modules give.
    #[error("{0} is not what the modules give; run `cargo run -p xtask -- portability`")]
    StaleTable(PathBuf),
    /// The C header cannot be made.
    #[error("{path}: {problem}")]
    Header {
        /// The source it is made from.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// The committed C header is not what its source gives.
    #[error("{0} is not what its source gives; run `cargo run -p xtask -- header`")]
    StaleHeader(PathBuf),
    /// No room of the manifest has the name asked for.
    #[error("no entry of the manifest lies in a room named `{0}`")]
    NoSuchRoom(String),
    /// A room that cannot be made or removed.
    #[error("room `{name}`: {problem}")]
    Room {
        /// The name given.
        name: String,
        /// What is wrong with it, and the mend.
        problem: &'static str,
    },
    /// A program that was started failed.
    #[error("`{command}` failed: {problem}")]
    Command {
        /// The program and its arguments.
        command: String,
        /// How it ended.
        problem: String,
    },
    /// A mesh that an asset is made from lacks something.
    #[error("{path}: {message}")]
    Asset {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        message: String,
    },
    /// The external compiler of the debug set failed.
    #[error("{0}")]
    DebugSet(String),
}

impl Error {
    /// An error of the operating system at `path`.
    pub fn io(path: &Path, source: std::io::Error) -> Self {
        Self::Io { path: path.to_owned(), source }
    }
}
