//! Files that are written whole or not at all.

use std::path::Path;

use crate::error::Error;

/// Writes a file and the folders above it; a reader sees the old contents or the new ones, never a part.
///
/// # Errors
/// The operating system's answer, with the path.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let partial = path.with_extension("partial");
    let put = || {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        std::fs::write(&partial, bytes)?;
        std::fs::rename(&partial, path)
    };
    put().map_err(|source| Error::io(path, source))
}
