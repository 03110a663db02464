//! What a bake does with threads, cancellation, instances, masks and faulty input.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::common::{Shape, bake_at};
use airglow_bake::{
    BakeError, BelowHorizon, Executor, LightFrame, Mask, Mesh, Occluder, Occluders, Report, Settings, Silent,
    Threads, bake, unshadowed,
};
use airglow_math::sh::rotation::Rotation;
use glam::{Mat4, Quat, Vec3};

fn settings() -> Settings {
    Settings { rays: 64, visibility: Some(BelowHorizon::Mean), ..Settings::default() }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let shape = Shape::bumpy_sphere(40, 20);
    let occluders = Occluders::build(&[shape.mesh().occluder()]).unwrap();
    let on = |executor: &dyn Executor| {
        bake(&shape.mesh(), Mat4::IDENTITY, &occluders, &settings(), executor, &mut Silent).unwrap()
    };
    let one = on(&Threads::ONE);
    let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    for threads in [2, 3, 8] {
        let many = on(&Threads::new(threads));
        assert_eq!(bits(&one.transfer.coefficients), bits(&many.transfer.coefficients), "{threads} threads");
        assert_eq!(
            one.transfer.visibility.as_deref().map(bits),
            many.transfer.visibility.as_deref().map(bits)
        );
        assert_eq!((one.stats.rays, one.stats.blocked), (many.stats.rays, many.stats.blocked));
        assert_eq!(many.stats.threads, threads);
    }
    // A rebuilt hierarchy and a host's own executor that calls the worker twice in a row.
    struct Twice;
    impl Executor for Twice {
        fn run(&self, worker: &(dyn Fn() + Sync)) {
            worker();
            worker();
        }
        fn threads(&self) -> usize {
            1
        }
    }
    let again = Occluders::build(&[shape.mesh().occluder()]).unwrap();
    let twice = bake(&shape.mesh(), Mat4::IDENTITY, &again, &settings(), &Twice, &mut Silent).unwrap();
    assert_eq!(one.transfer, twice.transfer);
    assert!(one.stats.blocked > 0 && one.stats.blocked < one.stats.rays);
}

#[test]
fn asking_for_visibility_does_not_change_the_transfer() {
    let shape = Shape::bumpy_sphere(20, 10);
    let with = bake_at(&shape.mesh(), Mat4::IDENTITY, &[shape.mesh().occluder()], &settings());
    let alone = Settings { visibility: None, ..settings() };
    let without = bake_at(&shape.mesh(), Mat4::IDENTITY, &[shape.mesh().occluder()], &alone);
    assert_eq!(with.transfer.coefficients, without.transfer.coefficients);
    let other =
        bake_at(&shape.mesh(), Mat4::IDENTITY, &[shape.mesh().occluder()], &Settings { seed: 1, ..alone });
    assert_ne!(other.transfer.coefficients, without.transfer.coefficients);
}

#[test]
fn progress_is_told_and_can_cancel() {
    let shape = Shape::bumpy_sphere(60, 30);
    let occluders = Occluders::build(&[shape.mesh().occluder()]).unwrap();
    let run = |progress: &mut (dyn FnMut(&Report) -> ControlFlow<()> + Send), rays| {
        let settings = Settings { rays, ..settings() };
        let mut progress = |report: &Report| progress(report);
        bake(&shape.mesh(), Mat4::IDENTITY, &occluders, &settings, &Threads::new(2), &mut progress)
    };
    let mut last = None;
    let done = run(&mut |report| (last = Some(*report), ControlFlow::Continue(())).1, 64).unwrap();
    let last = last.unwrap();
    assert_eq!((last.vertices, last.rays), (done.transfer.vertex_count, done.stats.rays));
    assert!(last.rays_per_second() > 0.0 && last.time_left().unwrap().is_zero());
    let mut reports = 0;
    let cancelled = run(&mut |_| (reports += 1, ControlFlow::Break(())).1, 4096);
    assert!(matches!(cancelled, Err(BakeError::Cancelled)), "{cancelled:?}");
    assert_eq!(reports, 1, "reports after the host said stop");
}

/// Colour of each vertex under light coefficients.
fn colours(vectors: &[f32], light: &[f64]) -> Vec<f64> {
    vectors
        .chunks_exact(light.len())
        .map(|t| t.iter().zip(light).map(|(t, l)| f64::from(*t) * l).sum())
        .collect()
}

