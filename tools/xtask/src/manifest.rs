//! The shader manifests, one in each folder: entry points and the permutations of their defines.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glslang::ShaderStage;
use serde::Deserialize;

use crate::error::Error;

/// One module to make: a source file, its stage and one choice for every define.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Module {
    /// Source, relative to the GLSL root, such as `relight/dot.comp`.
    pub file: PathBuf,
    /// Pipeline stage, from the file's extension.
    pub stage: ShaderStage,
    /// Preprocessor definitions, name and value.
    pub defines: Vec<(String, String)>,
    /// Result, relative to the SPIR-V root, such as `relight/dot.ORDER4.f16.spv`.
    pub output: PathBuf,
}

impl Module {
    /// The first folder of the source: the room this module belongs to.
    pub fn room(&self) -> &str {
        self.file.iter().next().and_then(|part| part.to_str()).unwrap_or_default()
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(default)]
    entry: Vec<Entry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    file: String,
    name: Option<String>,
    #[serde(default)]
    define: BTreeMap<String, Choice>,
}

/// The right-hand side of a define: one value for all modules, or a list that multiplies them.
#[derive(Deserialize)]
#[serde(untagged)]
enum Choice {
    Fixed(Value),
    Each(Vec<Value>),
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Value {
    Switch(bool),
    Number(i64),
    Word(String),
}

impl Value {
    /// The definition this value stands for, and its part of the module's name.
    fn define(&self, name: &str) -> ((String, String), Option<String>) {
        match self {
            Value::Switch(on) => ((name.to_owned(), i32::from(*on).to_string()), on.then(|| name.to_owned())),
            Value::Number(number) => ((name.to_owned(), number.to_string()), Some(format!("{name}{number}"))),
            Value::Word(word) => {
                ((format!("{name}_{}", word.to_uppercase()), "1".to_owned()), Some(word.clone()))
            }
        }
    }
}

/// The manifests of the folders right below the GLSL root, in the order of their names.
///
/// # Errors
/// The operating system's answer, with the path.
pub fn files(glsl: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(glsl).map_err(|source| Error::io(glsl, source))? {
        let file = entry.map_err(|source| Error::io(glsl, source))?.path().join("manifest.toml");
        if file.is_file() {
            files.push(file);
        }
    }
    files.sort();
    Ok(files)
}

/// Reads all manifests below the GLSL root and lists their modules: in the order of the folders' names and of each file,
/// defines in alphabetical order.
///
/// # Errors
/// Malformed TOML, an unknown extension, a source outside the manifest's folder, and two modules with one name are refused.
pub fn read(glsl: &Path) -> Result<Vec<Module>, Error> {
    let folders: Result<Vec<_>, _> = files(glsl)?.iter().map(|path| read_file(path)).collect();
    Ok(folders?.concat())
}

fn read_file(path: &Path) -> Result<Vec<Module>, Error> {
    let text = std::fs::read_to_string(path).map_err(|source| Error::io(path, source))?;
    let refuse = |message: String| Error::Manifest { path: path.to_owned(), message };
    let document: Document = toml::from_str(&text).map_err(|error| refuse(error.to_string()))?;
    let mut modules: Vec<Module> = Vec::new();
    for entry in &document.entry {
        for module in expand(entry).map_err(refuse)? {
            if path.parent().and_then(Path::file_name).is_none_or(|folder| folder != module.room()) {
                return Err(refuse(format!(
                    "{} lies in another folder, whose manifest names it",
                    entry.file
                )));
            }
            if modules.iter().any(|other| other.output == module.output) {
                return Err(refuse(format!(
                    "two modules would be named {}; give one of the entries another `name`",
                    module.output.display()
                )));
            }
            modules.push(module);
        }
    }
    Ok(modules)
}

/// All modules of one entry: the product of its defines' lists.
fn expand(entry: &Entry) -> Result<Vec<Module>, String> {
    let file = PathBuf::from(&entry.file);
    let stage = match file.extension().and_then(|extension| extension.to_str()) {
        Some("comp") => ShaderStage::Compute,
        Some("vert") => ShaderStage::Vertex,
        Some("frag") => ShaderStage::Fragment,
        _ => return Err(format!("{}: the file must end in .comp, .vert or .frag", entry.file)),
    };
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    let stem = file.file_stem().and_then(|stem| stem.to_str());
    let (Some(folder), Some(stem)) = (folder, stem) else {
        return Err(format!("{}: the file must lie in its room's folder", entry.file));
    };
    let name = entry.name.as_deref().unwrap_or(stem);

    let mut choices: Vec<(Vec<(String, String)>, String)> = vec![(Vec::new(), name.to_owned())];
    for (define, choice) in &entry.define {
        choices = match choice {
            Choice::Fixed(value) => choices
                .into_iter()
                .map(|(mut defines, label)| {
                    defines.push(value.define(define).0);
                    (defines, label)
                })
                .collect(),
            Choice::Each(values) => choices
                .iter()
                .flat_map(|(defines, label)| {
                    values.iter().map(move |value| {
                        let (definition, part) = value.define(define);
                        let label = part.map_or(label.clone(), |part| format!("{label}.{part}"));
                        ([defines.as_slice(), &[definition]].concat(), label)
                    })
                })
                .collect(),
        };
    }
    Ok(choices
        .into_iter()
        .map(|(defines, label)| Module {
            file: file.clone(),
            stage,
            defines,
            output: folder.join(format!("{label}.spv")),
        })
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn modules(text: &str) -> Result<Vec<Module>, String> {
        let document: Document = toml::from_str(text).map_err(|error| error.to_string())?;
        let expanded: Result<Vec<_>, _> = document.entry.iter().map(expand).collect();
        Ok(expanded?.concat())
    }

    #[test]
    fn lists_multiply_and_name_the_modules() {
        let text = r#"
            [[entry]]
            file = "relight/dot.comp"
            [entry.define]
            ORDER = [1, 2]
            TRANSFER = ["f32", "f16"]
            CHECKED = [false, true]
            GROUP = 64
        "#;
        let modules = modules(text).unwrap();
        let names: Vec<_> = modules.iter().map(|module| module.output.display().to_string()).collect();
        assert_eq!(
            names,
            [
                "relight/dot.ORDER1.f32.spv",
                "relight/dot.ORDER1.f16.spv",
                "relight/dot.ORDER2.f32.spv",
                "relight/dot.ORDER2.f16.spv",
                "relight/dot.CHECKED.ORDER1.f32.spv",
                "relight/dot.CHECKED.ORDER1.f16.spv",
                "relight/dot.CHECKED.ORDER2.f32.spv",
                "relight/dot.CHECKED.ORDER2.f16.spv",
            ]
        );
        let expected = [("CHECKED", "1"), ("GROUP", "64"), ("ORDER", "2"), ("TRANSFER_F16", "1")];
        let defines: Vec<_> = modules[7].defines.iter().map(|(n, v)| (n.as_str(), v.as_str())).collect();
        assert_eq!(defines, expected);
        assert_eq!(modules[7].room(), "relight");
    }

    #[test]
    fn what_cannot_be_compiled_is_refused() {
        assert!(modules("[[entry]]\nfile = \"relight/dot.glsl\"").unwrap_err().contains(".comp"));
        assert!(modules("[[entry]]\nfile = \"dot.comp\"").unwrap_err().contains("room"));
        assert!(modules("[[entry]]\nfile = \"relight/dot.comp\"\nstage = 1").is_err());
    }
}
