//! A host in C++ draws fog over a picture of its own, in silence under validation.
#![cfg(feature = "fog")]

#[path = "../common/mod.rs"]
mod common;

use airglow_capi::fog::background::*;
use airglow_capi::fog::prepared::*;
use airglow_capi::fog::settings::*;
use airglow_capi::fog::view::*;
use common::{ROOM, assert_sizes, build, host, linked, picture};

#[test]
fn structures_measure_what_rust_s_do() {
    let sizes = sizes![
        AirglowFogBackgroundSettings,
        AirglowFogBackgroundView,
        AirglowFogCounts,
        AirglowFogLight,
        AirglowFogSettings,
        AirglowFogView,
    ];
    assert_sizes("fog_sizes.c", &sizes);
}

#[test]
fn a_host_in_cpp_draws_the_glow_of_its_lamps() {
    let [(name, libraries), _] = linked(&build("airglow-c"), "airglow");
    let source = format!("{ROOM}/examples/fog/host.cpp");
    let program = host(source.as_ref(), &format!("fog_{name}"), &libraries);
    let (width, height) = (192, 108);
    let picture = picture(&program, [width, height]);
    let at = |x: usize, y: usize| <[u8; 3]>::try_from(&picture[3 * (y * width + x)..][..3]).unwrap();
    // A lamp at (-3, 3, -12) is seen from (0, 1.7, 0) at 0.25 to the left and 0.11 up of edges of 0.8 and 0.45.
    let (lamp, sky, corner) = (at(66, 41), at(66, 10), at(0, 0));
    assert!(lamp[0] > lamp[2] && lamp[0] > 150, "the warm lamp glows: {lamp:?}");
    assert!(lamp[0] > sky[0] && sky[0] > corner[0] && corner[0] > 0, "{lamp:?}, {sky:?}, {corner:?}");
    // The second lamp, at 0.25 to the right and 0.21 up, shines down: its cold glow ends beside the cone.
    let (within, beside) = (at(126, 45), at(150, 45));
    assert!(within[2] > beside[2] + 30, "within the cone {within:?}, beside it {beside:?}");
}
