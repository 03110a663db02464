//! Paths that a file names: its imports, and those written where they are used.

use super::tokens::{Token, after_group};

/// A path as it is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Named {
    /// Its names; the first may be `crate`, `self` or `super`.
    pub names: Vec<String>,
    /// The name that an import brings in; `*` for all.
    pub alias: Option<String>,
    pub line: usize,
}

/// What a file says of other modules.
#[derive(Clone, Debug, Default)]
pub struct Contents {
    pub paths: Vec<Named>,
    /// Modules declared, whose text is in a file of their own.
    pub children: Vec<String>,
    /// Items declared.
    pub items: Vec<String>,
}

impl Contents {
    pub fn of(tokens: &[Token<'_>]) -> Self {
        let mut contents = Self::default();
        // Ends of the modules that the file holds itself, around the present place.
        let mut within: Vec<usize> = Vec::new();
        let mut at = 0;
        while let Some(token) = tokens.get(at) {
            within.retain(|&end| at < end);
            let text = |ahead: usize| tokens.get(at + ahead).map_or("", |token| token.text);
            let first = contents.paths.len();
            let mut next = at + 1;
            match token.text {
                "mod" if text(2) == ";" => contents.children.push(text(1).to_owned()),
                "mod" if text(2) == "{" => within.push(after_group(tokens, at + 2)),
                "struct" | "enum" | "fn" | "trait" | "type" | "const" | "static" | "union" => {
                    contents.items.push(text(1).to_owned());
                }
                // `use<…>` is what a type captures.
                "use" if text(1) != "<" => next = imports(tokens, at + 1, &[], &mut contents.paths),
                _ if is_name(token.text) && text(1) == "::" && !follows_path(tokens, at) => {
                    next = written(tokens, at, &mut contents.paths);
                }
                _ => {}
            }
            contents.paths[first..].iter_mut().for_each(|path| leave(path, within.len()));
            at = next;
        }
        contents
    }
}

fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

fn follows_path(tokens: &[Token<'_>], at: usize) -> bool {
    at.checked_sub(1).is_some_and(|before| tokens[before].text == "::")
}

/// Seen from the file, not from `depth` modules within it.
fn leave(path: &mut Named, depth: usize) {
    let above = path.names.iter().take(depth).take_while(|name| *name == "super").count();
    if above > 0 {
        path.names.drain(..above);
        path.names.insert(0, "self".to_owned());
    }
}

/// Reads the tree of imports at `at`, below `before`; the index after it.
fn imports(tokens: &[Token<'_>], mut at: usize, before: &[String], found: &mut Vec<Named>) -> usize {
    let mut names = before.to_vec();
    while let Some(token) = tokens.get(at) {
        let text = |ahead: usize| tokens.get(at + ahead).map_or("", |token| token.text);
        match token.text {
            "::" => at += 1,
            "{" => {
                at += 1;
                while tokens.get(at).is_some_and(|token| token.text != "}") {
                    at = imports(tokens, at, &names, found);
                    at += usize::from(tokens.get(at).is_some_and(|token| token.text == ","));
                }
                return at + 1;
            }
            "*" => {
                found.push(Named { names, alias: Some("*".to_owned()), line: token.line });
                return at + 1;
            }
            name if text(1) == "::" => {
                names.push(name.to_owned());
                at += 2;
            }
            name => {
                // `a::{self}` is `a`.
                if name != "self" || names.is_empty() {
                    names.push(name.to_owned());
                }
                let renamed = text(1) == "as";
                let alias = if renamed { Some(text(2).to_owned()) } else { names.last().cloned() };
                found.push(Named { names, alias, line: token.line });
                return if renamed { at + 3 } else { at + 1 };
            }
        }
    }
    at
}

/// Reads the path at `at`, which is no import; the index after it.
fn written(tokens: &[Token<'_>], mut at: usize, found: &mut Vec<Named>) -> usize {
    let line = tokens[at].line;
    let mut names = vec![tokens[at].text.to_owned()];
    at += 1;
    while let [colons, name, ..] = &tokens[at..] {
        if colons.text != "::" || !is_name(name.text) {
            break;
        }
        names.push(name.text.to_owned());
        at += 2;
    }
    found.push(Named { names, alias: None, line });
    at
}

#[cfg(test)]
mod tests {
    use super::super::tokens::tokens;
    use super::*;

    fn paths(source: &str) -> Vec<String> {
        let contents = Contents::of(&tokens(source));
        let show = |path: &Named| {
            let alias = path.alias.as_ref().map(|alias| format!(" as {alias}")).unwrap_or_default();
            path.names.join("::") + &alias
        };
        contents.paths.iter().map(show).collect()
    }

    #[test]
    fn trees_of_imports_and_paths_in_place_are_read() {
        assert_eq!(
            paths("use crate::{a::{self, B as C}, d};"),
            ["crate::a as a", "crate::a::B as C", "crate::d as d"]
        );
        assert_eq!(paths("pub use super::a::*;"), ["super::a as *"]);
        assert_eq!(paths("fn a(b: &crate::c::D) -> e::F { g::h::<I>() }"), ["crate::c::D", "e::F", "g::h"]);
        assert_eq!(
            paths("mod a { use super::B; mod c { use super::super::D; } } use super::E;"),
            ["self::B as B", "self::D as D", "super::E as E"]
        );
        assert_eq!(paths("fn a() -> impl B + use<'_> {} "), [""; 0]);
    }

    #[test]
    fn modules_and_items_are_listed() {
        let contents = Contents::of(&tokens("pub mod a; mod b { struct C; } enum D {}"));
        assert_eq!(
            (contents.children, contents.items),
            (vec!["a".to_owned()], vec!["C".to_owned(), "D".to_owned()])
        );
    }
}
