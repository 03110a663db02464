//! The few lines outside a room's folders that name it: in the workspace, the umbrella, other rooms' shader
//! manifests and the command-line tool.

use std::fs;
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::{files, manifest};

/// A file that names rooms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The workspace's Cargo.toml: a member and a dependency each.
    Workspace,
    /// passes/Cargo.toml: an optional dependency and a feature each.
    Umbrella,
    /// passes/src/lib.rs: a re-export each.
    UmbrellaLibrary,
    /// The shader manifest of each folder: entries of shaders that need several rooms.
    Shaders,
    /// tools/airglow/Cargo.toml: a feature for each room that the tool uses.
    Tool,
    /// passes/capi/Cargo.toml: an optional dependency and a feature for each room that hosts in C can use.
    Capi,
    /// passes/capi/src/lib.rs: the module of each such room.
    CapiLibrary,
    /// passes/capi/src/conformance.rs: the checks of each such room.
    CapiConformance,
}

const PLACES: [(Place, &str); 7] = [
    (Place::Workspace, "Cargo.toml"),
    (Place::Umbrella, "passes/Cargo.toml"),
    (Place::UmbrellaLibrary, "passes/src/lib.rs"),
    (Place::Tool, "tools/airglow/Cargo.toml"),
    (Place::Capi, "passes/capi/Cargo.toml"),
    (Place::CapiLibrary, "passes/capi/src/lib.rs"),
    (Place::CapiConformance, "passes/capi/src/conformance.rs"),
];

/// The texts of all places after `change`; nothing is written.
///
/// # Errors
/// A file that cannot be read, or in which `change` finds no place for a line.
pub fn edit(
    workspace: &Path,
    change: impl Fn(Place, &str) -> Option<String>,
) -> Result<Vec<(PathBuf, String)>, Error> {
    let edit = |(place, path): (Place, PathBuf)| {
        let text = fs::read_to_string(&path).map_err(|source| Error::io(&path, source))?;
        let message = "no line of another room to put this room's beside; add it by hand".to_owned();
        let changed = change(place, &text).ok_or_else(|| Error::Manifest { path: path.clone(), message })?;
        Ok((path, changed))
    };
    places(workspace)?.into_iter().map(edit).collect()
}

/// All places that there are, and their files.
fn places(workspace: &Path) -> Result<Vec<(Place, PathBuf)>, Error> {
    // The library for hosts in C is a room, too, and may be gone.
    let present =
        |(_, file): &(Place, &str)| !file.starts_with("passes/capi/") || workspace.join(file).is_file();
    let fixed = PLACES.into_iter().filter(present).map(|(place, file)| (place, workspace.join(file)));
    let manifests = manifest::files(&workspace.join("shaders/glsl"))?.into_iter();
    Ok(fixed.chain(manifests.map(|path| (Place::Shaders, path))).collect())
}

/// Writes what [`edit`] made.
///
/// # Errors
/// The operating system's answer, with the path.
pub fn write(edited: &[(PathBuf, String)]) -> Result<(), Error> {
    edited.iter().try_for_each(|(path, text)| files::write_whole(path, text.as_bytes()))
}

/// The text with the lines of room `name`; `None` where there is no place for them.
pub fn add(place: Place, text: &str, name: &str) -> Option<String> {
    match place {
        Place::Workspace => {
            let text = insert_below_last(text, "    \"passes", &format!("    \"passes/{name}\","))?;
            let line = format!("airglow-{name} = {{ path = \"passes/{name}\" }}");
            let last = text.lines().rfind(|line| line.contains("{ path = \"passes"))?.to_owned();
            insert_below_last(&text, &last, &line)
        }
        Place::Umbrella => {
            let line = format!("airglow-{name} = {{ workspace = true, optional = true }}");
            let text = insert_below_last(text, "airglow-", &line)?;
            let old = text.lines().find(|line| line.starts_with("default = ["))?.to_owned();
            let items = features(&old).chain([name]).collect::<Vec<_>>();
            let text = text.replacen(&old, &default_line(&items), 1);
            Some(format!("{text}# Exposure of colours.\n{name} = [\"dep:airglow-{name}\"]\n"))
        }
        Place::UmbrellaLibrary => {
            Some(format!("{text}#[cfg(feature = \"{name}\")]\npub use airglow_{name} as {name};\n"))
        }
        // Whoever uses the room there adds its lines.
        Place::Shaders | Place::Tool | Place::Capi | Place::CapiLibrary | Place::CapiConformance => {
            Some(text.to_owned())
        }
    }
}

