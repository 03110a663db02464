//! Whole files in, whole files out: sizes are checked before memory is taken, and nothing is left half written.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::Path;

use crate::error::{SceneError, at_most};

/// Reads a regular file of at most `limit` bytes.
pub(crate) fn read(file: &Path, limit: u64) -> Result<Vec<u8>, SceneError> {
    let refused = |source| SceneError::Read { file: file.to_path_buf(), source };
    // Opening a pipe would wait for its writer: ask what it is first.
    let found = fs::metadata(file).map_err(refused)?;
    if !found.is_file() {
        return Err(refused(io::Error::new(io::ErrorKind::InvalidInput, "not a regular file")));
    }
    const MEND: &str = "split the file or simplify what it holds";
    at_most(file, "file", found.len(), limit, "bytes", MEND)?;
    let mut bytes = Vec::new();
    let source = File::open(file).map_err(refused)?;
    source.take(limit + 1).read_to_end(&mut bytes).map_err(refused)?;
    at_most(file, "file", bytes.len() as u64, limit, "bytes", MEND)?;
    Ok(bytes)
}

/// Writes a file whole or not at all: into a temporary file beside it, which then takes its name.
///
/// # Errors
/// [`SceneError::Write`]; an older file of this name is then untouched.
pub fn write_atomically(file: &Path, bytes: &[u8]) -> Result<(), SceneError> {
    let write = || -> io::Result<()> {
        let folder = match file.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        // Temporary files are private by default; the result is an ordinary file, within the umask.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let mut temporary = builder.prefix(".airglow-").tempfile_in(folder)?;
        temporary.write_all(bytes)?;
        temporary.as_file().sync_all()?;
        temporary.persist(file)?;
        Ok(())
    };
    write().map_err(|source| SceneError::Write { file: file.to_path_buf(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_whole_and_nothing_stays_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.bin");
        write_atomically(&file, b"first").unwrap();
        write_atomically(&file, b"second").unwrap();
        assert_eq!(read(&file, 100).unwrap(), b"second");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn refusals_name_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.bin");
        assert!(matches!(read(&file, 1), Err(SceneError::Read { .. })));
        assert!(matches!(read(folder.path(), 1), Err(SceneError::Read { .. })));
        write_atomically(&file, b"ab").unwrap();
        let error = read(&file, 1).unwrap_err();
        assert!(matches!(error, SceneError::TooLarge { found: 2, limit: 1, .. }), "{error}");
        assert!(error.to_string().contains("a.bin"), "{error}");
        let nowhere = folder.path().join("missing/b.bin");
        assert!(matches!(write_atomically(&nowhere, b""), Err(SceneError::Write { .. })));
    }
}
