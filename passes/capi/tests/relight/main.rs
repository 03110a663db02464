//! A host in C++ builds against both libraries, runs in silence under validation, and lights its mesh.
#![cfg(feature = "relight")]
#![expect(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

#[path = "../common/mod.rs"]
mod common;

use std::fs;
use std::path::Path;

use airglow_capi::relight::frame::*;
use airglow_capi::relight::lists::*;
use airglow_capi::relight::record::*;
use airglow_capi::relight::settings::*;
use common::{ROOM, assert_sizes, build, compiler, linked, run, run_validated, scratch};

/// Side of the picture of `host.cpp`.
const SIDE: usize = 128;

const VULKAN: &str = "install g++ and Vulkan's headers (Debian: g++ libvulkan-dev)";

#[test]
fn structures_measure_what_rust_s_do() {
    let sizes = sizes![
        AirglowAccess,
        AirglowBinding,
        AirglowRelightBytes,
        AirglowRelightFrame,
        AirglowRelightInstance,
        AirglowRelightSettings,
        AirglowResourceInfo,
        AirglowResultRange,
    ];
    assert_sizes("relight_sizes.c", &sizes);
}

#[test]
fn a_host_in_cpp_lights_its_mesh_with_either_library() {
    let pictures = linked(&build("airglow-c"), "airglow").map(|(name, libraries)| {
        let program = scratch().join(format!("host_{name}"));
        let mut command = compiler("g++", "-std=c++17");
        command.args(["-O1", "-o"]).arg(&program).arg(format!("{ROOM}/examples/relight/host.cpp"));
        run(command.args(libraries).arg("-lvulkan"), VULKAN);
        light(&program)
    });
    assert!(pictures[0] == pictures[1], "the two libraries give other pictures");
    let at = |x: usize, y: usize| {
        let pixel = &pictures[0][3 * (y * SIDE + x)..][..3];
        pixel.iter().map(|&value| u32::from(value)).sum::<u32>()
    };
    // The sun is low over the left edge: it lights the dome's left flank, and the plain right of it is in shadow.
    let (plain, flank, far_flank, shadow) = (at(5, 5), at(25, 83), at(67, 83), at(79, 83));
    assert!(flank > plain && plain > far_flank, "flank {flank}, plain {plain}, far flank {far_flank}");
    assert!(shadow + 20 < plain, "shadow {shadow}, plain {plain}");
}

#[test]
fn a_host_in_cpp_runs_the_conformance_kit_on_its_device() {
    for (name, libraries) in linked(&build("airglow-conform"), "airglow_conformance") {
        let program = scratch().join(format!("conformance_{name}"));
        let mut command = compiler("g++", "-std=c++17");
        command.args(["-O1", "-o"]).arg(&program).arg(format!("{ROOM}/tests/relight/conformance.cpp"));
        run(command.args(libraries).arg("-lvulkan"), VULKAN);
        let said = run_validated(&program, &program);
        assert!(said.contains("4 checks, 0 failures"), "{said}");
    }
}

/// Runs a host; its picture's bytes.
fn light(program: &Path) -> Vec<u8> {
    let picture = program.with_extension("ppm");
    run_validated(program, &picture);
    let bytes = fs::read(picture).unwrap();
    let header = format!("P6 {SIDE} {SIDE} 255\n");
    assert!(bytes.starts_with(header.as_bytes()) && bytes.len() == header.len() + 3 * SIDE * SIDE);
    bytes[header.len()..].to_vec()
}
