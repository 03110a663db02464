//! Shaders that change while the window is open.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::JoinHandle;
use std::time::{Duration, Instant, SystemTime};

use crate::host::shaders::Modules;

/// How often the folder is looked at.
const EVERY: Duration = Duration::from_millis(300);
/// The first word of a module.
const MAGIC: u32 = 0x0723_0203;

/// A folder of shaders like that of the sources: GLSL in `glsl`, modules in `spirv`.
pub struct Watch {
    folder: PathBuf,
    /// What makes modules of GLSL.
    compile: Option<String>,
    sources: Seen,
    modules: Seen,
    looked: Instant,
    running: Option<JoinHandle<Result<(), String>>>,
}

/// Files, and when they were written.
type Seen = BTreeMap<PathBuf, SystemTime>;

impl Watch {
    /// Watches a folder from now on; `compile` is run by a shell where GLSL has changed.
    pub fn new(folder: PathBuf, compile: Option<String>) -> Self {
        let (sources, modules) = (files(&folder.join("glsl")), files(&folder.join("spirv")));
        Self { folder, compile, sources, modules, looked: Instant::now(), running: None }
    }

    /// Modules that have changed, or why there are none; `None` where nothing has.
    pub fn look(&mut self) -> Option<Result<Modules, String>> {
        if self.looked.elapsed() < EVERY {
            return None;
        }
        self.looked = Instant::now();
        if let Some(running) = self.running.take_if(|running| running.is_finished()) {
            let ended = running.join().unwrap_or_else(|_| Err("the compiler broke off".to_owned()));
            if let Err(why) = ended {
                return Some(Err(why));
            }
        }
        let sources = files(&self.folder.join("glsl"));
        if self.running.is_none() && sources != self.sources {
            self.sources = sources;
            self.running = self.compile.clone().map(|line| std::thread::spawn(move || run(&line)));
        }
        if self.running.is_some() {
            return None;
        }
        let modules = files(&self.folder.join("spirv"));
        let changed = modules.iter().filter(|(path, time)| self.modules.get(*path) != Some(time));
        let changed: Vec<PathBuf> = changed.map(|(path, _)| path.clone()).collect();
        self.modules = modules;
        let read = |path: &PathBuf| Ok((name(&self.folder, path), words(path)?));
        (!changed.is_empty()).then(|| changed.iter().map(read).collect())
    }
}

/// Runs a command; what it said where it failed.
fn run(line: &str) -> Result<(), String> {
    let shell = if cfg!(windows) { ["cmd", "/C"] } else { ["sh", "-c"] };
    let output = Command::new(shell[0]).args([shell[1], line]).stdin(Stdio::null()).output();
    let output = output.map_err(|error| format!("{line}: {error}"))?;
    let said = [output.stdout, output.stderr].concat();
    match output.status.success() {
        true => Ok(()),
        false => Err(format!("{line}\n{}", String::from_utf8_lossy(&said).trim())),
    }
}

/// All files below a folder; none where it cannot be read.
fn files(folder: &Path) -> Seen {
    let mut seen = Seen::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            match entry.metadata() {
                Ok(about) if about.is_dir() => folders.push(entry.path()),
                Ok(about) => {
                    let written = about.modified().unwrap_or(SystemTime::UNIX_EPOCH);
                    seen.insert(entry.path(), written);
                }
                Err(_) => {}
            }
        }
    }
    seen
}

/// `room/entry` of a module's file.
fn name(folder: &Path, path: &Path) -> String {
    let inside = path.strip_prefix(folder.join("spirv")).unwrap_or(path).with_extension("");
    inside.to_string_lossy().replace('\\', "/")
}

fn words(path: &Path) -> Result<Vec<u32>, String> {
    let bytes = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let (words, rest) = bytes.as_chunks::<4>();
    let words: Vec<u32> = words.iter().map(|word| u32::from_le_bytes(*word)).collect();
    match rest.is_empty() && words.first() == Some(&MAGIC) {
        true => Ok(words),
        false => Err(format!("{}: no SPIR-V module; is it still being written?", path.display())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Looks until something is found.
    fn found(watch: &mut Watch) -> Result<Modules, String> {
        loop {
            watch.looked = Instant::now().checked_sub(EVERY).unwrap();
            if let Some(found) = watch.look() {
                return found;
            }
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    #[test]
    fn what_a_compiler_writes_is_read_and_what_it_says_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for below in ["glsl", "spirv/host"] {
            std::fs::create_dir_all(path(below)).unwrap();
        }
        let source = path("glsl/a.frag");
        std::fs::write(&source, "good").unwrap();
        let line = format!(
            "grep -q good {0} && printf '\\003\\002\\043\\007' > {1} || {{ echo a.frag:1 is bad >&2; exit 1; }}",
            source.display(),
            path("spirv/host/a.spv").display()
        );
        let mut watch = Watch::new(folder.path().to_owned(), Some(line));
        watch.sources.clear();
        let modules = found(&mut watch).unwrap();
        assert_eq!(modules, BTreeMap::from([("host/a".to_owned(), vec![MAGIC])]));
        std::fs::write(&source, "broken").unwrap();
        watch.sources.clear();
        let said = found(&mut watch).unwrap_err();
        assert!(said.ends_with("a.frag:1 is bad"), "{said}");
        std::fs::write(path("spirv/host/b.spv"), "no module").unwrap();
        assert!(found(&mut watch).unwrap_err().contains("b.spv"));
    }
}
