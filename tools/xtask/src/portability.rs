//! `xtask portability`: the table of what each committed shader would translate to, `docs/shader-portability.md`.

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::Error;
use crate::files;
use crate::manifest::{self, Module};
use crate::translate::{LANGUAGES, translate};

/// Where the table is.
const TABLE: &str = "docs/shader-portability.md";

/// Writes the table; with `check` compares instead.
///
/// # Errors
/// An unreadable manifest or module; with `check`, a table that is not the one the modules give.
pub fn run(workspace: &Path, check: bool) -> Result<(), Error> {
    let path = workspace.join(TABLE);
    let text = table(&translated(workspace, |_| true)?);
    if check {
        let found = std::fs::read_to_string(&path).unwrap_or_default();
        return if found == text { Ok(()) } else { Err(Error::StaleTable(path)) };
    }
    write(&path, &text)
}

/// Writes the table after the modules of one room alone have changed, come or gone.
///
/// # Errors
/// An unreadable table, manifest or module.
pub fn run_room(workspace: &Path, room: &str) -> Result<(), Error> {
    let path = workspace.join(TABLE);
    let found = std::fs::read_to_string(&path).map_err(|source| Error::io(&path, source))?;
    let rows = translated(workspace, |module| module.room() == room)?;
    write(&path, &with_room(&found, room, &rows))
}

fn write(path: &Path, text: &str) -> Result<(), Error> {
    files::write_whole(path, text.as_bytes())?;
    println!("{}", path.display());
    Ok(())
}

/// What naga makes of the modules that are asked for.
fn translated(workspace: &Path, asked: impl Fn(&Module) -> bool) -> Result<Vec<Row>, Error> {
    let spirv = workspace.join("shaders/spirv");
    let mut modules = manifest::read(&workspace.join("shaders/glsl"))?;
    modules.retain(asked);
    // A panic that is caught becomes a cell of the table; its message on the terminal would look like a failure.
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let rows = rows(&modules, |module| {
        let path = spirv.join(&module.output);
        Ok(translate(&std::fs::read(&path).map_err(|source| Error::io(&path, source))?))
    });
    std::panic::set_hook(hook);
    rows
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
    text(rows.iter().map(line))
}

/// The table with the rows of one room in the place of those it has.
fn with_room(found: &str, room: &str, rows: &[Row]) -> String {
    let is_row =
        |line: &&str| line.starts_with("| ") && line.contains('/') && !line.starts_with("| entry point");
    let others = found.lines().filter(is_row).filter(|line| !line.starts_with(&format!("| {room}/")));
    let mut lines: Vec<String> = others.map(str::to_owned).chain(rows.iter().map(line)).collect();
    let entry = |line: &String| line.split(' ').nth(1).unwrap_or_default().to_owned();
    lines.sort_by_key(entry); // stable: rows of one entry point keep their order
    text(lines.into_iter())
}

/// One row of the table, without its end.
fn line(row: &Row) -> String {
    let permutations = match row.permutations.as_slice() {
        [one] if one.is_empty() => "–".to_owned(),
        several if row.all => format!("all {}", several.len()),
        several => several.join(", "),
    };
    let answers = row.answers.each_ref().map(|answer| cell(answer)).join(" | ");
    format!("| {} | {permutations} | {answers} |", row.entry)
}

/// How many permutations a row speaks of, and whether they translate to every language.
fn count(line: &str) -> (usize, bool) {
    let mut cells = line.split(" | ");
    let permutations = cells.nth(1).unwrap_or_default();
    let all = permutations.strip_prefix("all ").and_then(|number| number.parse().ok());
    (all.unwrap_or(permutations.split(", ").count()), cells.all(|answer| answer.starts_with("yes")))
}

fn text(lines: impl Iterator<Item = String>) -> String {
    let lines: Vec<String> = lines.collect();
    let counts: Vec<(usize, bool)> = lines.iter().map(|line| count(line)).collect();
    let modules: usize = counts.iter().map(|(number, _)| number).sum();
    let translated: usize = counts.iter().filter(|(_, all)| *all).map(|(number, _)| number).sum();
    format!(
        "# What the shaders would translate to\n\n\
         Made by `cargo run -p xtask -- portability` from the committed SPIR-V with the naga of Cargo.lock; CI makes it\n\
         again and compares. It says that a translation is written, not that a compiler of that language has taken it.\n\
         Permutations that behave alike share a row. {translated} of {modules} modules translate to all three.\n\n\
         | entry point | permutations | {} |\n| --- | --- | --- | --- | --- |\n{}\n",
        LANGUAGES.join(" | "),
        lines.join("\n")
    )
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

    #[test]
    fn a_room_comes_and_goes_as_the_whole_table_is_made() {
        let row = |entry: &str, permutations: &[&str], all, answer: &str| Row {
            entry: entry.to_owned(),
            permutations: permutations.iter().map(|&name| name.to_owned()).collect(),
            answers: [answer, "yes", "yes"].map(str::to_owned),
            all,
        };
        let fog =
            || vec![row("fog/blur", &[""], true, "yes"), row("fog/march", &["A", "B"], true, "no: a | b")];
        let relight =
            [row("relight/x", &["N1"], false, "no: a"), row("relight/x", &["N2", "N3"], false, "yes")];
        let without = table(&relight);
        let whole = table(&fog().into_iter().chain(relight).collect::<Vec<_>>());
        assert_eq!(with_room(&without, "fog", &fog()), whole);
        assert_eq!(with_room(&whole, "fog", &fog()), whole);
        assert_eq!(with_room(&whole, "fog", &[]), without);
        assert!(whole.contains("3 of 6 modules"), "{whole}");
    }
}
