//! The functions as a host calls them.

use std::mem::zeroed;
use std::ptr::{null, null_mut};

use airglow_radiance::Radiance;

use super::conformance::*;
use super::lights::*;
use super::plan::airglow_radiance_plan;
use super::prepared::*;
use super::receiver::*;
use super::*;
use crate::access::AirglowResourceInfo;
use crate::plan::AirglowPlanFormat;
use crate::prepared::*;
use crate::testing::{call, refused, sizes_refused, text, with_host};
use crate::through_c::ThroughC;

#[test]
fn null_is_refused_everywhere() {
    refused!(InvalidArgument, airglow_radiance_require, null_mut(), null());
    refused!(InvalidArgument, airglow_radiance_new, null(), null(), null_mut());
    refused!(InvalidArgument, airglow_radiance_receiver_new, null(), null(), null_mut());
    refused!(InvalidArgument, airglow_radiance_prepare, null(), null(), null(), null_mut());
    refused!(InvalidArgument, airglow_radiance_set, null(), null());
    refused!(InvalidArgument, airglow_radiance_forget_samples, null());
    refused!(InvalidArgument, airglow_radiance_health_new, null(), null_mut());
    refused!(InvalidArgument, airglow_radiance_plan, null(), null(), null(), 0, null_mut());
    // SAFETY: null is nothing.
    unsafe {
        airglow_radiance_drop(null_mut());
        airglow_radiance_receiver_drop(null_mut());
    }
}

#[test]
fn what_no_receiver_and_no_light_is_is_refused_and_named() {
    with_host(&Radiance::requirements(&rust_settings()), |host| {
        let mut made = ThroughC::adopt(host, ask).unwrap();
        let (context, mut other) = (made.context, null_mut());
        let good = settings();
        for (wrong, word) in [
            (AirglowRadianceSettings { order: 7, ..good }, "order"),
            (AirglowRadianceSettings { without_gradients: 2, ..good }, "without_gradients"),
            (AirglowRadianceSettings { face: 4096, ..good }, "face"),
            (AirglowRadianceSettings { rays: 3, ..good }, "rays"),
            (AirglowRadianceSettings { oracle: 3, ..good }, "oracle"),
            (AirglowRadianceSettings { limit: u32::MAX, ..good }, "limit"),
            (AirglowRadianceSettings { stride: 9, ..good }, "stride"),
            (AirglowRadianceSettings { bound: f64::NAN, ..good }, "bound"),
            (AirglowRadianceSettings { hidden: 2.0, ..good }, "hidden"),
            (AirglowRadianceSettings { keep: f64::NAN, ..good }, "keep"),
            (AirglowRadianceSettings { without_closed_forms: 2, ..good }, "without_closed_forms"),
        ] {
            let said =
                refused!(InvalidArgument, airglow_radiance_new, context, &raw const wrong, &raw mut other);
            assert!(said.contains(word) && other.is_null(), "{said}");
        }
        sizes_refused(&good, |wrong| {
            refused!(InvalidStruct, airglow_radiance_new, context, wrong, &raw mut other)
        });
        let passes = in_c(&mut made, &[]).unwrap();
        receivers_are_refused(passes.0);
        let prepared = prepare(&mut made, passes).unwrap();
        lights_are_refused(passes, prepared);
    });
}