#[test]
fn instances_share_an_object_space_bake_by_their_light_frame() {
    let shape = Shape::sphere(24, 12, |d| 1.0 + 0.5 * d.y * d.y * d.x);
    let turn = Quat::from_euler(glam::EulerRot::XYZ, 0.3, -1.2, 2.5);
    let light: Vec<f64> = (0..16).map(|i| ((i * i) as f64 * 0.7).sin()).collect();
    for scale in [Vec3::splat(2.5), Vec3::new(-0.4, 0.4, 0.4), -Vec3::ONE] {
        let matrix = Mat4::from_scale_rotation_translation(scale, turn, Vec3::new(5.0, 6.0, 7.0));
        let frame = LightFrame::of_instance(matrix).unwrap();
        let mut object_light = vec![0.0; 16];
        Rotation::from_quaternion(4, frame.world_to_object)
            .unwrap()
            .apply(&light, &mut object_light)
            .unwrap();
        for l in 0..4 {
            object_light[l * l..(l + 1) * (l + 1)].iter_mut().for_each(|value| *value *= frame.band_sign(l));
        }
        let object = unshadowed(&shape.mesh(), Mat4::IDENTITY, 4).unwrap().transfer;
        let world = unshadowed(&shape.mesh(), matrix, 4).unwrap().transfer;
        let pairs = colours(&object.coefficients, &object_light)
            .into_iter()
            .zip(colours(&world.coefficients, &light));
        pairs.for_each(|(object, world)| assert!((object - world).abs() < 2e-6, "{object} for {world}"));
        // With shadows, up to the sampling error of both.
        let settings = Settings { rays: 4096, ..Settings::default() };
        let object = bake_at(&shape.mesh(), Mat4::IDENTITY, &[shape.mesh().occluder()], &settings).transfer;
        let world = bake_at(&shape.mesh(), matrix, &[shape.mesh().occluder()], &settings).transfer;
        let pairs = colours(&object.coefficients, &object_light)
            .into_iter()
            .zip(colours(&world.coefficients, &light));
        pairs.for_each(|(object, world)| assert!((object - world).abs() < 0.01, "{object} for {world}"));
    }
}

#[test]
fn masks_let_light_through_and_reach_ends_rays() {
    let ceiling = Shape::grid(Vec3::new(-1e3, -1e3, 1.0), Vec3::X * 2e3, Vec3::Y * 2e3, 1, Vec3::NEG_Z);
    let vertex = Shape::vertex(Vec3::new(0.5, -0.5, 0.0), Vec3::Z);
    let free_share = |mask: Option<Mask<'_>>, reach: f32| {
        let occluder = Occluder { mask, ..ceiling.mesh().occluder() };
        let settings = Settings { rays: 4096, reach, ..Settings::default() };
        let stats = bake_at(&vertex.mesh(), Mat4::IDENTITY, &[occluder], &settings).stats;
        1.0 - stats.blocked as f64 / stats.rays as f64
    };
    assert!(free_share(None, f32::INFINITY) < 0.01);
    // Within 2 m the ceiling is met above 30 degrees, half of the sine's range: mean of the two densities.
    let within = free_share(None, 2.0);
    let expected = 0.5 * 0.5 + 0.5 * 0.25;
    assert!((within - expected).abs() < 2e-3, "{within} for {expected}");
    let calls = AtomicUsize::new(0);
    let second_only = |triangle: usize, weights: [f32; 2]| {
        calls.fetch_add(1, Ordering::Relaxed);
        assert!(weights.iter().all(|w| (0.0..=1.0).contains(w)) && triangle < 2, "{triangle} {weights:?}");
        triangle == 1
    };
    let half = free_share(Some(Mask { key: b"half", solid: &second_only }), f32::INFINITY);
    assert!((half - 0.5).abs() < 0.01, "{half} through the first triangle of two");
    assert!(calls.into_inner() > 0);
}

