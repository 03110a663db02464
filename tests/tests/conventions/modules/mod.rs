//! No circle between modules: those side by side in a folder use one another in one direction only.

mod circles;
mod paths;
mod tokens;
mod tree;

use std::path::{Path, PathBuf};

use tree::Tree;

/// The folder of the workspace.
pub fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The folders of the workspace's crates, as its manifest lists them, and of the template that rooms are made from.
fn crates() -> Vec<String> {
    let manifest =
        std::fs::read_to_string(workspace().join("Cargo.toml")).expect("the workspace has a manifest");
    let members = manifest.split_once("members = [").and_then(|(_, rest)| rest.split_once(']'));
    let members = members.expect("the manifest lists its members").0;
    let named = members.split('"').skip(1).step_by(2).map(str::to_owned);
    named.chain(["tools/xtask/template".to_owned()]).collect()
}

#[test]
fn no_modules_use_one_another_in_a_circle() {
    let read = |path: &Path| std::fs::read_to_string(workspace().join(path)).ok();
    let (mut modules, mut found) = (0, Vec::new());
    for folder in crates() {
        let trees = ["src/lib.rs", "src/main.rs"].map(|root| Tree::of(&Path::new(&folder).join(root), &read));
        let below: usize = trees.iter().map(|tree| tree.modules.len()).sum();
        assert!(below > 0, "{folder}: no source");
        modules += below;
        found.extend(trees.iter().flat_map(circles::circles).map(|line| format!("{folder}: {line}")));
    }
    println!("{modules} modules");
    assert!(found.is_empty(), "{} uses that lie on a circle:\n{}", found.len(), found.join("\n"));
}
