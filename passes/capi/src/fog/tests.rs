//! The functions as a host calls them.

use std::ptr::{null, null_mut};

use airglow_fog::Fog;
use airglow_gpu::ash::vk::{CommandBuffer, Handle};
use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_gpu::{Image, Label, Options};
use airglow_graph::State;
use airglow_tests::conformance::{Given, HostDevice, conform_adopting};
use airglow_tests::device::{open, stated};
use airglow_tests::heap::allocations;

use super::conformance::*;
use super::plan::airglow_fog_plan;
use super::prepared::*;
use super::settings::AirglowFogSettings;
use super::view::AirglowFogView;
use super::*;
use crate::pass::Settings as _;
use crate::plan::AirglowPlanFormat;
use crate::prepared::*;
use crate::status::AirglowStatus;
use crate::testing::{call, refused, sizes_refused, text, with_host};
use crate::through_c::{binding, uses};

#[test]
fn rust_and_c_give_the_same_bits_under_validation() {
    let asked = Fog::requirements(&settings(false).read().unwrap());
    let make = |context: &Context, host: &HostDevice<'_>| Both::new(context, host, false);
    check_lit(&conform_adopting(make, &asked, &Options::default()), true).unwrap();
}

#[test]
fn what_no_view_is_is_refused_and_changes_nothing() {
    with_host(&Fog::requirements(&settings(false).read().unwrap()), |host| {
        let (mut made, fog) = in_c(host, settings(false)).unwrap();
        let lamps = [lamp()];
        let good = view_in_c(&lamps);
        let prepared = prepare(&mut made, fog, &good).unwrap();
        let mut other: *mut AirglowPrepared = null_mut();
        let dark = [lamp(); 65];
        let mut tilted = lamp();
        (tilted.cone_direction, tilted.cone_outer) = ([0.0, -1.0, 0.0], 2.0);
        let wrong = [
            (AirglowFogView { forward: [0.0; 3], ..good }, "camera"),
            (AirglowFogView { albedo: [2.0; 3], ..good }, "albedo"),
            (AirglowFogView { phase: [1.0, 0.0, 0.0, 0.0], ..good }, "phase.g"),
            (AirglowFogView { scale_height: 10.0, ..good }, "height"),
            (AirglowFogView { light_count: 65, lights: dark.as_ptr(), ..good }, "65 lights"),
            (AirglowFogView { lights: &raw const tilted, ..good }, "cone.outer"),
            (AirglowFogView { lights: null(), ..good }, "view.lights"),
        ];
        for (view, word) in &wrong {
            let said = refused!(InvalidArgument, airglow_fog_prepare, fog, 40, 24, view, &raw mut other);
            assert!(said.contains(word) && other.is_null(), "{said}");
            assert_eq!(refused!(InvalidArgument, airglow_fog_set, prepared, view, null_mut()), said);
        }
        let clear = AirglowFogView { extinction: [0.0; 3], ..good };
        let said = refused!(InvalidArgument, airglow_fog_set, prepared, &raw const clear, null_mut());
        assert!(said.contains("declare the frame anew"), "{said}");
        other = prepared;
        call!(airglow_fog_prepare, fog, 40, 24, &raw const clear, &raw mut other);
        assert!(other.is_null(), "nothing is left to record");
        let radiance = [f64::NAN; 27];
        let poisoned = AirglowFogView { environment: radiance.as_ptr(), ..good };
        let said = refused!(InvalidArgument, airglow_fog_set, prepared, &raw const poisoned, null_mut());
        assert!(said.contains("environment") || said.contains("radiance"), "{said}");
        let plan = |view: &AirglowFogView| {
            let format = AirglowPlanFormat::Text as u32;
            text(|text| call!(airglow_fog_plan, fog, 40, 24, &raw const *view, format, text))
        };
        assert!(plan(&clear).contains("the medium has no extinction"), "{}", plan(&clear));
        assert!(plan(&good).contains("fog airlight"), "{}", plan(&good));
        let chosen = AirglowFogSettings { preset: 2, ..settings(false) };
        let mut none = null_mut();
        let said = refused!(InvalidArgument, airglow_fog_new, made.context, &raw const chosen, &raw mut none);
        assert!(said.contains("give 0 to 1"), "{said}");
        refused!(InvalidArgument, airglow_prepared_record, prepared, 0, null(), 0);
        let views = [&raw const clear, &raw const good, &raw const good];
        let several = made.prepare(|to| {
            crate::through_c::attempt!(airglow_fog_prepare_views, fog, 40, 24, views.as_ptr(), 3, to)
        });
        let several = several.unwrap();
        let seen: Vec<_> = uses(several).unwrap().iter().map(|used| (used.resource, used.index)).collect();
        assert_eq!(seen, [(0, 1), (1, 1), (2, 1), (0, 2), (1, 2), (2, 2)], "the first is clear");
        call!(airglow_fog_set_view, several, 2, &raw const good, null_mut());
        for index in [0, 3] {
            refused!(InvalidArgument, airglow_fog_set_view, several, index, &raw const good, null_mut());
        }
        let none: *const *const AirglowFogView = null();
        refused!(InvalidArgument, airglow_fog_prepare_views, fog, 40, 24, none, 0, &raw mut other);
        refused!(InvalidArgument, airglow_fog_prepare_views, fog, 40, 24, none, 1, &raw mut other);
        refused!(InvalidArgument, airglow_fog_health_new, null(), null_mut());
    });
}

