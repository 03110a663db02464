//! Null, zero, truncated, enlarged, misaligned and huge: refused with a status and words, and nothing is touched.

use std::ffi::{c_char, c_void};
use std::mem::zeroed;
use std::ptr::{null, null_mut};

use airglow_gpu::ash::vk::{self, Handle};

use super::{adopt_info, call, refused, requirements, settings, with_host};
use crate::bake::{AirglowBakeInfo, airglow_bake};
use crate::context::*;
use crate::input::{array, versioned};
use crate::needs::AirglowNeed;
use crate::physical::AirglowPhysicalDevice;
use crate::prepared::*;
use crate::relight::frame::AirglowRelightFrame;
use crate::relight::health::*;
use crate::relight::plan::airglow_relight_plan;
use crate::relight::prepared::*;
use crate::relight::settings::{AirglowRelightBytes, AirglowRelightSettings, airglow_relight_bytes};
use crate::relight::*;
use crate::requirements::*;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};
use crate::text::AirglowText;
use crate::through_c::{error, function, message};
use crate::world::airglow_world_check;
use airglow_tests::conformance::HostDevice;

#[test]
fn null_is_refused_everywhere_and_dropping_it_is_nothing() {
    refused!(InvalidArgument, airglow_requirements_new, null_mut());
    refused!(InvalidArgument, airglow_requirements_list, null_mut(), null_mut(), null_mut());
    refused!(InvalidArgument, airglow_requirements_json, null(), null_mut());
    refused!(InvalidArgument, airglow_requirements_check, null(), null(), null_mut());
    refused!(InvalidArgument, airglow_requirements_patch, null_mut(), null(), 0, null_mut(), null_mut());
    refused!(InvalidArgument, airglow_context_adopt, null(), null_mut());
    refused!(InvalidArgument, airglow_context_begin_frame, null(), 1);
    refused!(InvalidArgument, airglow_context_memory_json, null(), null_mut());
    refused!(InvalidArgument, airglow_context_last_pass_reached, null(), null_mut(), null_mut());
    refused!(InvalidArgument, airglow_bake, null(), null_mut(), 0, null_mut());
    refused!(InvalidArgument, airglow_relight_require, null_mut(), null());
    refused!(InvalidArgument, airglow_relight_bytes, null(), 0, null_mut());
    refused!(InvalidArgument, airglow_relight_new, null(), null(), null_mut());
    refused!(InvalidArgument, airglow_relight_add_mesh, null(), null(), 1, null(), 0, null_mut());
    refused!(InvalidArgument, airglow_relight_drop_mesh, null(), 1);
    refused!(InvalidArgument, airglow_relight_set_environment, null(), 1, 1, null());
    refused!(InvalidArgument, airglow_relight_prepare, null(), null(), null_mut());
    refused!(InvalidArgument, airglow_relight_plan, null(), null(), 0, null_mut());
    refused!(InvalidArgument, airglow_prepared_make_scratch, null_mut());
    refused!(InvalidArgument, airglow_prepared_forget, null());
    refused!(InvalidArgument, airglow_relight_set_world, null(), null());
    refused!(InvalidArgument, airglow_world_check, null());
    refused!(InvalidArgument, airglow_relight_show, null(), 0, 1, 1);
    refused!(InvalidArgument, airglow_relight_set_lit, null(), 1);
    refused!(InvalidArgument, airglow_relight_turn, null(), null(), null(), 0);
    refused!(InvalidArgument, airglow_relight_health_clear, null(), 0);
    refused!(InvalidArgument, airglow_relight_health_collect, null(), 0);
    refused!(InvalidArgument, airglow_relight_health_latest, null(), null_mut());
    refused!(InvalidArgument, airglow_prepared_accesses, null(), null_mut(), null_mut());
    refused!(InvalidArgument, airglow_prepared_resources, null(), null_mut(), null_mut());
    refused!(InvalidArgument, airglow_relight_ranges, null(), null_mut(), null_mut());
    refused!(InvalidArgument, airglow_prepared_record, null(), 0, null(), 0);
    // SAFETY: null is nothing; an error may be null.
    unsafe {
        airglow_requirements_drop(null_mut());
        airglow_context_drop(null_mut());
        airglow_relight_drop(null_mut());
        airglow_prepared_drop(null_mut());
        assert_eq!(airglow_context_begin_frame(null(), 1, null_mut()), AirglowStatus::InvalidArgument);
    }
}

