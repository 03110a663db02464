//! `xtask room`: makes a pass's room from the template, or removes one.
//!
//! A room is a crate below `passes/`, a folder of the same name below `shaders/glsl` and what it compiles to, and a few
//! lines that name it: [`crate::room_lines`].

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::error::Error;
use crate::room_lines::Place;
use crate::{files, header, manifest, portability, room_lines, shaders};

/// Where each file of a room lies, and its text. `__room__` stands for the room's name, `__Room__` for that of its type.
const TEMPLATE: [(&str, &str); 14] = [
    ("passes/__room__/Cargo.toml", include_str!("../template/Cargo.toml.template")),
    ("passes/__room__/README.md", include_str!("../template/README.md")),
    ("passes/__room__/src/lib.rs", include_str!("../template/src/lib.rs")),
    ("passes/__room__/src/settings.rs", include_str!("../template/src/settings.rs")),
    ("passes/__room__/src/error.rs", include_str!("../template/src/error.rs")),
    ("passes/__room__/src/declare.rs", include_str!("../template/src/declare.rs")),
    ("passes/__room__/src/record.rs", include_str!("../template/src/record.rs")),
    ("passes/__room__/src/reference.rs", include_str!("../template/src/reference.rs")),
    ("passes/__room__/src/curve.rs", include_str!("../template/src/curve.rs")),
    ("passes/__room__/tests/plan.rs", include_str!("../template/tests/plan.rs")),
    ("passes/__room__/tests/plans/expose.txt", include_str!("../template/tests/plans/expose.txt")),
    ("passes/__room__/tests/gpu.rs", include_str!("../template/tests/gpu.rs")),
    ("shaders/glsl/__room__/expose.comp", include_str!("../template/expose.comp")),
    ("shaders/glsl/__room__/manifest.toml", include_str!("../template/manifest.toml")),
];

/// Words that cannot name a module, and packages of this workspace that lie elsewhere.
const TAKEN: [&str; 30] = [
    "as", "async", "await", "break", "const", "crate", "dyn", "else", "enum", "extern", "fn", "for", "if",
    "impl", "in", "let", "loop", "match", "mod", "move", "mut", "pub", "ref", "return", "static", "struct",
    "super", "trait", "type", "cli",
];

/// Makes the room `name`: crate, shaders, and the lines that name it; then compiles its shaders and formats its code.
///
/// # Errors
/// A name that is no lower-case word or is taken; files that cannot be written; a command that fails.
pub fn make(workspace: &Path, name: &str) -> Result<(), Error> {
    check_new(workspace, name)?;
    let edited = room_lines::edit(workspace, |file, text| room_lines::add(file, text, name))?;
    for (path, text) in TEMPLATE {
        let path = workspace.join(fill(path, name));
        files::write_whole(&path, fill(text, name).as_bytes())?;
    }
    room_lines::write(&edited)?;
    // The length and the place in the alphabet of a name decide where lines break and how imports are sorted.
    run(workspace, "cargo", &["update", "--quiet", "--workspace", "--offline"])?;
    run(workspace, "cargo", &["fmt", "-p", &format!("airglow-{name}"), "-p", "airglow"])?;
    shaders::run(&workspace.join("shaders/glsl"), &workspace.join("shaders/spirv"), Some(name), false)?;
    portability::run_room(workspace, name)?;
    println!("passes/{name} and shaders/glsl/{name} are made; next: cargo test -p airglow-{name}");
    Ok(())
}

/// Removes the room `name`: its folders and the lines that name it.
///
/// # Errors
/// No such room; files that cannot be written.
pub fn remove(workspace: &Path, name: &str) -> Result<(), Error> {
    let refuse = |problem| Error::Room { name: name.to_owned(), problem };
    if !is_word(name) || !workspace.join("passes").join(name).join("Cargo.toml").is_file() {
        return Err(refuse("there is no such crate below passes/"));
    }
    let spoken_of = room_lines::tool_speaks_of(workspace, name)?;
    let remove = |place, text: &str| {
        let text = room_lines::remove(place, text, name);
        if place == Place::Workspace && spoken_of { room_lines::excuse(&text, name) } else { Some(text) }
    };
    remove_shared(workspace, name)?;
    let mut edited = room_lines::edit(workspace, remove)?;
    let of_capi = ["passes/capi/src", "passes/capi/tests", "passes/capi/examples"];
    for folder in ["passes", "shaders/glsl", "shaders/spirv"].into_iter().chain(of_capi) {
        let folder = workspace.join(folder).join(name);
        if folder.exists() {
            fs::remove_dir_all(&folder).map_err(|source| Error::io(&folder, source))?;
        }
    }
    // A place may have gone with the room.
    edited.retain(|(path, _)| path.is_file());
    room_lines::write(&edited)?;
    run(workspace, "cargo", &["update", "--quiet", "--workspace", "--offline"])?;
    header::run(workspace, false)?;
    portability::run_room(workspace, name)
}