#[test]
fn a_lamp_that_enters_allocates_nothing() {
    const WARM_UP: u32 = 10;
    let open = open(&Fog::requirements(&settings(false).read().unwrap()));
    let (mut made, fog) = in_c(&stated(&open, open.device()), settings(false)).unwrap();
    // SAFETY: dropped below, when the device is idle.
    let host = unsafe { open.adopt(1) }.unwrap();
    let images: [Image; 3] =
        images().map(|desc| host.create_image(Label::new("host", "image"), &desc).unwrap());
    let lamps = [lamp(); 2];
    let views = [view_in_c(&lamps), view_in_c(&lamps[..1]), view_in_c(&[])];
    let prepared = prepare(&mut made, fog, &views[0]).unwrap();
    let bindings = RESOURCES.map(|number| binding(number, &Given::Image(images[number.0 as usize].clone())));
    let mut frames = FrameLoop::new(&open, &host).unwrap();
    let mut counted = 0;
    for frame in 0..4 * WARM_UP {
        let recorded = frames.frame(FrameSemaphores::default(), |commands: CommandBuffer| {
            if frame == 0 {
                // SAFETY: the loop's command buffer is recording.
                let mut recorder = unsafe { airglow_gpu::Recorder::new(&host, commands) };
                for (image, (_, access)) in images.iter().zip(airglow_fog::ACCESSES) {
                    recorder.transition(image, State::UNDEFINED, access)?;
                }
            }
            if frame > 0 {
                call!(crate::context::airglow_context_begin_frame, made.context, u64::from(frame));
            }
            let mut counts = AirglowFogCounts { evaluated: 9, left_out: 9, pairs: 99, pairs_left_out: 99 };
            let (view, before) = (&raw const views[frame as usize % 3], allocations());
            call!(airglow_fog_set, prepared, view, &raw mut counts);
            call!(airglow_prepared_record, prepared, commands.as_raw(), bindings.as_ptr(), bindings.len());
            counted += if frame < WARM_UP { 0 } else { allocations() - before };
            // One tile holds the picture.
            let evaluated = 2 - frame % 3;
            assert_eq!((counts.evaluated, counts.left_out), (evaluated, 0));
            assert_eq!((counts.pairs, counts.pairs_left_out), (evaluated, 0));
            Ok::<_, airglow_gpu::GpuError>(())
        });
        recorded.unwrap();
    }
    frames.finish().unwrap();
    drop(frames);
    call!(airglow_prepared_forget, prepared);
    assert_eq!(counted, 0, "allocations after warm-up");
    drop((made, images, host));
    assert!(open.messages().take().is_empty());
}

#[test]
fn what_no_background_is_is_refused_and_named() {
    use super::background::*;
    refused!(InvalidArgument, airglow_fog_background_require, null_mut(), null());
    refused!(InvalidArgument, airglow_fog_background_new, null(), null(), null_mut());
    refused!(InvalidArgument, airglow_fog_background_prepare, null(), null(), null_mut());
    refused!(InvalidArgument, airglow_fog_background_set, null(), null());
    with_host(&conformance::requirements(), |host| {
        let (made, background, prepared) = conformance::in_c(host).unwrap();
        let (good, mut other) = (conformance::settings(), null_mut());
        for wrong in [
            AirglowFogBackgroundSettings { width: 0, ..good },
            AirglowFogBackgroundSettings { height: u32::MAX, ..good },
        ] {
            let (context, wrong) = (made.context, &raw const wrong);
            let said = refused!(InvalidArgument, airglow_fog_background_new, context, wrong, &raw mut other);
            assert!(said.contains("size") && other.is_null(), "{said}");
        }
        sizes_refused(&good, |wrong| {
            refused!(InvalidStruct, airglow_fog_background_new, made.context, wrong, &raw mut other)
        });
        let (good, mut frame) = (conformance::view(), null_mut());
        for (wrong, word) in [
            (AirglowFogBackgroundView { seen: 2, ..good }, "seen"),
            (AirglowFogBackgroundView { optical_distance: [-1.0; 3], ..good }, "optical_distance"),
            (AirglowFogBackgroundView { albedo: [f64::NAN; 3], ..good }, "albedo"),
        ] {
            let wrong = &raw const wrong;
            let said = refused!(InvalidArgument, airglow_fog_background_set, prepared, wrong);
            assert!(said.contains(word), "{said}");
            let prepare = airglow_fog_background_prepare;
            assert_eq!(refused!(InvalidArgument, prepare, background, wrong, &raw mut frame), said);
        }
        sizes_refused(&good, |wrong| refused!(InvalidStruct, airglow_fog_background_set, prepared, wrong));
        // SAFETY: null is nothing.
        unsafe { airglow_fog_background_drop(null_mut()) };
    });
}
