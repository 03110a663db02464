//! `xtask shaders`: makes, or checks, the committed SPIR-V.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::compile;
use crate::error::Error;
use crate::files;
use crate::manifest::{self, Module};

/// The SPIR-V files below one folder, by relative path.
type Files = BTreeMap<PathBuf, Vec<u8>>;

/// One difference between the committed files and a fresh compile.
#[derive(Debug, PartialEq, Eq)]
enum Difference {
    Missing(PathBuf),
    Changed(PathBuf),
    Stale(PathBuf),
}

/// Compiles the manifest, or one room of it, and writes what changed below `spirv`; files that no entry makes
/// are removed. With `check` nothing is written, and any difference is an error.
///
/// # Errors
/// An unreadable manifest or source, GLSL that does not compile, and with `check` a difference.
pub fn run(glsl: &Path, spirv: &Path, room: Option<&str>, check: bool) -> Result<(), Error> {
    let modules = modules(glsl, room)?;
    let made = make(glsl, &modules)?;
    let found = read(spirv, room)?;
    let differences = compare(&made, &found);
    for difference in &differences {
        let (word, path) = match difference {
            Difference::Missing(path) => ("new", path),
            Difference::Changed(path) => ("changed", path),
            Difference::Stale(path) => ("stale", path),
        };
        println!("{word:>8}  {}", path.display());
        if !check {
            write(spirv, path, made.get(path))?;
        }
    }
    let bytes: usize = made.values().map(Vec::len).sum();
    println!("{} modules, {bytes} bytes, {} differences", made.len(), differences.len());
    if check && !differences.is_empty() { Err(Error::Stale(differences.len())) } else { Ok(()) }
}

/// The manifests' modules, of one room when given.
///
/// # Errors
/// An unreadable manifest, and a room that no entry lies in.
pub fn modules(glsl: &Path, room: Option<&str>) -> Result<Vec<Module>, Error> {
    let mut modules = manifest::read(glsl)?;
    if let Some(room) = room {
        modules.retain(|module| module.room() == room);
        if modules.is_empty() {
            return Err(Error::NoSuchRoom(room.to_owned()));
        }
    }
    Ok(modules)
}

/// Compiles every module; all errors are reported together.
fn make(glsl: &Path, modules: &[Module]) -> Result<Files, Error> {
    let mut files = Files::new();
    let mut failures = Vec::new();
    for (module, compiled) in modules.iter().zip(compile_all(glsl, modules)) {
        match compiled {
            Ok(words) => {
                files.insert(
                    module.output.clone(),
                    words.iter().flat_map(|word| word.to_le_bytes()).collect(),
                );
            }
            Err(Error::Compile { module, log }) => failures.push((module, log)),
            Err(error) => return Err(error),
        }
    }
    let names: Vec<&str> = failures.iter().map(|(module, _)| module.as_str()).collect();
    let mut logs: Vec<&str> = failures.iter().map(|(_, log)| log.as_str()).collect();
    logs.dedup(); // the permutations of one file mostly fail alike
    if failures.is_empty() {
        Ok(files)
    } else {
        Err(Error::Compile { module: names.join(", "), log: logs.join("\n") })
    }
}

/// What each module compiles to, in their order, on as many threads as the machine runs at once.
fn compile_all(glsl: &Path, modules: &[Module]) -> Vec<Result<Vec<u32>, Error>> {
    let next = AtomicUsize::new(0);
    let compile_some = || {
        let taken = std::iter::from_fn(|| {
            let index = next.fetch_add(1, Ordering::Relaxed);
            Some((index, compile::module(glsl, modules.get(index)?)))
        });
        taken.collect::<Vec<_>>()
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut compiled: Vec<_> = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(compile_some)).collect();
        let mut all = compile_some();
        all.extend(
            others
                .into_iter()
                .flat_map(|other| other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))),
        );
        all
    });
    compiled.sort_by_key(|(index, _)| *index);
    compiled.into_iter().map(|(_, result)| result).collect()
}

/// Every `.spv` file below `root`, or below one room's folder.
fn read(root: &Path, room: Option<&str>) -> Result<Files, Error> {
    let mut files = Files::new();
    let mut folders = vec![room.map_or(root.to_owned(), |room| root.join(room))];
    while let Some(folder) = folders.pop() {
        if !folder.exists() {
            continue;
        }
        for entry in std::fs::read_dir(&folder).map_err(|source| Error::io(&folder, source))? {
            let path = entry.map_err(|source| Error::io(&folder, source))?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "spv") {
                let bytes = std::fs::read(&path).map_err(|source| Error::io(&path, source))?;
                files.insert(path.strip_prefix(root).unwrap_or(&path).to_owned(), bytes);
            }
        }
    }
    Ok(files)
}

/// What separates the files found from those just made.
fn compare(made: &Files, found: &Files) -> Vec<Difference> {
    let fresh = made.iter().filter_map(|(path, bytes)| match found.get(path) {
        None => Some(Difference::Missing(path.clone())),
        Some(old) if old != bytes => Some(Difference::Changed(path.clone())),
        Some(_) => None,
    });
    let stale = found.keys().filter(|path| !made.contains_key(*path)).cloned().map(Difference::Stale);
    fresh.chain(stale).collect()
}

/// Writes one file whole, or removes it when there is nothing to write.
fn write(root: &Path, relative: &Path, bytes: Option<&Vec<u8>>) -> Result<(), Error> {
    let path = root.join(relative);
    match bytes {
        None => std::fs::remove_file(&path).map_err(|source| Error::io(&path, source)),
        Some(bytes) => files::write_whole(&path, bytes),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_difference_is_found() {
        let files = |list: &[(&str, u8)]| -> Files {
            list.iter().map(|(name, byte)| (PathBuf::from(name), vec![*byte])).collect()
        };
        let made = files(&[("a/same.spv", 1), ("a/changed.spv", 2), ("a/new.spv", 3)]);
        let found = files(&[("a/same.spv", 1), ("a/changed.spv", 9), ("b/stale.spv", 4)]);
        assert_eq!(
            compare(&made, &found),
            [
                Difference::Changed("a/changed.spv".into()),
                Difference::Missing("a/new.spv".into()),
                Difference::Stale("b/stale.spv".into()),
            ]
        );
        assert!(compare(&made, &made).is_empty());
    }
}