#[test]
fn structures_of_other_versions_are_accepted_or_refused_as_stated() {
    // SAFETY: zero bytes are valid bytes.
    let mut bytes: AirglowRelightBytes = unsafe { zeroed() };
    let target = &raw mut bytes;
    let full = size_of::<AirglowRelightSettings>() as u32;
    // One that is larger: the settings of a newer version, with room behind.
    let mut newer = [settings(0); 2];
    for (struct_size, order) in [(full, 2), (8, 3), (full + 8, 2)] {
        newer[0] = AirglowRelightSettings { struct_size, order, ..settings(0) };
        newer[1].struct_size = 0;
        newer[1].order = 0;
        call!(airglow_relight_bytes, newer.as_ptr(), 100, target);
        // 100 vertices are padded to 128, coefficients to a multiple of 4, 4 bytes each.
        let coefficients = u64::from(order * order).next_multiple_of(4);
        assert_eq!((bytes.vectors, bytes.results), (128 * 4 * coefficients, 1600));
    }
    newer[1].struct_size = 1;
    let said = refused!(InvalidStruct, airglow_relight_bytes, newer.as_ptr(), 1, target);
    assert!(said.contains("newer version"), "{said}");
    for struct_size in [0, 4, 12, full - 1, 1 << 20, u32::MAX] {
        let truncated = AirglowRelightSettings { struct_size, ..settings(0) };
        let said = refused!(InvalidStruct, airglow_relight_bytes, &raw const truncated, 1, target);
        assert!(said.contains(&format!("struct_size is {struct_size}")), "{said}");
    }
    // An older adopt info stops before the lists: their fields are zero, whatever lies behind.
    let older = AirglowAdoptInfo {
        struct_size: std::mem::offset_of!(AirglowAdoptInfo, extension_names) as u32,
        extension_count: usize::MAX,
        // SAFETY: zero bytes are a valid description.
        ..unsafe { zeroed() }
    };
    // SAFETY: the pointer is valid for its size.
    let read = unsafe { versioned(&raw const older, "info") }.unwrap();
    assert_eq!(read.extension_count, 0);
}

#[test]
fn values_out_of_range_are_named() {
    let target = &mut AirglowRelightBytes { vectors: 0, results: 0, results_usage: 0, reserved: 0 };
    for (wrong, word) in [
        (AirglowRelightSettings { order: 7, ..settings(0) }, "order 7"),
        (AirglowRelightSettings { storage: 2, ..settings(0) }, "storage"),
        (AirglowRelightSettings { output: 1, ..settings(1) }, "Method::Compute"),
        (settings(u32::MAX), "method"),
    ] {
        let said = refused!(InvalidArgument, airglow_relight_bytes, &raw const wrong, 1, target);
        assert!(said.contains(word), "{said}");
    }
}

#[test]
fn arrays_that_no_memory_holds_are_refused() {
    let value = 0f32;
    for (pointer, count) in [
        (&raw const value, usize::MAX),
        (&raw const value, isize::MAX as usize / 4 + 1),
        (null(), 1),
        ((&raw const value).wrapping_byte_add(1), 1),
    ] {
        // SAFETY: refused before anything is read.
        assert!(unsafe { array(pointer, count, "values") }.is_err(), "{pointer:?} {count}");
    }
    // SAFETY: null with no elements is none.
    assert!(unsafe { array::<f32>(null(), 0, "values") }.unwrap().is_empty());
}

#[test]
fn a_bake_of_nonsense_is_refused() {
    let (positions, indices, mut transfer) = ([0f32, 0., 0., 1., 0., 0., 0., 0., 1.], [0, 2, 1], [7f32; 48]);
    let sound = AirglowBakeInfo {
        struct_size: size_of::<AirglowBakeInfo>() as u32,
        positions: positions.as_ptr(),
        normals: positions.as_ptr(),
        vertex_count: 3,
        indices: indices.as_ptr(),
        index_count: 3,
        rays: 4,
        // SAFETY: zero bytes are a valid description.
        ..unsafe { zeroed() }
    };
    unsafe extern "C" fn stop(_: *mut c_void, _: usize, _: usize) -> u32 {
        1
    }
    let target = transfer.as_mut_ptr();
    for (wrong, count) in [
        (sound, 47),
        (sound, usize::MAX),
        (AirglowBakeInfo { vertex_count: 0, ..sound }, 0),
        (AirglowBakeInfo { vertex_count: usize::MAX / 2, ..sound }, 48),
        (AirglowBakeInfo { normals: null(), ..sound }, 48),
        (AirglowBakeInfo { index_count: usize::MAX, ..sound }, 48),
        (AirglowBakeInfo { index_count: 2, ..sound }, 48),
        (AirglowBakeInfo { reach: f32::NAN, ..sound }, 48),
        (AirglowBakeInfo { rays: u32::MAX, ..sound }, 48),
        (AirglowBakeInfo { below_horizon: 3, ..sound }, 48),
    ] {
        refused!(InvalidArgument, airglow_bake, &raw const wrong, target, count, null_mut());
    }
    let stopped = AirglowBakeInfo { progress: Some(stop), ..sound };
    refused!(Cancelled, airglow_bake, &raw const stopped, target, 48, null_mut());
    assert_eq!(transfer, [7f32; 48], "nothing was written");
    let target = transfer.as_mut_ptr();
    call!(airglow_bake, &raw const sound, target, 48, null_mut());
    assert_eq!(transfer[..16], [0f32; 16], "the first normal is zero");
    assert!(transfer[16] > 0.0);
}

#[test]
fn a_device_that_lacks_something_and_texts_that_do_not_fit() {
    with_host(|host| lacking(host, requirements(&settings(0))));
}

