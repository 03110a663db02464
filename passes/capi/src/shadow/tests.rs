//! The functions as a host calls them.

use std::ptr::{null, null_mut};

use airglow_shadow::MAX_SPHERES;

use airglow_gpu::ash::vk::Handle;
use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_gpu::{Label, Location, Recorder};
use airglow_graph::{Access, BufferDesc};
use airglow_shadow::spheres::Hierarchy;
use airglow_shadow::{Blockers, Exponential, Settings};
use airglow_tests::conformance::Given;
use airglow_tests::device::{open, stated};

use super::conformance::*;
use super::hierarchy::*;
use super::prepared::*;
use super::settings::AirglowShadowExponential;
use super::*;
use crate::health::*;
use crate::pass::Settings as _;
use crate::plan::AirglowPlanFormat;
use crate::prepared::*;
use crate::testing::{call, refused, sizes_refused, text, with_host};
use crate::through_c::ThroughC;
use crate::through_c::binding;

#[test]
fn null_is_refused_everywhere() {
    refused!(InvalidArgument, airglow_shadow_require, null_mut(), null());
    refused!(InvalidArgument, airglow_shadow_new, null(), null(), null_mut());
    refused!(InvalidArgument, airglow_shadow_receivers_new, null(), null(), null(), 1, null_mut());
    refused!(InvalidArgument, airglow_shadow_prepare, null(), null(), null_mut());
    refused!(InvalidArgument, airglow_shadow_set, null(), null(), 0, null(), null_mut());
    refused!(InvalidArgument, airglow_shadow_counts, null(), 1, null_mut());
    refused!(InvalidArgument, airglow_shadow_plan, null(), 0, null_mut());
    refused!(InvalidArgument, airglow_shadow_set_sets, null(), null(), 0, null(), null_mut());
    refused!(InvalidArgument, airglow_sphere_hierarchy_new, null(), null(), 0, null_mut());
    refused!(InvalidArgument, airglow_shadow_health_new, null(), null_mut());
    refused!(InvalidArgument, airglow_health_clear, null(), 1);
    refused!(InvalidArgument, airglow_health_collect, null(), 1);
    refused!(InvalidArgument, airglow_health_latest, null(), null_mut());
    refused!(InvalidArgument, airglow_prepared_count, null(), null(), 1, null(), 0);
    // SAFETY: null is nothing.
    unsafe {
        airglow_shadow_drop(null_mut());
        airglow_shadow_receivers_drop(null_mut());
        airglow_sphere_hierarchy_drop(null_mut());
        airglow_health_drop(null_mut());
    }
}

#[test]
fn what_no_shadow_is_is_refused_and_named() {
    with_host(&Shadow::requirements(), |host| {
        let mut made = ThroughC::adopt(host, ask).unwrap();
        let (shadow, receivers) = in_c(&mut made).unwrap();
        let (context, mut other) = (made.context, null_mut());
        let good = settings();
        for (wrong, word) in [
            (AirglowShadowSettings { order: 7, ..good }, "order 7"),
            (AirglowShadowSettings { normals: 2, ..good }, "normals"),
            (AirglowShadowSettings { unclamped: 2, ..good }, "unclamped"),
            (AirglowShadowSettings { reach: f64::NAN, ..good }, "reach"),
            (AirglowShadowSettings { window: -1.0, ..good }, "window"),
            (AirglowShadowSettings { clip: 0.9, ..good }, "clip"),
            (AirglowShadowSettings { cut: 2.0, ..good }, "cut"),
            (AirglowShadowSettings { exponential: 5, ..good }, "exponential"),
            (AirglowShadowSettings { exponential: 2, degree: 40, norm: 1.0, ..good }, "degree"),
            (AirglowShadowSettings { exponential: 4, norm: -1.0, ..good }, "norm"),
        ] {
            let said =
                refused!(InvalidArgument, airglow_shadow_new, context, &raw const wrong, &raw mut other);
            assert!(said.contains(word) && other.is_null(), "{said}");
        }
        sizes_refused(&good, |wrong| {
            refused!(InvalidStruct, airglow_shadow_new, context, wrong, &raw mut other)
        });
        let mut more = null_mut();
        let place = [0f32; 3];
        for (positions, count) in [(null(), 1), (place.as_ptr(), 0), (place.as_ptr(), usize::MAX)] {
            let (to, name) = (&raw mut more, null());
            let said =
                refused!(InvalidArgument, airglow_shadow_receivers_new, shadow, name, positions, count, to);
            assert!(said.contains("positions") || said.contains("number of receivers"), "{said}");
        }
        spheres_are_refused(prepare(&mut made, (shadow, receivers)).unwrap());
    });
}

