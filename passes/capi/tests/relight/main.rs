//! A host in C++ builds against both libraries, runs in silence under validation, and lights its mesh.
#![cfg(feature = "relight")]

#[path = "../common/mod.rs"]
mod common;

use airglow_capi::access::*;
use airglow_capi::binding::*;
use airglow_capi::relight::frame::*;
use airglow_capi::relight::health::*;
use airglow_capi::relight::prepared::*;
use airglow_capi::relight::settings::*;
use common::{ROOM, assert_sizes, build, host, linked, picture};

/// Side of the picture of `host.cpp`.
const SIDE: usize = 128;

#[test]
fn structures_measure_what_rust_s_do() {
    let sizes = sizes![
        AirglowAccess,
        AirglowBinding,
        AirglowRelightBytes,
        AirglowRelightFrame,
        AirglowRelightHealth,
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
        let source = format!("{ROOM}/examples/relight/host.cpp");
        let program = host(source.as_ref(), &format!("relight_{name}"), &libraries);
        picture(&program, [SIDE; 2])
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

#[cfg(feature = "shadow")]
#[test]
fn a_host_in_cpp_hands_the_shadow_of_a_ball_to_relighting() {
    let [(name, libraries), _] = linked(&build("airglow-c"), "airglow");
    let source = format!("{ROOM}/examples/shadow/host.cpp");
    let program = host(source.as_ref(), &format!("shadow_{name}"), &libraries);
    let picture = picture(&program, [SIDE; 2]);
    let at = |x: usize, y: usize| u32::from(picture[3 * (y * SIDE + x)]);
    // The ball hovers over (0.5, 0.5), and the sun is low over the left edge.
    let (plain, below, behind) = (at(5, 5), at(96, 96), at(110, 96));
    assert!(below + 20 < plain && behind + 5 < plain, "plain {plain}, below {below}, behind {behind}");
}
