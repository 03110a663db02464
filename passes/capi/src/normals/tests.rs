//! The functions as a host calls them.

use std::ffi::CString;
use std::ptr::{null, null_mut};

use airglow_gpu::ash::vk::Handle;
use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_tests::device::{open, stated};

use super::conformance::*;
use super::info::*;
use super::map::*;
use super::prepared::airglow_normal_map_prepare;
use super::*;
use crate::health::airglow_health_drop;
use crate::prepared::*;
use crate::testing::{call, refused, sizes_refused, text, with_host};
use crate::through_c::attempt;

#[test]
fn null_is_refused_everywhere() {
    refused!(InvalidArgument, airglow_normals_require, null_mut(), null());
    refused!(InvalidArgument, airglow_normals_new, null(), null(), null_mut());
    refused!(InvalidArgument, airglow_normal_map_new, null(), null(), null_mut());
    refused!(InvalidArgument, airglow_normal_map_prepare, null(), 1, null_mut());
    refused!(InvalidArgument, airglow_normal_map_progress, null(), null_mut());
    refused!(InvalidArgument, airglow_normal_map_texture, null(), null_mut());
    refused!(InvalidArgument, airglow_normal_map_read_back, null(), 0);
    refused!(InvalidArgument, airglow_normal_map_store, null(), null());
    refused!(InvalidArgument, airglow_normal_map_finish, null());
    refused!(InvalidArgument, airglow_normals_health_new, null(), null_mut());
    refused!(InvalidArgument, airglow_normal_map_count, null(), null());
    refused!(InvalidArgument, airglow_normal_map_plan, null(), 1, 0, null_mut());
    // SAFETY: null is nothing.
    unsafe {
        airglow_normals_drop(null_mut());
        airglow_normal_map_drop(null_mut());
    }
}

#[test]
fn what_no_map_is_is_refused_and_named() {
    with_host(&requirements(), |host| {
        let (made, normals) = in_c(host).unwrap();
        let (context, mut other) = (made.context, null_mut());
        let good = settings();
        for (wrong, word) in [
            (AirglowNormalsSettings { lobes: 7, ..good }, "lobes"),
            (AirglowNormalsSettings { lobes: 3, ..good }, "1, 2, 4 or 6"),
            (AirglowNormalsSettings { iterations: 33, ..good }, "iterations"),
            (AirglowNormalsSettings { storage: 9, ..good }, "storage"),
            (AirglowNormalsSettings { sharpest: f64::NAN, ..good }, "sharpest"),
        ] {
            let said =
                refused!(InvalidArgument, airglow_normals_new, context, &raw const wrong, &raw mut other);
            assert!(said.contains(word) && other.is_null(), "{said}");
        }
        sizes_refused(&good, |wrong| {
            refused!(InvalidStruct, airglow_normals_new, context, wrong, &raw mut other)
        });
        let texels = texels();
        let (good, mut map) = (info(&texels), null_mut());
        for (wrong, word) in [
            (AirglowNormalMapInfo { format: 4, ..good }, "info.format"),
            (AirglowNormalMapInfo { green_down: 2, ..good }, "info.green_down"),
            (AirglowNormalMapInfo { width: 0, ..good }, "texel_bytes"),
            (AirglowNormalMapInfo { width: u32::MAX, height: u32::MAX, ..good }, "texel_bytes"),
            (AirglowNormalMapInfo { texel_bytes: usize::MAX, ..good }, "texel_bytes"),
            (AirglowNormalMapInfo { format: 3, ..good }, "texels of 8 bytes"),
            (AirglowNormalMapInfo { texels: null(), ..good }, "info.texels"),
        ] {
            let said =
                refused!(InvalidArgument, airglow_normal_map_new, normals, &raw const wrong, &raw mut map);
            assert!(said.contains(word) && map.is_null(), "{said}");
        }
        sizes_refused(&good, |wrong| {
            refused!(InvalidStruct, airglow_normal_map_new, normals, wrong, &raw mut map)
        });
        let single = AirglowNormalMapInfo { width: 1, height: 1, texel_bytes: 4, ..good };
        call!(airglow_normal_map_new, normals, &raw const single, &raw mut map);
        assert_eq!(texture(map).unwrap().image, 0, "its normal is all that there is");
        // SAFETY: it is not used again.
        unsafe { airglow_normal_map_drop(map) };
    });
}

#[test]
fn a_map_that_was_stored_is_copied_in_one_step() {
    let open = open(&requirements());
    let (mut made, normals) = in_c(&stated(&open, open.device())).unwrap();
    // SAFETY: dropped below, when the device is idle.
    let host = unsafe { open.adopt(1) }.unwrap();
    let folder = std::env::temp_dir().join(format!("airglow normals {}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("map");
    let path = CString::new(file.to_str().unwrap()).unwrap();
    let texels = texels();
    let named = AirglowNormalMapInfo { cache: path.as_ptr(), ..info(&texels) };
    let mut frames = FrameLoop::new(&open, &host).unwrap();
    for round in 0..2 {
        let built = map(&mut made, normals, &named).unwrap();
        let first = progress(built);
        assert_eq!((first.done, first.cached), (0, round));
        refused!(InvalidArgument, airglow_normal_map_prepare, built, 0, null_mut());
        refused!(InvalidArgument, airglow_normal_map_read_back, built, 1);
        refused!(InvalidArgument, airglow_normal_map_store, built, path.as_ptr());
        let health = made.hold(airglow_health_drop, |to| attempt!(airglow_normals_health_new, normals, to));
        let health = health.unwrap();
        call!(airglow_normal_map_count, built, health);
        let plan = text(|text| call!(airglow_normal_map_plan, built, usize::MAX, 0, text));
        assert!(plan.contains(if round == 0 { "normals fit" } else { "copy" }), "{plan}");
        assert_eq!(plan.contains("normals health"), round == 0, "{plan}");
        let steps = made.prepare(|steps| attempt!(airglow_normal_map_prepare, built, usize::MAX, steps));
        let steps = steps.unwrap();
        let said = refused!(InvalidArgument, airglow_normal_map_count, built, health);
        assert!(said.contains("count before"), "{said}");
        frames
            .frame(FrameSemaphores::default(), |commands| {
                call!(airglow_prepared_record, steps, commands.as_raw(), null(), 0);
                call!(airglow_normal_map_read_back, built, commands.as_raw());
                Ok(())
            })
            .unwrap();
        frames.finish().unwrap();
        assert_eq!(progress(built).done, first.total);
        call!(airglow_normal_map_store, built, path.as_ptr());
        let bytes = std::fs::read(&file).unwrap();
        assert!(bytes.len() as u64 > texture(built).unwrap().bytes);
        let nowhere = c"/no such folder/map".as_ptr();
        let said = refused!(InvalidArgument, airglow_normal_map_store, built, nowhere);
        assert!(said.contains("folder"), "{said}");
        call!(airglow_normal_map_finish, built);
        assert!(texture(built).unwrap().image != 0, "the texture stays");
    }
    drop(frames);
    drop((made, host));
    std::fs::remove_dir_all(folder).unwrap();
    assert!(open.messages().take().is_empty());
}

fn progress(map: *const AirglowNormalMap) -> AirglowNormalMapProgress {
    let mut progress = AirglowNormalMapProgress { done: 9, total: 9, repaired: 9, cached: 9, reserved: 9 };
    call!(airglow_normal_map_progress, map, &raw mut progress);
    progress
}