/// The text without the lines of room `name`, and without the comments right above them.
pub fn remove(place: Place, text: &str, name: &str) -> String {
    match place {
        Place::Workspace => {
            // A room may have crates within it.
            let members = [format!("    \"passes/{name}\""), format!("    \"passes/{name}/")];
            let gone = |line: &str| members.iter().any(|member| line.starts_with(member));
            let dependency = format!("airglow-{name} ");
            drop_lines(text, |line| gone(line) || line.starts_with(&dependency))
        }
        Place::Umbrella | Place::Tool | Place::Capi => {
            let (dependency, feature) = (format!("airglow-{name} "), format!("{name} = ["));
            let text = drop_lines(text, |line| line.starts_with(&dependency) || line.starts_with(&feature));
            let default = |line: &str| {
                let items: Vec<_> = features(line).filter(|item| *item != name).collect();
                if line.starts_with("default = [") { default_line(&items) } else { line.to_owned() }
            };
            text.lines().map(|line| default(line) + "\n").collect()
        }
        Place::UmbrellaLibrary | Place::CapiLibrary => {
            let switch = format!("#[cfg(feature = \"{name}\")]");
            let (export, module) = (format!("pub use airglow_{name} "), format!("pub mod {name};"));
            drop_lines(text, |line| line == switch || line.starts_with(&export) || line == module)
        }
        Place::CapiConformance => {
            let (switch, module) = (format!("#[cfg(feature = \"{name}\")]"), format!("crate::{name}::"));
            drop_lines(text, |line| line.trim() == switch || line.contains(&module))
        }
        Place::Shaders => {
            // Entries are paragraphs.
            let is_shared = format!("AIRGLOW_{} = true", name.to_uppercase());
            let gone = |line: &str| line == is_shared;
            let kept = text.trim_end().split("\n\n").filter(|entry| !entry.lines().any(gone));
            kept.collect::<Vec<_>>().join("\n\n") + "\n"
        }
    }
}

/// Files of other rooms' shaders that need room `name` too: the file below `shaders/glsl` and how its modules are named.
pub fn shared_shaders(manifest: &str, name: &str) -> Vec<(String, String)> {
    let is_shared = format!("AIRGLOW_{} = true", name.to_uppercase());
    let shared = manifest.split("\n\n").filter(|entry| entry.lines().any(|line| line == is_shared));
    let value = |entry: &str, key: &str| {
        let line = entry.lines().find_map(|line| line.strip_prefix(&format!("{key} = \"")))?;
        Some(line.trim_end_matches('"').to_owned())
    };
    let named = |entry: &str| {
        let file = value(entry, "file")?;
        let stem = file.rsplit('/').next()?.split('.').next()?.to_owned();
        Some((file, value(entry, "name").unwrap_or(stem)))
    };
    shared.filter_map(named).collect()
}

/// Whether the command has code behind a feature of that name.
///
/// # Errors
/// The operating system's answer, with the path.
pub fn tool_speaks_of(workspace: &Path, name: &str) -> Result<bool, Error> {
    let path = workspace.join("tools/airglow/Cargo.toml");
    let text = fs::read_to_string(&path).map_err(|source| Error::io(&path, source))?;
    Ok(text.lines().any(|line| line.starts_with(&format!("{name} = ["))))
}

/// The workspace's text in which a feature's name is known although no crate has it: the command's code of a room that is
/// gone stays behind its feature, and is not compiled. `None` where there are no lints.
pub fn excuse(text: &str, name: &str) -> Option<String> {
    let beginning = "unexpected_cfgs = { level = \"warn\", check-cfg = ['cfg(feature, values(";
    let listed = |line: &str| line.starts_with(beginning) && line.contains(&format!("\"{name}\""));
    if text.lines().any(listed) {
        return Some(text.to_owned());
    }
    if text.contains(beginning) {
        return Some(text.replacen(beginning, &format!("{beginning}\"{name}\", "), 1));
    }
    let reason = "code of rooms that are gone stays behind their features";
    let line = format!("{beginning}\"{name}\"))'] }} # {reason}");
    insert_below_last(text, "[workspace.lints.rust]", &line)
}

