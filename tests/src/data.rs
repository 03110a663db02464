//! Large inputs that only benchmarks and slow comparisons use and that are not shipped.
//!
//! They are looked for in the folder `AIRGLOW_DATA`, or in `../shared/data` beside the checkout. No test of the
//! project depends on them: without them, what would have used them prints that it was not run.

use std::env;
use std::path::{Path, PathBuf};

/// The file `name` of the data folder, such as `mesh/armadillo.ply`; `None`, and a line that says so, if it is not here.
pub fn find(name: &str) -> Option<PathBuf> {
    let folder = folder();
    let path = folder.join(name);
    if path.is_file() {
        return Some(path);
    }
    println!("not run: {name} is not in {}; set AIRGLOW_DATA to a folder that has it", folder.display());
    None
}

/// The data folder, whether it is there or not.
#[must_use]
pub fn folder() -> PathBuf {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    env::var_os("AIRGLOW_DATA").map_or(beside, PathBuf::from)
}

#[cfg(test)]
mod tests {
    #[test]
    fn what_is_not_here_is_none() {
        assert_eq!(super::find("no/such/file"), None);
    }
}
