//! The header compiles alone, and its structures have the sizes that Rust's have.

mod common;

use std::fs;

use airglow_capi::allocator::*;
use airglow_capi::bake::*;
use airglow_capi::context::*;
use airglow_capi::health::*;
use airglow_capi::needs::*;
use airglow_capi::physical::*;
use airglow_capi::status::*;
use airglow_capi::text::*;
use airglow_capi::world::*;
use common::{COMPILER, assert_sizes, compiler, run, scratch};

#[test]
fn it_compiles_alone_as_c99_and_as_cpp17() {
    for (program, standard, file) in [("gcc", "-std=c99", "header.c"), ("g++", "-std=c++17", "header.cpp")] {
        let source = scratch().join(file);
        fs::write(&source, "#include \"airglow.h\"\nint main(void) { return airglow_version() == 0; }\n")
            .unwrap();
        run(compiler(program, standard).arg("-fsyntax-only").arg(source), COMPILER);
    }
}

#[test]
fn its_structures_measure_what_rust_s_do() {
    let sizes = sizes![
        AirglowAdoptInfo,
        AirglowAllocation,
        AirglowAllocator,
        AirglowBakeInfo,
        AirglowBakeStats,
        AirglowError,
        AirglowHealthCounts,
        AirglowMemoryRequest,
        AirglowNeed,
        AirglowOccluder,
        AirglowPassReached,
        AirglowPhysicalDevice,
        AirglowText,
        AirglowWorld,
    ];
    assert_sizes("sizes.c", &sizes);
}

#[cfg(feature = "normals")]
#[test]
fn so_do_those_of_normals() {
    use airglow_capi::normals::{info::*, map::*, settings::*};
    let sizes =
        sizes![AirglowLobeTexture, AirglowNormalMapInfo, AirglowNormalMapProgress, AirglowNormalsSettings,];
    assert_sizes("normals_sizes.c", &sizes);
}

#[cfg(feature = "radiance")]
#[test]
fn so_do_those_of_radiance() {
    use airglow_capi::radiance::{lights::*, receiver::*, settings::*};
    let sizes = sizes![
        AirglowEmitter,
        AirglowEmitterSphere,
        AirglowRadianceLights,
        AirglowRadiancePart,
        AirglowRadianceReceiverInfo,
        AirglowRadianceSettings,
    ];
    assert_sizes("radiance_sizes.c", &sizes);
}

#[cfg(feature = "shadow")]
#[test]
fn so_do_those_of_shadow() {
    use airglow_capi::shadow::{hierarchy::*, prepared::*, settings::*};
    let sizes = sizes![AirglowShadowCounts, AirglowShadowSettings, AirglowSphere, AirglowSphereSet];
    assert_sizes("shadow_sizes.c", &sizes);
}
