//! The modules of a crate, and which of them each path leads to.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::paths::{Contents, Named};
use super::tokens::tokens;

/// Where a module is in its crate: the names from the root down.
pub type Place = Vec<String>;

/// A module that has a file of its own.
#[derive(Debug)]
pub struct Module {
    pub file: PathBuf,
    pub contents: Contents,
}

/// The modules of a crate.
#[derive(Debug, Default)]
pub struct Tree {
    pub modules: BTreeMap<Place, Module>,
}

/// Re-exports of re-exports that are followed.
const MOST_STEPS: usize = 16;

impl Tree {
    /// The modules from the root `file` down, as `read` gives them.
    pub fn of(file: &Path, read: &dyn Fn(&Path) -> Option<String>) -> Self {
        let mut tree = Self::default();
        let folder = file.parent().unwrap_or(Path::new(""));
        tree.add(Vec::new(), file, folder, read);
        tree
    }

    fn add(&mut self, place: Place, file: &Path, folder: &Path, read: &dyn Fn(&Path) -> Option<String>) {
        let Some(text) = read(file) else { return };
        let contents = Contents::of(&tokens(&text));
        for child in &contents.children {
            let place = [&place[..], std::slice::from_ref(child)].concat();
            let below = folder.join(child);
            self.add(place.clone(), &folder.join(format!("{child}.rs")), &below, read);
            self.add(place, &below.join("mod.rs"), &below, read);
        }
        self.modules.insert(place, Module { file: file.to_owned(), contents });
    }

    /// The module that `path`, written in the module at `user`, leads to; none if it leads out of the crate.
    ///
    /// Past a module that is not above `user` its own re-exports are not followed: the module named is the one used.
    pub fn target(&self, user: &Place, path: &Named) -> Option<Place> {
        self.target_within(user, path, MOST_STEPS)
    }

    /// Whether `path`, written in the module at `user`, is that of a module above it.
    pub fn is_above(&self, user: &Place, path: &Named) -> bool {
        let named = self.absolute(user, &path.names, MOST_STEPS).map(|(home, names)| [home, names].concat());
        named.is_some_and(|named| named.len() < user.len() && user.starts_with(&named))
    }

    fn target_within(&self, user: &Place, path: &Named, steps: usize) -> Option<Place> {
        let (home, names) = self.absolute(user, &path.names, steps)?;
        Some(self.follow(home, names, user, steps))
    }

    /// The names below a module that `names` in the module at `home` stand for.
    fn absolute(&self, home: &Place, names: &[String], steps: usize) -> Option<(Place, Vec<String>)> {
        let (first, rest) = names.split_first()?;
        let contents = &self.modules.get(home)?.contents;
        match first.as_str() {
            "crate" => Some((Place::new(), rest.to_vec())),
            "self" => Some((home.clone(), rest.to_vec())),
            "super" => {
                let (mut above, mut rest) = (home.clone(), names);
                while let [first, after @ ..] = rest {
                    if first != "super" {
                        break;
                    }
                    above.pop();
                    rest = after;
                }
                Some((above, rest.to_vec()))
            }
            _ if contents.children.contains(first) => Some((home.clone(), names.to_vec())),
            _ => {
                let import = contents.paths.iter().find(|path| path.alias.as_ref() == Some(first))?;
                // An import that begins with its own name is another crate's.
                if steps == 0 || import.names.first() == Some(first) {
                    return None;
                }
                let (home, mut below) = self.absolute(home, &import.names, steps - 1)?;
                below.extend_from_slice(rest);
                Some((home, below))
            }
        }
    }

    fn follow(&self, mut home: Place, mut names: Vec<String>, user: &Place, steps: usize) -> Place {
        while !names.is_empty() {
            home.push(names[0].clone());
            if self.modules.contains_key(&home) {
                names.remove(0);
                continue;
            }
            home.pop();
            let above = user.starts_with(&home);
            let steps = steps.checked_sub(1).filter(|_| above);
            let onward = steps.and_then(|steps| Some((self.onward(&home, &names, steps)?, steps)));
            return match onward {
                Some(((below, names), steps)) => self.follow(below, names, user, steps),
                None => home,
            };
        }
        home
    }

    /// Where the module at `home` has the first of `names` from, if not from itself.
    fn onward(&self, home: &Place, names: &[String], steps: usize) -> Option<(Place, Vec<String>)> {
        let contents = &self.modules.get(home)?.contents;
        if contents.items.contains(&names[0]) {
            return None;
        }
        if contents.paths.iter().any(|path| path.alias.as_ref() == Some(&names[0])) {
            return self.absolute(home, names, steps);
        }
        let globs = contents.paths.iter().filter(|path| path.alias.as_deref() == Some("*"));
        let mut modules = globs.filter_map(|glob| self.target_within(home, glob, steps));
        let found = modules.find(|place| {
            let there = self.modules.get(place).map(|module| &module.contents);
            there.is_some_and(|there| {
                let brought = there.paths.iter().any(|path| path.alias.as_ref() == Some(&names[0]));
                brought || there.items.contains(&names[0])
            })
        })?;
        (found != *home).then(|| (found, names.to_vec()))
    }
}