/// Spheres, matrices, records and bindings of a frame.
fn spheres_are_refused(prepared: *const AirglowPrepared) {
    let [good, _] = spheres();
    let negative = AirglowSphere { radius: -1.0, ..good };
    let nowhere = AirglowSphere { center: [f64::NAN; 3], ..good };
    let many = vec![good; MAX_SPHERES + 1];
    let flat = [0.0; 16];
    for (spheres, count, matrix, word) in [
        (&raw const negative, 1, null(), "radius"),
        (&raw const nowhere, 1, null(), "centre"),
        (many.as_ptr(), many.len(), null(), "spheres"),
        (&raw const good, usize::MAX, null(), "spheres"),
        (null(), 1, null(), "spheres"),
        (&raw const good, 1, flat.as_ptr(), "matrix"),
    ] {
        let said =
            refused!(InvalidArgument, airglow_shadow_set, prepared, spheres, count, matrix, null_mut());
        assert!(said.contains(word), "{said}");
    }
    let plan = || text(|text| call!(airglow_shadow_plan, prepared, AirglowPlanFormat::Text as u32, text));
    assert!(plan().contains("shadow visibility"), "{}", plan());
    let mut blocks = 9;
    call!(airglow_shadow_set, prepared, &raw const good, 1, null(), &raw mut blocks);
    assert_eq!(blocks, 1);
    call!(airglow_shadow_set, prepared, null(), 0, null(), &raw mut blocks);
    assert_eq!(blocks, 0);
    assert!(plan().contains("nothing that moves blocks"), "{}", plan());
    let mut counts = AirglowShadowCounts { clusters: 9, open: 9, spheres: 9, clamped: 9 };
    let records = [[0u32, 0], [3, 1]];
    call!(airglow_shadow_counts, records.as_ptr().cast(), 2, &raw mut counts);
    let AirglowShadowCounts { clusters, open, spheres, clamped } = counts;
    assert_eq!([clusters, open, spheres, clamped], [2, 1, 3, 1]);
    refused!(InvalidArgument, airglow_shadow_counts, null(), usize::MAX, &raw mut counts);
    refused!(InvalidArgument, airglow_prepared_record, prepared, 0, null(), 0);
    let said = refused!(InvalidArgument, airglow_prepared_record, prepared, 1, null(), 0);
    assert!(said.contains("shadow positions"), "{said}");
    #[cfg(feature = "relight")]
    {
        let set_lit = crate::relight::prepared::airglow_relight_set_lit;
        let said = refused!(InvalidArgument, set_lit, prepared, 0);
        assert!(said.contains("a frame of shadow: give one of relight"), "{said}");
    }
}

#[test]
fn settings_are_those_of_rust() {
    let of = |exponential: AirglowShadowExponential, degree, norm| {
        let exponential = exponential as u32;
        AirglowShadowSettings { exponential, degree, norm, cut: -1.0, ..settings() }.read().unwrap()
    };
    let rust = |exponential| Settings { exponential, cut: 0.0, ..rust_settings() };
    let horner = Exponential::Horner { degree: 2, norm: 1.5 };
    assert_eq!(of(AirglowShadowExponential::Horner, 2, 1.5), rust(horner));
    assert_eq!(of(AirglowShadowExponential::Series, 4, 0.0), rust(Exponential::Series { degree: 4 }));
    assert_eq!(of(AirglowShadowExponential::OptimalLinear, 0, 0.0), rust(Exponential::OptimalLinear));
    assert_eq!(of(AirglowShadowExponential::Hybrid, 0, 2.0), rust(Exponential::Hybrid { threshold: 2.0 }));
    let older = AirglowShadowSettings { struct_size: 40, exponential: 9, ..settings() };
    // SAFETY: as many bytes as it says.
    let older = unsafe { crate::input::versioned(&raw const older, "settings") }.unwrap();
    assert_eq!(older.read().unwrap(), rust_settings(), "an older header knows no exponential");
}

