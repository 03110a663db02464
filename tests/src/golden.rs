//! Golden files: text that must not change by accident, such as plans.
//!
//! `AIRGLOW_BLESS=1` writes what is there now as the new truth; a difference otherwise fails and leaves the actual text
//! beside the golden one, with `.actual` added to its name.

use std::env;
use std::fs;
use std::path::Path;

/// Asserts that `actual` is what the file `golden` holds.
///
/// # Panics
/// Naming the first line that differs with both versions, if not, or if the file cannot be read or written.
#[track_caller]
pub fn assert_text(golden: &Path, actual: &str) {
    let mut beside = golden.as_os_str().to_owned();
    beside.push(".actual");
    if env::var_os("AIRGLOW_BLESS").is_some() {
        write(golden, actual);
        return;
    }
    let expected = fs::read_to_string(golden).unwrap_or_default();
    if expected == actual {
        let _ = fs::remove_file(beside);
        return;
    }
    write(Path::new(&beside), actual);
    let (line, expected, actual) = first_difference(&expected, actual);
    let file = golden.display();
    panic!(
        "{file}, line {line}:\n  golden: {expected}\n  actual: {actual}\nAIRGLOW_BLESS=1 accepts the actual text"
    );
}

#[track_caller]
fn write(path: &Path, text: &str) {
    let folder = path.parent().unwrap_or(Path::new("."));
    let written = fs::create_dir_all(folder).and_then(|()| fs::write(path, text));
    written.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}

/// The first line that differs, counted from 1, in both versions.
fn first_difference<'a>(expected: &'a str, actual: &'a str) -> (usize, &'a str, &'a str) {
    let (mut expected, mut actual) = (expected.lines(), actual.lines());
    let mut line = 1;
    loop {
        match (expected.next(), actual.next()) {
            (Some(a), Some(b)) if a == b => line += 1,
            (a, b) => return (line, a.unwrap_or("(end)"), b.unwrap_or("(end)")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::first_difference;

    #[test]
    fn the_first_difference_is_found() {
        assert_eq!(first_difference("a\nb\nc", "a\nx\nc"), (2, "b", "x"));
        assert_eq!(first_difference("a\n", "a\nb\n"), (2, "(end)", "b"));
    }
}
