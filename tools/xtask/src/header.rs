//! `xtask header`: the C header of `passes/capi`, made from its Rust source.

use std::fs;
use std::path::{Path, PathBuf};

use cbindgen::{Builder, Config, DocumentationStyle, EnumConfig, Language, RenameRule};

use crate::error::Error;
use crate::files;

const ROOM: &str = "passes/capi";

/// Writes the header; with `check` compares instead. Without the room there is nothing to do.
///
/// # Errors
/// Source that cannot be read; with `check`, a header that is not the one the source gives.
pub fn run(workspace: &Path, check: bool) -> Result<(), Error> {
    if !workspace.join(ROOM).is_dir() {
        return Ok(());
    }
    let path = workspace.join(ROOM).join("include/airglow.h");
    let text = text(&workspace.join(ROOM).join("src"))?;
    if check {
        let found = fs::read_to_string(&path).unwrap_or_default();
        return if found == text { Ok(()) } else { Err(Error::StaleHeader(path)) };
    }
    files::write_whole(&path, text.as_bytes())?;
    println!("{}", path.display());
    Ok(())
}

fn text(source: &Path) -> Result<String, Error> {
    let mut config = Config {
        language: Language::C,
        cpp_compat: true,
        include_guard: Some("AIRGLOW_H".to_owned()),
        no_includes: true,
        sys_includes: vec!["stddef.h".to_owned(), "stdint.h".to_owned()],
        usize_is_size_t: true,
        documentation_style: DocumentationStyle::Doxy,
        line_length: 120,
        header: Some(HEADER.to_owned()),
        enumeration: EnumConfig {
            rename_variants: RenameRule::QualifiedScreamingSnakeCase,
            ..EnumConfig::default()
        },
        ..Config::default()
    };
    // Only a library with the kit has it.
    config.defines.insert("feature = conformance".to_owned(), "AIRGLOW_CONFORMANCE".to_owned());
    // Fields that hold them are integers, so that no value of a host is undefined; nothing else refers to them.
    config.export.include = enumerations(source)?;
    let problem =
        |error: cbindgen::Error| Error::Header { path: source.to_owned(), problem: error.to_string() };
    let library = source.join("lib.rs");
    let bindings = Builder::new().with_src(library).with_config(config).generate().map_err(problem)?;
    let mut bytes = Vec::new();
    bindings.write(&mut bytes);
    let text = String::from_utf8_lossy(&bytes);
    Ok(text.replace(" * # Safety\n", " * The caller promises:\n"))
}

const HEADER: &str = "\
/* airglow: real-time lighting passes for Vulkan. MIT OR Apache-2.0.
 *
 * Made from passes/capi by `cargo run -p xtask -- header`; edit the source there. It needs no other header: handles of
 * Vulkan are integers, 0 for null, and flags, formats, layouts and results are Vulkan's own numbers.
 *
 * Structures that begin with `struct_size` are versioned. Clear them and set it to their sizeof; zero is every other
 * field's default unless it says otherwise. A smaller structure, of an older header, is accepted; a larger one, of a
 * newer header, while the part unknown to this version is zero.
 *
 * Functions return a status. Their last argument, which may be null, takes the message. No panic leaves the library.
 */";

/// Names of the enumerations in all files below `folder`, sorted.
fn enumerations(folder: &Path) -> Result<Vec<String>, Error> {
    let mut names = Vec::new();
    let mut folders: Vec<PathBuf> = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        let failed = |source| Error::io(&folder, source);
        for entry in fs::read_dir(&folder).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let text = fs::read_to_string(&path).map_err(|source| Error::io(&path, source))?;
            let name = |line: &str| Some(line.strip_prefix("pub enum ")?.strip_suffix(" {")?.to_owned());
            names.extend(text.lines().filter_map(name));
        }
    }
    names.sort();
    Ok(names)
}
