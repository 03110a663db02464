//! Which siblings use one another round in a circle.

use std::collections::{BTreeMap, BTreeSet};

use super::tree::{Place, Tree};

/// The siblings below a module, and for each the uses that lead to others.
type Uses = BTreeMap<String, BTreeMap<String, Vec<String>>>;

/// Every use that lies on a circle of siblings, as lines to read, and every import that would hide such uses.
pub fn circles(tree: &Tree) -> Vec<String> {
    let mut lines = hidden(tree);
    for (folder, uses) in siblings(tree) {
        for (user, used) in &uses {
            for (name, places) in used.iter().filter(|(name, _)| reached(&uses, name).contains(user.as_str()))
            {
                let below = if folder.is_empty() { "the root".to_owned() } else { folder.join("::") };
                lines.push(format!("below {below}: {user} uses {name}: {}", places.join(", ")));
            }
        }
    }
    lines
}

/// The uses between siblings, by the module they are below. A module's use of what is above or below it is none.
fn siblings(tree: &Tree) -> BTreeMap<Place, Uses> {
    let mut all: BTreeMap<Place, Uses> = BTreeMap::new();
    for (user, module) in &tree.modules {
        for path in &module.contents.paths {
            let Some(used) = tree.target(user, path) else { continue };
            let common = user.iter().zip(&used).take_while(|(a, b)| a == b).count();
            if common == user.len() || common == used.len() {
                continue;
            }
            let uses = all.entry(user[..common].to_vec()).or_default();
            let places =
                uses.entry(user[common].clone()).or_default().entry(used[common].clone()).or_default();
            places.push(format!("{}:{} {}", module.file.display(), path.line, path.names.join("::")));
        }
    }
    all
}

/// Imports of all that a module above has: what of it is used, they do not say.
fn hidden(tree: &Tree) -> Vec<String> {
    let mut lines = Vec::new();
    for (user, module) in &tree.modules {
        let globs = module.contents.paths.iter().filter(|path| path.alias.as_deref() == Some("*"));
        for glob in globs.filter(|glob| tree.is_above(user, glob)) {
            lines.push(format!("{}:{} name what is imported", module.file.display(), glob.line));
        }
    }
    lines
}

/// What `from` uses, directly or through others.
fn reached<'a>(uses: &'a Uses, from: &'a str) -> BTreeSet<&'a str> {
    let (mut found, mut left) = (BTreeSet::new(), vec![from]);
    while let Some(name) = left.pop() {
        let next = uses.get(name).into_iter().flat_map(BTreeMap::keys).map(String::as_str);
        left.extend(next.filter(|name| found.insert(*name)));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn of(files: &[(&str, &str)]) -> Vec<String> {
        let read = |path: &Path| {
            files.iter().find(|(name, _)| Path::new(name) == path).map(|(_, text)| (*text).to_owned())
        };
        circles(&Tree::of(Path::new("lib.rs"), &read))
    }

    #[test]
    fn a_circle_is_told_with_its_places() {
        let files = [
            ("lib.rs", "mod a; mod b; mod c;"),
            ("a.rs", "\nuse crate::b::B;"),
            ("c.rs", "use crate::a::A;"),
        ];
        let with = |b| of(&[&files[..], &[("b.rs", b)]].concat());
        assert_eq!(
            with("use crate::c::{C, D};"),
            [
                "below the root: a uses b: a.rs:2 crate::b::B",
                "below the root: b uses c: b.rs:1 crate::c::C, b.rs:1 crate::c::D",
                "below the root: c uses a: c.rs:1 crate::a::A",
            ]
        );
        assert_eq!(with("fn b() { super::a::c() }").len(), 2);
        assert_eq!(with("use std::a::A; use std::c::*;"), [""; 0]);
        assert_eq!(with("use super::*;"), ["b.rs:1 name what is imported"]);
        assert_eq!(with("#[cfg(test)] mod tests { use crate::a::A; }"), [""; 0]);
    }

    #[test]
    fn names_that_the_root_hands_on_are_uses_of_where_they_are() {
        let root = "mod a; mod b; pub use a::A; pub use b::*; struct Own;";
        let of = |a, b| of(&[("lib.rs", root), ("a.rs", a), ("b.rs", b)]).len();
        assert_eq!(of("use crate::B;", "pub struct B; fn b(a: crate::A) {}"), 2);
        assert_eq!(of("use crate::Own;", "pub struct B; fn b(a: crate::A) {}"), 0);
        assert_eq!(of("use crate as root; fn a() -> root::B {}", "pub struct B; use crate::A;"), 2);
    }

    #[test]
    fn folders_are_held_to_it_too() {
        let files =
            [("lib.rs", "mod a;"), ("a/mod.rs", "mod b; mod c; use b::B;"), ("a/c.rs", "use super::b::B;")];
        let with = |b| of(&[&files[..], &[("a/b.rs", b)]].concat()).len();
        assert_eq!((with("use super::c::C;"), with("use super::D;")), (2, 0));
    }
}
