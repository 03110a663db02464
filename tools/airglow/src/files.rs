//! Files of the command: written whole or not at all, into folders that are made when needed.

use std::fs;
use std::path::Path;

use airglow_scene::write_atomically;

use crate::failure::{Failure, Outcome};

/// Writes `bytes` to `path`, making its folder if needed; an old file stays whole until the next one is.
pub fn write(path: &Path, bytes: &[u8]) -> Outcome {
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        fs::create_dir_all(folder).map_err(|error| Failure::file(folder, "making the folder", error))?;
    }
    write_atomically(path, bytes).map_err(Failure::work)
}

/// Reads a whole text file.
pub fn read_text(path: &Path) -> Outcome<String> {
    fs::read_to_string(path).map_err(|error| Failure::input(format!("{}: {error}", path.display())))
}

/// The name with everything but letters and digits replaced, and not too long.
pub fn file_name(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).take(48).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_written_into_folders_that_are_not_there_yet() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/er/result.txt");
        write(&path, b"first").unwrap();
        write(&path, b"second").unwrap();
        assert_eq!(read_text(&path).unwrap(), "second");
    }
}