/// Visibility of the ground under a hierarchy, by C and by Rust; and what was counted of it: one position is not finite.
#[test]
fn hierarchies_give_the_bits_of_rust_and_bad_receivers_are_counted() {
    let open = open(&Shadow::requirements());
    let host = stated(&open, open.device());
    let mut made = ThroughC::adopt(&host, ask).unwrap();
    let passes = in_c(&mut made).unwrap();
    let prepared = prepare(&mut made, passes).unwrap();
    // SAFETY: dropped below, when the device is idle.
    let context = unsafe { open.adopt(1) }.unwrap();
    let set: Vec<_> =
        (0..6).map(|i| AirglowSphere { center: [f64::from(i), 1.5, 3.0], radius: 0.4 }).collect();
    let tree = made.hold(airglow_sphere_hierarchy_drop, |to| {
        crate::through_c::attempt!(airglow_sphere_hierarchy_new, passes.0, set.as_ptr(), set.len(), to)
    });
    let sets = [
        AirglowSphereSet { hierarchy: tree.unwrap(), spheres: set.as_ptr(), sphere_count: set.len() },
        AirglowSphereSet { hierarchy: null(), spheres: set.as_ptr(), sphere_count: 1 },
    ];
    let mut blocks = 0;
    call!(airglow_shadow_set_sets, prepared, sets.as_ptr(), 2, null(), &raw mut blocks);
    assert_eq!(blocks, 1);
    let short = AirglowSphereSet { sphere_count: 5, ..sets[0] };
    let said =
        refused!(InvalidArgument, airglow_shadow_set_sets, prepared, &raw const short, 1, null(), null_mut());
    assert!(said.contains("spheres of the set"), "{said}");
    let health = made
        .hold(airglow_health_drop, |to| crate::through_c::attempt!(airglow_shadow_health_new, passes.0, to));
    let health = health.unwrap();

    let mut ground = crate::checks::ground();
    ground[7][1] = f32::NAN;
    let shadow = Shadow::new(&context, rust_settings()).unwrap();
    let receivers = shadow.receivers(&context, "ground", &crate::checks::ground()).unwrap();
    let buffer = |size: u64, location| {
        let usage = Access::ComputeStorageWrite.buffer_usage() | Access::TransferSource.buffer_usage();
        context.create_buffer(Label::new("host", "buffer"), &BufferDesc { size, usage }, location).unwrap()
    };
    let positions = buffer(12 * 300, Location::Upload);
    positions.write(0, &ground).unwrap();
    let pair = || {
        [receivers.visibility_bytes(ORDER), receivers.record_bytes()]
            .map(|size| buffer(size, Location::Device))
    };
    let (of_c, of_rust) = (pair(), pair());
    let blockers = Blockers::default();
    let spheres = read(&set).unwrap();
    let mut nodes = Hierarchy::new(&spheres, ORDER).unwrap().posed(&spheres).unwrap();
    nodes.push(airglow_shadow::spheres::Node::alone(spheres[0]));
    blockers.set_nodes(&nodes, glam::DMat4::IDENTITY).unwrap();

    let given = [&positions, &of_c[0], &of_c[1]].map(|buffer| Given::Buffer(buffer.clone()));
    let bindings: Vec<_> =
        RESOURCES.into_iter().zip(&given).map(|(number, given)| binding(number, given)).collect();
    let mut frames = FrameLoop::new(&open, &context).unwrap();
    let mut copies = Vec::new();
    for number in 0..2u64 {
        let recorded = frames.frame(FrameSemaphores::default(), |commands| {
            if number > 0 {
                call!(crate::context::airglow_context_begin_frame, made.context, number);
                return Ok(());
            }
            let raw = commands.as_raw();
            call!(airglow_health_clear, health, raw);
            call!(airglow_prepared_record, prepared, raw, bindings.as_ptr(), bindings.len());
            call!(airglow_prepared_count, prepared, health, raw, bindings.as_ptr(), bindings.len());
            call!(airglow_health_collect, health, raw);
            // SAFETY: the loop's command buffer is recording.
            let mut recorder = unsafe { Recorder::new(&context, commands) };
            let bindings = airglow_shadow::Bindings {
                positions: (&positions).into(),
                normals: None,
                visibility: (&of_rust[0]).into(),
                records: (&of_rust[1]).into(),
            };
            shadow.record(&mut recorder, &receivers, &blockers, &bindings)?;
            recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
            for visibility in [&of_c[0], &of_rust[0]] {
                copies.push(recorder.read_back_buffer(visibility)?);
            }
            Ok(())
        });
        recorded.unwrap();
    }
    frames.finish().unwrap();
    let [of_c, of_rust] = [0, 1].map(|at: usize| copies[at].read::<u32>().unwrap());
    assert!(of_c == of_rust, "the bits of Rust");
    let mut counts = AirglowHealthCounts { frame: 9, counted: 9, count: 9, counts: [9; 8] };
    call!(airglow_health_latest, health, &raw mut counts);
    assert_eq!((counts.frame, counts.counted, counts.count), (0, 1, 3));
    assert_eq!(counts.counts[0], 1, "one position: {counts:?}", counts = counts.counts);
    assert_eq!(counts.counts[3..], [0; 5]);
    call!(airglow_prepared_forget, prepared);
    drop((frames, copies));
    drop((given, positions, shadow, receivers, made, context));
    assert!(open.messages().take().is_empty());
}
