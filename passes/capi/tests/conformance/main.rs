//! A host in C++ has the conformance kit check the library on its device: an honest one passes, and of each fault of a
//! host's the kit says what it is.

#[path = "../common/mod.rs"]
mod common;

use std::path::Path;
use std::process::Command;

use common::{ROOM, VULKAN, build, host, linked, run, run_validated};

/// What the kit says of a host with a fault, whose checks all fail.
fn said_of(program: &Path, fault: &str) -> Vec<String> {
    let output = run(Command::new(program).arg(fault), VULKAN);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let checks: Vec<_> = said.lines().filter_map(|line| Some(line.split_once(": ")?.1.to_owned())).collect();
    let end = format!("{0} checks, {0} failures", checks.len());
    assert!(said.contains(&end), "{fault}: {said}");
    checks
}

#[test]
fn the_kit_passes_an_honest_host_and_names_the_fault_of_another() {
    let source = format!("{ROOM}/tests/conformance/host.cpp");
    for (name, libraries) in linked(&build("airglow-conform"), "airglow_conformance") {
        let program = host(Path::new(&source), &format!("conformance_{name}"), &libraries);
        let said = run_validated(&program, "honest".as_ref());
        assert!(said.contains(" 0 failures"), "{said}");
        if name == "shared" {
            continue;
        }
        for (fault, words) in [
            ("features", &["synchronization2"][..]),
            ("memory", &["memory"]),
            // What no work fills may differ, too.
            ("work", &["lit", "differ"]),
        ] {
            for said in said_of(&program, fault) {
                assert!(words.iter().any(|word| said.contains(word)), "{fault}: {said}");
            }
        }
    }
}
