//! The command as its users see it.

#![cfg(feature = "relight")]
#![expect(clippy::unwrap_used, reason = "helpers of tests stop at the first surprise")]

mod composition;
mod counts;
mod debug;
mod explain;
mod fog;
mod instruments;
mod leaving_out;
mod maps;
mod moving;
mod roads;

use std::path::{Path, PathBuf};

/// Of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}
