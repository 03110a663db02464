//! Files that are either whole or absent: written beside their place, then renamed.

use std::fs;
use std::io::Write;
use std::path::Path;

use tempfile::NamedTempFile;

use crate::failure::{Failure, Outcome};

/// Writes `bytes` to `path`, making its folder if needed; an old file stays whole until the new one is.
pub fn write(path: &Path, bytes: &[u8]) -> Outcome {
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    fs::create_dir_all(folder).map_err(|error| Failure::file(folder, "making the folder", error))?;
    let mut file = NamedTempFile::new_in(folder)
        .map_err(|error| Failure::file(folder, "making a temporary file", error))?;
    file.write_all(bytes).map_err(|error| Failure::file(path, "writing", error))?;
    readable_by_all(&file).map_err(|error| Failure::file(path, "setting permissions", error))?;
    file.persist(path).map_err(|error| Failure::file(path, "renaming", error.error))?;
    Ok(())
}

/// Temporary files are private to their maker; results are meant to be shared.
#[cfg(unix)]
fn readable_by_all(file: &NamedTempFile) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.as_file().set_permissions(fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn readable_by_all(_file: &NamedTempFile) -> std::io::Result<()> {
    Ok(())
}

/// Reads a whole text file.
pub fn read_text(path: &Path) -> Outcome<String> {
    fs::read_to_string(path).map_err(|error| Failure::input(format!("{}: {error}", path.display())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_written_file_replaces_the_old_one_and_leaves_no_temporary() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/er/result.txt");
        write(&path, b"first").unwrap();
        write(&path, b"second").unwrap();
        assert_eq!(read_text(&path).unwrap(), "second");
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }
}
