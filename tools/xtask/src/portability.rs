//! `xtask portability`: the table of what each committed shader would translate to, `docs/shader-portability.md`.

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::Error;
use crate::files;
use crate::manifest::{self, Module};
use crate::translate::{LANGUAGES, translate};

/// Writes the table; with `check` compares instead.
///
/// # Errors
/// An unreadable manifest or module; with `check`, a table that is not the one the modules give.
pub fn run(workspace: &Path, check: bool) -> Result<(), Error> {
    let path = workspace.join("docs/shader-portability.md");
    let spirv = workspace.join("shaders/spirv");
    let modules = manifest::read(&workspace.join("shaders/glsl/manifest.toml"))?;
    // A panic that is caught becomes a cell of the table; its message on the terminal would look like a failure.
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let rows = rows(&modules, |module| {
        let path = spirv.join(&module.output);
        Ok(translate(&std::fs::read(&path).map_err(|source| Error::io(&path, source))?))
    });
    std::panic::set_hook(hook);
    let text = table(&rows?);
    if check {
        let found = std::fs::read_to_string(&path).unwrap_or_default();
        return if found == text { Ok(()) } else { Err(Error::StaleTable(path)) };
    }
    files::write_whole(&path, text.as_bytes())?;
    println!("{}", path.display());
    Ok(())
}

/// Permutations of one entry point that behave alike.
struct Row {
    entry: String,
    permutations: Vec<String>,
    answers: [String; 3],
    all: bool,
}

/// One row for each entry point and distinct answer, in the order of the names.
fn rows(
    modules: &[Module],
    mut answer: impl FnMut(&Module) -> Result<[String; 3], Error>,
) -> Result<Vec<Row>, Error> {
    let mut entries: BTreeMap<String, BTreeMap<[String; 3], Vec<String>>> = BTreeMap::new();
    for module in modules {
        let name = module.output.with_extension("").display().to_string();
        let (entry, permutation) = name.split_once('.').unwrap_or((&name, ""));
        let alike = entries.entry(entry.to_owned()).or_default();
        alike.entry(answer(module)?).or_default().push(permutation.to_owned());
    }
    Ok(entries
        .into_iter()
        .flat_map(|(entry, alike)| {
            let all = alike.len() == 1;
            alike.into_iter().map(move |(answers, permutations)| Row {
                entry: entry.clone(),
                permutations,
                answers,
                all,
            })
        })
        .collect())
}

fn table(rows: &[Row]) -> String {
    let modules: usize = rows.iter().map(|row| row.permutations.len()).sum();
    let portable = |row: &&Row| row.answers.iter().all(|answer| answer.starts_with("yes"));
    let translated: usize = rows.iter().filter(portable).map(|row| row.permutations.len()).sum();
    let mut text = format!(
        "# What the shaders would translate to\n\n\
         Made by `cargo run -p xtask -- portability` from the committed SPIR-V with the naga of Cargo.lock; CI makes it\n\
         again and compares. It says that a translation is written, not that a compiler of that language has taken it.\n\
         Permutations that behave alike share a row. {translated} of {modules} modules translate to all three.\n\n\
         | entry point | permutations | {} |\n| --- | --- | --- | --- | --- |\n",
        LANGUAGES.join(" | ")
    );
    for row in rows {
        let permutations = match row.permutations.as_slice() {
            [one] if one.is_empty() => "–".to_owned(),
            several if row.all => format!("all {}", several.len()),
            several => several.join(", "),
        };
        let answers = row.answers.each_ref().map(|answer| cell(answer)).join(" | ");
        text += &format!("| {} | {permutations} | {answers} |\n", row.entry);
    }
    text
}

/// The first line of an answer, with nothing that would end a cell of the table.
fn cell(answer: &str) -> String {
    answer.lines().next().unwrap_or_default().replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    #[test]
    fn permutations_that_behave_alike_share_a_row() {
        let module = |output: &str| Module {
            file: PathBuf::from("fog/march.comp"),
            stage: glslang::ShaderStage::Compute,
            defines: Vec::new(),
            output: PathBuf::from(output),
        };
        let modules = ["fog/march.A.spv", "fog/march.B.spv", "fog/march.C.spv", "fog/blur.spv"].map(module);
        let rows = rows(&modules, |module| {
            let why = if module.output.ends_with("march.B.spv") { "no: a | b\nc" } else { "yes" };
            Ok([why.to_owned(), "yes".to_owned(), "yes".to_owned()])
        });
        let text = table(&rows.unwrap());
        let lines: Vec<&str> = text.lines().filter(|line| line.starts_with("| fog")).collect();
        let expected = [
            "| fog/blur | – | yes | yes | yes |",
            "| fog/march | B | no: a \\| b | yes | yes |",
            "| fog/march | A, C | yes | yes | yes |",
        ];
        assert_eq!(lines, expected);
        assert!(text.contains("3 of 4 modules translate to all three"), "{text}");
    }
}