/// The text with `line` below the last line that starts with `beginning`.
fn insert_below_last(text: &str, beginning: &str, line: &str) -> Option<String> {
    let mut lines: Vec<&str> = text.lines().collect();
    let at = lines.iter().rposition(|found| found.starts_with(beginning))?;
    lines.insert(at + 1, line);
    Some(lines.join("\n") + "\n")
}

/// The text without the lines chosen, and without the comment lines right above each.
fn drop_lines(text: &str, chosen: impl Fn(&str) -> bool) -> String {
    let mut kept: Vec<&str> = Vec::new();
    for line in text.lines() {
        if !chosen(line) {
            kept.push(line);
            continue;
        }
        while kept.last().is_some_and(|above| above.starts_with("# ") || above.starts_with("/// ")) {
            kept.pop();
        }
    }
    kept.join("\n") + "\n"
}

/// The names quoted in a line.
fn features(line: &str) -> impl Iterator<Item = &str> {
    line.split('"').skip(1).step_by(2)
}

fn default_line(names: &[&str]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    format!("default = [{}]", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn removing_what_was_added_gives_each_file_back() {
        for (place, file) in places(&crate::workspace()).unwrap() {
            let text = fs::read_to_string(&file).unwrap();
            let added = add(place, &text, "anotherroom").unwrap();
            let by_template = [Place::Workspace, Place::Umbrella, Place::UmbrellaLibrary].contains(&place);
            assert_eq!(added != text, by_template, "{}", file.display());
            assert_eq!(remove(place, &added, "anotherroom"), text, "{}", file.display());
        }
    }

    #[test]
    fn features_of_rooms_that_are_gone_stay_known() {
        let text = "[workspace.lints.rust]\nmissing_docs = \"warn\"\n";
        let once = excuse(text, "fog").unwrap();
        assert!(once.contains("check-cfg = ['cfg(feature, values(\"fog\"))'] } # "), "{once}");
        assert!(excuse(&once, "rain").unwrap().contains("values(\"rain\", \"fog\"))'] } # "), "{once}");
        assert_eq!(excuse(&once, "fog").unwrap(), once);
        assert_eq!(excuse("[workspace]\n", "fog"), None);
        let workspace = crate::workspace();
        assert!(tool_speaks_of(&workspace, "relight").unwrap());
        assert!(!tool_speaks_of(&workspace, "anotherroom").unwrap());
    }

    #[test]
    fn a_removed_room_takes_its_comments_along_and_nothing_else() {
        let text = "[features]\ndefault = [\"fog\", \"rain\"]\n# Fog.\nfog = [\"dep:airglow-fog\"]\n# Rain.\nrain = []\n";
        let expected = "[features]\ndefault = [\"rain\"]\n# Rain.\nrain = []\n";
        assert_eq!(remove(Place::Umbrella, text, "fog"), expected);
        let text =
            "[[entry]]\nfile = \"rain/wet.frag\"\nname = \"drops\"\n[entry.define]\nAIRGLOW_FOG = true\n";
        assert_eq!(remove(Place::Shaders, text, "fog"), "\n");
        let rest = "# All.\n\n[[entry]]\nfile = \"rain/dry.frag\"\n";
        assert_eq!(remove(Place::Shaders, &format!("{rest}\n# Both.\n{text}"), "fog"), rest);
        assert_eq!(shared_shaders(text, "fog"), [("rain/wet.frag".to_owned(), "drops".to_owned())]);
        assert!(shared_shaders(text, "rain").is_empty());
        let text = "airglow-fog = 1\nairglow-foggy = 2\n    \"passes/fog\",\n    \"passes/fog/c\",\n    \"passes/foggy\",\n";
        assert_eq!(remove(Place::Workspace, text, "fog"), "airglow-foggy = 2\n    \"passes/foggy\",\n");
    }
}