#[test]
fn degenerate_input_is_counted_or_refused() {
    let none = Occluders::build(&[]).unwrap();
    let run = |mesh: &Mesh<'_>, settings: &Settings| {
        bake(mesh, Mat4::IDENTITY, &none, settings, &Threads::ONE, &mut Silent)
    };
    // A zero normal, a vertex no triangle uses, a triangle without area, an empty mesh.
    let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [9.0; 3]];
    let normals = [[0.0, 0.0, 1.0], [0.0; 3], [0.0, 0.0, 1e-38], [0.0, 0.0, 3e38]];
    let mesh = Mesh { name: "odd", positions: &positions, normals: &normals, indices: &[0, 1, 2, 0, 1, 1] };
    let baked = run(&mesh, &settings()).unwrap();
    assert_eq!((baked.stats.zero_normals, baked.stats.rays), (1, 3 * 64));
    assert!(baked.transfer.vector(1).iter().chain(baked.transfer.visibility_vector(1)).all(|x| *x == 0.0));
    for (one, other) in baked.transfer.vector(0).iter().zip(baked.transfer.vector(3)) {
        assert!((one - other).abs() < 1e-6, "{one} for a short normal, {other} for a long one");
    }
    assert_eq!(Occluders::build(&[mesh.occluder()]).unwrap().zero_area_triangles(), 1);
    let empty = Mesh { name: "empty", positions: &[], normals: &[], indices: &[] };
    assert!(run(&empty, &settings()).unwrap().transfer.coefficients.is_empty());

    type Case<'a> = (Mesh<'a>, &'a str);
    let nan = [[0.0, f32::NAN, 0.0], [0.0; 3], [0.0; 3], [0.0; 3]];
    let cases: [Case<'_>; 5] = [
        (Mesh { normals: &normals[..3], ..mesh }, "4 positions but 3 normals"),
        (Mesh { indices: &[0, 1], ..mesh }, "2 indices"),
        (Mesh { indices: &[0, 1, 4], ..mesh }, "index 4 at place 2"),
        (Mesh { positions: &nan, ..mesh }, "position of vertex 0 is not finite"),
        (Mesh { normals: &nan, ..mesh }, "normal of vertex 0 is not finite"),
    ];
    for (mesh, message) in cases {
        let error = run(&mesh, &settings()).unwrap_err().to_string();
        assert!(error.contains(message) && error.contains("`odd`"), "{error}");
    }
    let wrong = [
        Settings { order: 0, ..settings() },
        Settings { order: 7, ..settings() },
        Settings { rays: 0, ..settings() },
        Settings { reach: f32::NAN, ..settings() },
        Settings { reach: 0.0, ..settings() },
    ];
    for settings in wrong {
        assert!(matches!(run(&mesh, &settings), Err(BakeError::Setting { .. })), "{settings:?}");
    }
    for matrix in [Mat4::ZERO, Mat4::NAN, Mat4::from_scale(Vec3::new(1.0, 0.0, 1.0))] {
        let refused = Occluders::build(&[mesh.occluder_at(matrix)]).unwrap_err();
        assert!(matches!(refused, BakeError::Transform { .. }), "{refused}");
    }
    let refused = Occluders::build(&[mesh.occluder_at(Mat4::from_scale(Vec3::splat(3e38)) * 9.0)]);
    assert!(refused.is_err(), "{refused:?}");
}

/// Hostile geometry: identical, nested, needle-like and extreme triangles build and are traced.
#[test]
fn awkward_occluders_build() {
    let mut soup = Shape::default();
    let mut add = |points: [[f32; 3]; 3]| {
        let first = soup.positions.len() as u32;
        soup.positions.extend(points);
        soup.normals.extend([[0.0, 0.0, 1.0]; 3]);
        soup.indices.extend([first, first + 1, first + 2]);
    };
    for _ in 0..300 {
        add([[1.0, 1.0, 1.0], [2.0, 1.0, 1.0], [1.0, 2.0, 1.0]]);
    }
    for exponent in -120..120 {
        let size = 2f32.powi(exponent);
        add([[size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]]);
    }
    add([[-1e30, 0.0, 0.0], [1e30, 0.0, 0.0], [0.0, 1e-30, 1e-30]]);
    match Occluders::build(&[soup.mesh().occluder()]) {
        Ok(occluders) => {
            let vertex = Shape::vertex(Vec3::new(1.2, 1.2, 0.9), Vec3::Z);
            let baked =
                bake(&vertex.mesh(), Mat4::IDENTITY, &occluders, &settings(), &Threads::ONE, &mut Silent);
            assert!(baked.unwrap().transfer.coefficients.iter().all(|x| x.is_finite()));
        }
        Err(error) => assert!(matches!(error, BakeError::TooDeep { .. }), "{error}"),
    }
}
