//! A frame as data: resources, ranges, turns and plans.

use std::ffi::CStr;
use std::mem::zeroed;
use std::ptr::{null, null_mut};

use airglow_gpu::ash::vk;

use super::{call, in_c, refused, settings, text, with_host};
use crate::access::AirglowOrigin;
use crate::access::AirglowResourceInfo;
use crate::context::*;
use crate::plan::AirglowPlanFormat;
use crate::prepared::*;
use crate::relight::frame::{AirglowLight, AirglowRelightFrame, AirglowRelightInstance};
use crate::relight::plan::airglow_relight_plan;
use crate::relight::prepared::*;
use crate::relight::resources::AirglowRelightResource;
use crate::relight::*;
use crate::status::AirglowStatus;

#[test]
fn a_frame_is_data_before_anything_is_made() {
    with_host(|host| {
        let mut prepared = null_mut();
        let (made, relight) = in_c(host, &settings(0)).unwrap();
        // SAFETY: zero bytes are a valid instance and a valid frame.
        let (mut instances, mut frame): ([AirglowRelightInstance; 2], AirglowRelightFrame) =
            unsafe { zeroed() };
        let vectors = [0.5f32; 160];
        let mesh = &raw mut instances[0].mesh;
        call!(airglow_relight_add_mesh, relight, null(), 10, vectors.as_ptr(), 160, mesh);
        instances[1].mesh = instances[0].mesh;
        frame.struct_size = size_of::<AirglowRelightFrame>() as u32;
        (frame.instances, frame.instance_count) = (instances.as_ptr(), 2);
        let plan = |format: AirglowPlanFormat, frame: &AirglowRelightFrame| {
            text(|text| call!(airglow_relight_plan, relight, &raw const *frame, format as u32, text))
        };
        let dark = plan(AirglowPlanFormat::Text, &frame);
        assert!(dark.contains("left out") && dark.contains("no environment"), "{dark}");
        frame.light = AirglowLight::Environment as u32;
        let said =
            refused!(InvalidArgument, airglow_relight_prepare, relight, &raw const frame, &raw mut prepared);
        assert!(prepared.is_null() && said.contains("airglow_relight_set_environment"), "{said}");
        let texels = [1f32; 24];
        call!(airglow_relight_set_environment, relight, 4, 2, texels.as_ptr());
        refused!(InvalidArgument, airglow_relight_set_environment, relight, 0, 2, texels.as_ptr());
        let poisoned = [f32::NAN; 24];
        refused!(InvalidArgument, airglow_relight_set_environment, relight, 4, 2, poisoned.as_ptr());
        let lit = plan(AirglowPlanFormat::Text, &frame);
        assert!(lit.contains("relight colours") && lit.contains("relight environment rows"), "{lit}");
        let json: serde_json::Value = serde_json::from_str(&plan(AirglowPlanFormat::Json, &frame)).unwrap();
        assert!(json["steps"].as_array().unwrap().len() >= 5, "{json}");
        call!(airglow_relight_prepare, relight, &raw const frame, &raw mut prepared);
        // SAFETY: zero bytes are valid rows.
        let (mut rows, mut ranges): ([AirglowResourceInfo; 16], [AirglowResultRange; 2]) =
            unsafe { zeroed() };
        let mut count = rows.len();
        call!(airglow_prepared_resources, prepared, rows.as_mut_ptr(), &raw mut count);
        let results = AirglowRelightResource::Results as u32;
        let row = rows[..count].iter().find(|row| row.resource == results).unwrap();
        // The second instance begins at a multiple of 64 vertices.
        assert_eq!((row.bytes, row.origin, row.is_image), (16 * 74, AirglowOrigin::Host as u32, 0));
        assert_eq!(row.usage, vk::BufferUsageFlags::STORAGE_BUFFER.as_raw());
        // SAFETY: names live as long as the prepared frame.
        assert_eq!(unsafe { CStr::from_ptr(row.name) }, c"relight results");
        count = ranges.len();
        call!(airglow_relight_ranges, prepared, ranges.as_mut_ptr(), &raw mut count);
        assert_eq!((ranges[0].size, ranges[1].offset, ranges[1].vertex_count), (160, 1024, 10));
        let light = [0.0, 0.0, 1.0, 1.0];
        call!(airglow_relight_turn, prepared, light.as_ptr(), instances.as_ptr(), 2);
        refused!(InvalidArgument, airglow_relight_turn, prepared, light.as_ptr(), instances.as_ptr(), 1);
        call!(airglow_relight_show, prepared, 1, 0, 0);
        let half = [[0.5f64; 3]; 4];
        call!(airglow_relight_set_filter, prepared, half.as_ptr().cast(), 4);
        let said = refused!(InvalidArgument, airglow_relight_set_filter, prepared, half.as_ptr().cast(), 3);
        assert!(said.contains("bands"), "{said}");
        call!(airglow_relight_set_lit, prepared, 0);
        refused!(InvalidArgument, airglow_relight_show, prepared, 2, 1, 1);
        refused!(InvalidArgument, airglow_relight_show, prepared, 1, 2, 1);
        refused!(InvalidArgument, airglow_relight_set_lit, prepared, 2);
        refused!(InvalidArgument, airglow_prepared_record, prepared, 0, null(), 0);
        let memory = text(|text| call!(airglow_context_memory_json, made.context, text));
        assert!(memory.contains("\"owner\":\"relight\""), "{memory}");
        call!(airglow_relight_drop_mesh, relight, instances[0].mesh);
        refused!(InvalidArgument, airglow_relight_drop_mesh, relight, instances[0].mesh);
        drop(made);
        // SAFETY: it is not used again; nothing was submitted.
        unsafe { airglow_prepared_drop(prepared) };
    });
}