/// Removes what other rooms' shaders have of this room: the sources that need both, and their modules.
fn remove_shared(workspace: &Path, name: &str) -> Result<(), Error> {
    let shaders = workspace.join("shaders");
    let mut shared = Vec::new();
    for manifest in manifest::files(&shaders.join("glsl"))? {
        let text = fs::read_to_string(&manifest).map_err(|source| Error::io(&manifest, source))?;
        shared.extend(room_lines::shared_shaders(&text, name));
    }
    for (file, entry) in shared {
        let source = shaders.join("glsl").join(&file);
        let folder = shaders.join("spirv").join(file.split('/').next().unwrap_or_default());
        let modules = fs::read_dir(&folder).map_err(|source| Error::io(&folder, source))?;
        let of_entry = |path: &std::path::PathBuf| {
            let found = path.file_name().and_then(|found| found.to_str()).unwrap_or_default();
            found.strip_prefix(&entry).is_some_and(|rest| rest.starts_with('.'))
        };
        let modules = modules.filter_map(|module| Some(module.ok()?.path())).filter(of_entry);
        for gone in modules.chain([source]).filter(|path| path.exists()) {
            fs::remove_file(&gone).map_err(|source| Error::io(&gone, source))?;
        }
    }
    Ok(())
}

/// Refuses a name that cannot be, or already is, a room's.
fn check_new(workspace: &Path, name: &str) -> Result<(), Error> {
    let refuse = |problem| Err(Error::Room { name: name.to_owned(), problem });
    if !is_word(name) {
        return refuse("a room is named by one word of lower-case letters and digits, such as `fog`");
    }
    let places = ["passes", "engine", "tools", "shaders/glsl", "shaders/spirv"];
    let exists = places.iter().any(|place| workspace.join(place).join(name).exists());
    if exists || TAKEN.contains(&name) {
        return refuse("the name is taken; choose another");
    }
    Ok(())
}

fn is_word(name: &str) -> bool {
    name.starts_with(|first: char| first.is_ascii_lowercase())
        && name.chars().all(|letter| letter.is_ascii_lowercase() || letter.is_ascii_digit())
}

/// The template's text for one room.
fn fill(text: &str, name: &str) -> String {
    let (first, rest) = name.split_at(1);
    text.replace("__room__", name).replace("__Room__", &format!("{}{rest}", first.to_uppercase()))
}

fn run(workspace: &Path, program: &str, arguments: &[&str]) -> Result<(), Error> {
    let command = || format!("{program} {}", arguments.join(" "));
    let status = Command::new(program).args(arguments).current_dir(workspace).status();
    match status {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(Error::Command { command: command(), problem: status.to_string() }),
        Err(error) => Err(Error::Command { command: command(), problem: error.to_string() }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_of_the_template_is_listed() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("template");
        let mut folders = vec![root];
        let mut count = 0;
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                    continue;
                }
                let text = fs::read_to_string(&path).unwrap();
                assert!(
                    TEMPLATE.iter().any(|(_, listed)| *listed == text),
                    "{} is not listed",
                    path.display()
                );
                count += 1;
            }
        }
        assert_eq!(count, TEMPLATE.len());
    }

    #[test]
    fn names_become_modules_and_types() {
        assert_eq!(fill("airglow___room__::__Room__Error", "fog2"), "airglow_fog2::Fog2Error");
        let workspace = crate::workspace();
        assert!(check_new(&workspace, "anotherroom").is_ok());
        for name in [
            "", "Fog", "my_fog", "my-fog", "2fog", "../fog", "graph", "host", "src", "loop", "airglow", "cli",
        ] {
            let error = check_new(&workspace, name).unwrap_err().to_string();
            assert!(error.contains(name) && (error.contains("taken") || error.contains("word")), "{error}");
        }
        assert!(remove(&workspace, "..").unwrap_err().to_string().contains("no such crate"));
    }
}