fn lacking(host: &HostDevice<'_>, asked: *mut AirglowRequirements) {
    let mut data = [1u8; 4096];
    let mut text = AirglowText { data: data.as_mut_ptr().cast(), capacity: data.len(), length: 0 };
    let info = AirglowAdoptInfo { requirements: asked, missing: &raw mut text, ..adopt_info(host) };
    let mut context = null_mut();
    let said = refused!(Missing, airglow_context_adopt, &raw const info, &raw mut context);
    assert!(context.is_null() && said.contains("synchronization2"), "{said}");
    let listed: Vec<String> = serde_json::from_slice(&data[..text.length]).unwrap();
    assert_eq!(listed.len(), 2, "{listed:?}");
    for wrong in [
        AirglowAdoptInfo { device: 0, ..info },
        AirglowAdoptInfo { get_instance_proc_addr: None, ..info },
        AirglowAdoptInfo { frames_in_flight: 0, ..info },
        AirglowAdoptInfo { device_create_info: (&raw const info).cast(), ..info },
        AirglowAdoptInfo { feature_count: usize::MAX, ..info },
    ] {
        refused!(InvalidArgument, airglow_context_adopt, &raw const wrong, &raw mut context);
    }
    unsafe extern "system" fn nothing(_: vk::Instance, _: *const c_char) -> vk::PFN_vkVoidFunction {
        None
    }
    let find: vk::PFN_vkGetInstanceProcAddr = nothing;
    let deaf = AirglowAdoptInfo { get_instance_proc_addr: function(find), ..info };
    let said = refused!(Missing, airglow_context_adopt, &raw const deaf, &raw mut context);
    assert!(said.contains("vkGetPhysicalDeviceProperties"), "{said}");

    let candidate = AirglowPhysicalDevice {
        struct_size: size_of::<AirglowPhysicalDevice>() as u32,
        queue_family: host.queue_family,
        get_instance_proc_addr: function(host.get_instance_proc_addr),
        instance: host.instance.as_raw(),
        physical_device: host.physical_device.as_raw(),
    };
    call!(airglow_requirements_check, asked, &raw const candidate, null_mut());
    let mut no_family = AirglowPhysicalDevice { queue_family: 1000, ..candidate };
    refused!(Missing, airglow_requirements_check, asked, &raw const no_family, &raw mut text);
    no_family.get_instance_proc_addr = function(find);
    refused!(Missing, airglow_requirements_check, asked, &raw const no_family, null_mut());

    let mut length = AirglowText { data: null_mut(), capacity: 0, length: 0 };
    call!(airglow_requirements_json, asked, &raw mut length);
    let mut short = AirglowText { data: data.as_mut_ptr().cast(), capacity: 10, length: 0 };
    refused!(Incomplete, airglow_requirements_json, asked, &raw mut short);
    assert_eq!((short.length, data[9]), (length.length, 0));
    let mut count = 0;
    call!(airglow_requirements_list, asked, null_mut(), &raw mut count);
    // SAFETY: zero bytes are a valid need.
    let mut needs = vec![unsafe { zeroed::<AirglowNeed>() }; count];
    let mut room = count - 1;
    refused!(Incomplete, airglow_requirements_list, asked, needs.as_mut_ptr(), &raw mut room);
    assert_eq!(room, count);
    call!(airglow_requirements_list, asked, needs.as_mut_ptr(), &raw mut room);
    // SAFETY: names live as long as the requirements, which are dropped last.
    unsafe {
        let name = |need: &AirglowNeed| std::ffi::CStr::from_ptr(need.name).to_str().unwrap().to_owned();
        assert!(needs.iter().any(|need| name(need) == "dynamicRendering" && need.required == 1));
        airglow_requirements_drop(asked);
    }
}

#[test]
fn a_panic_becomes_a_status() {
    let mut error = error();
    // SAFETY: a whole error.
    let status = unsafe { edge(&raw mut error, || panic!("on purpose")) };
    assert_eq!((status, error.status), (AirglowStatus::Internal, AirglowStatus::Internal));
    assert!(message(&error).contains("on purpose"));
}

#[test]
fn a_message_is_cut_to_what_the_host_gave() {
    let long = "é".repeat(1000);
    let fail = || Err(Failure::new(AirglowStatus::Vulkan, long.clone()));
    let mut whole = error();
    // SAFETY: a whole error, and parts of one that say so.
    unsafe {
        edge(&raw mut whole, fail);
        assert_eq!((whole.message_length, message(&whole).len()), (2000, 1006), "no half character");
        let mut short = AirglowError { struct_size: 24, ..error() };
        short.message[8] = 1;
        edge(&raw mut short, fail);
        assert_eq!((message(&short).len(), short.message[8]), (6, 1));
        let mut none = AirglowError { struct_size: 16, ..error() };
        edge(&raw mut none, fail);
        assert_eq!(none.status, AirglowStatus::Ok, "left alone");
    }
}

#[test]
fn a_frame_of_nonsense_is_refused() {
    let frame = AirglowRelightFrame {
        struct_size: 8,
        // SAFETY: zero bytes are a valid frame.
        ..unsafe { zeroed() }
    };
    // SAFETY: the pointer is valid for its size.
    assert!(unsafe { versioned(&raw const frame, "frame") }.is_err());
}