fn receivers_are_refused(radiance: *const AirglowRadiance) {
    let ground = crate::checks::ground();
    let good = AirglowRadianceReceiverInfo {
        struct_size: size_of::<AirglowRadianceReceiverInfo>() as u32,
        positions: ground.as_ptr().cast(),
        vertex_count: ground.len(),
        // SAFETY: zero bytes are a valid description.
        ..unsafe { zeroed() }
    };
    let part = |first, count, turn| AirglowRadiancePart { first, count, turn };
    let (past, last, squeezed) =
        (part(200, 101, [0.0; 9]), part(u32::MAX, 2, [0.0; 9]), part(0, 9, [0.5; 9]));
    let mut other = null_mut();
    for (wrong, word) in [
        (AirglowRadianceReceiverInfo { positions: null(), ..good }, "positions"),
        (AirglowRadianceReceiverInfo { vertex_count: 0, ..good }, "receiver"),
        (AirglowRadianceReceiverInfo { vertex_count: usize::MAX, ..good }, "positions"),
        (AirglowRadianceReceiverInfo { transfer_count: 1, ..good }, "transfer"),
        (
            AirglowRadianceReceiverInfo { transfer: ground.as_ptr().cast(), transfer_count: 7, ..good },
            "transfer",
        ),
        (AirglowRadianceReceiverInfo { part_count: 1, ..good }, "parts"),
        (AirglowRadianceReceiverInfo { parts: &raw const past, part_count: 1, ..good }, "part"),
        (AirglowRadianceReceiverInfo { parts: &raw const last, part_count: 1, ..good }, "parts"),
        (AirglowRadianceReceiverInfo { parts: &raw const squeezed, part_count: 1, ..good }, "orthogonal"),
    ] {
        let (wrong, to) = (&raw const wrong, &raw mut other);
        let said = refused!(InvalidArgument, airglow_radiance_receiver_new, radiance, wrong, to);
        assert!(said.contains(word) && other.is_null(), "{said}");
    }
    sizes_refused(&good, |wrong| {
        refused!(InvalidStruct, airglow_radiance_receiver_new, radiance, wrong, &raw mut other)
    });
}

fn lights_are_refused(
    (radiance, receiver): (*mut AirglowRadiance, *mut AirglowRadianceReceiver),
    prepared: *const AirglowPrepared,
) {
    let emitters = emitters();
    let good = lights(&emitters);
    let dark = AirglowEmitter { radiance: [-1.0; 3], ..emitters.0 };
    let hollow = AirglowEmitterSphere { radius: f64::NAN, ..emitters.1 };
    let distant = [f32::NAN; 27];
    for (wrong, word) in [
        (AirglowRadianceLights { emitters: &raw const dark, ..good }, "triangle 0"),
        (AirglowRadianceLights { emitters: null(), ..good }, "lights.emitters"),
        (AirglowRadianceLights { emitter_count: usize::MAX, ..good }, "lights.emitters"),
        (AirglowRadianceLights { spheres: &raw const hollow, ..good }, "sphere 0"),
        (AirglowRadianceLights { sphere_count: 1 << 40, ..good }, "lights.spheres"),
        (AirglowRadianceLights { distant_count: 9, ..good }, "lights.distant"),
        (AirglowRadianceLights { distant: distant.as_ptr(), distant_count: 8, ..good }, "distant light"),
        (AirglowRadianceLights { distant: distant.as_ptr(), distant_count: 9, ..good }, "distant light 0"),
    ] {
        let said = refused!(InvalidArgument, airglow_radiance_set, prepared, &raw const wrong);
        assert!(said.contains(word), "{said}");
    }
    sizes_refused(&good, |wrong| refused!(InvalidStruct, airglow_radiance_set, prepared, wrong));
    call!(airglow_radiance_set, prepared, &raw const good);
    call!(airglow_radiance_forget_samples, receiver);
    let plan = |lights: &AirglowRadianceLights| {
        let format = AirglowPlanFormat::Text as u32;
        text(|text| call!(airglow_radiance_plan, radiance, receiver, &raw const *lights, format, text))
    };
    assert!(plan(&good).contains("radiance samples"), "{}", plan(&good));
    let none = AirglowRadianceLights { emitter_count: 0, sphere_count: 0, ..good };
    assert!(plan(&none).contains("no emitter gives light"), "{}", plan(&none));
    let mut left_out = prepared.cast_mut();
    call!(airglow_radiance_prepare, radiance, receiver, &raw const none, &raw mut left_out);
    assert!(left_out.is_null(), "nothing is left to record");
    // SAFETY: zero bytes are a valid row.
    let (mut rows, mut count) = ([unsafe { zeroed::<AirglowResourceInfo>() }; 32], 32);
    call!(airglow_prepared_resources, prepared, rows.as_mut_ptr(), &raw mut count);
    // 9 coefficients of three floats for each of 300 vertices.
    assert_eq!((rows[0].resource, rows[0].bytes), (AirglowRadianceResource::VertexLight as u32, 300 * 108));
    let said = refused!(InvalidArgument, airglow_prepared_record, prepared, 1, null(), 0);
    assert!(said.contains("radiance light of part 0"), "{said}");
}
