//! Bakes against closed forms and quadrature.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::common::{Shape, bake_at, placements, relative, widen};
use airglow_bake::{BelowHorizon, Occluder, Settings, unshadowed};
use airglow_math::quadrature::gauss_legendre;
use airglow_math::sh::{evaluate, zonal};
use glam::{DVec3, Mat4, Quat, Vec3};

const BLOCKED: Option<BelowHorizon> = Some(BelowHorizon::Blocked);

/// ∫ weight(cos θ) y(s) over a rectangle of angles about +Z, by Gauss-Legendre quadrature.
#[expect(clippy::unwrap_used, reason = "a test helper")]
fn integral(order: usize, theta: [f64; 2], phi: [f64; 2], weight: impl Fn(f64) -> f64) -> Vec<f64> {
    let nodes = gauss_legendre(48).unwrap();
    let map = |[a, b]: [f64; 2], t: f64| 0.5 * (a + b) + 0.5 * (b - a) * t;
    let area = 0.25 * (theta[1] - theta[0]) * (phi[1] - phi[0]);
    let (mut sum, mut basis) = (vec![0.0; order * order], vec![0.0; order * order]);
    for (t, weight_t) in &nodes {
        for (p, weight_p) in &nodes {
            let ((sin, cos), (sin_p, cos_p)) = (map(theta, *t).sin_cos(), map(phi, *p).sin_cos());
            evaluate(order, DVec3::new(sin * cos_p, sin * sin_p, cos), &mut basis).unwrap();
            let factor = weight_t * weight_p * area * sin * weight(cos);
            sum.iter_mut().zip(&basis).for_each(|(sum, value)| *sum += factor * value);
        }
    }
    sum
}

fn cosine(z: f64) -> f64 {
    z / PI
}

#[test]
fn nothing_blocks_a_plane_and_every_vertex_is_the_closed_form() {
    let plane = Shape::grid(Vec3::new(-1.0, -1.0, 0.0), Vec3::X * 2.0, Vec3::Y * 2.0, 24, Vec3::Z);
    for transform in placements() {
        let settings =
            Settings { order: 6, rays: 256, visibility: Some(BelowHorizon::Mean), ..Settings::default() };
        let baked = bake_at(&plane.mesh(), transform, &[plane.mesh().occluder()], &settings);
        assert_eq!(baked.stats.blocked, 0, "of {} rays under {transform}", baked.stats.rays);
        let exact = unshadowed(&plane.mesh(), transform, 6).unwrap().transfer;
        for vertex in 0..exact.vertex_count {
            let error = relative(baked.transfer.vector(vertex), &widen(exact.vector(vertex)));
            assert!(error < 1e-6, "vertex {vertex}: {error}");
            let mut open = [0.0; 36];
            open[0] = (4.0 * PI).sqrt();
            let error = relative(baked.transfer.visibility_vector(vertex), &open);
            assert!(error < 1e-6, "visibility of vertex {vertex}: {error}");
        }
    }
}

#[test]
fn the_unshadowed_vector_is_quadrature_of_equation_5_14() {
    let vertex = Shape::vertex(Vec3::ZERO, Vec3::Z * 7.0);
    let baked = unshadowed(&vertex.mesh(), Mat4::IDENTITY, 6).unwrap();
    let expected = integral(6, [0.0, FRAC_PI_2], [0.0, TAU], cosine);
    let error = relative(baked.transfer.vector(0), &expected);
    assert!(error < 1e-7, "{:?} for {expected:?}", baked.transfer.vector(0));
    // A white surface under a sky of radiance 1 has colour 1.
    let colour = f64::from(baked.transfer.vector(0)[0]) * (4.0 * PI).sqrt();
    assert!((colour - 1.0).abs() < 1e-7, "{colour}");
}

#[test]
fn a_closed_room_is_black_to_its_last_corner() {
    let room = Shape::room(6);
    for transform in placements() {
        let settings =
            Settings { order: 3, rays: 1024, visibility: Some(BelowHorizon::Mean), ..Settings::default() };
        let baked = bake_at(&room.mesh(), transform, &[room.mesh().occluder()], &settings);
        let (rays, blocked) = (baked.stats.rays, baked.stats.blocked);
        assert_eq!(rays, blocked, "{} of {rays} rays escape under {transform}", rays - blocked);
        let values = baked.transfer.coefficients.iter().chain(baked.transfer.visibility.iter().flatten());
        assert!(values.into_iter().all(|value| *value == 0.0));
    }
}

#[test]
fn a_ball_seen_from_outside_does_not_shadow_itself() {
    let ball = Shape::sphere(48, 24, |_| 1.0);
    for transform in placements().into_iter().take(7) {
        let settings = Settings { order: 2, rays: 256, ..Settings::default() };
        let baked = bake_at(&ball.mesh(), transform, &[ball.mesh().occluder()], &settings);
        assert_eq!(baked.stats.blocked, 0, "of {} rays under {transform}", baked.stats.rays);
    }
}

#[test]
fn a_wall_takes_half_the_hemisphere() {
    let wall = Shape::grid(Vec3::new(1.0, -1e4, -1e4), Vec3::Y * 2e4, Vec3::Z * 2e4, 1, Vec3::NEG_X);
    let vertex = Shape::vertex(Vec3::ZERO, Vec3::Z);
    let settings = Settings { order: 6, rays: 16384, visibility: BLOCKED, ..Settings::default() };
    let baked = bake_at(&vertex.mesh(), Mat4::IDENTITY, &[wall.mesh().occluder()], &settings);
    let half = [FRAC_PI_2, 3.0 * FRAC_PI_2];
    let transfer = integral(6, [0.0, FRAC_PI_2], half, cosine);
    let visibility = integral(6, [0.0, FRAC_PI_2], half, |_| 1.0);
    let error = relative(baked.transfer.vector(0), &transfer);
    let visibility_error = relative(baked.transfer.visibility_vector(0), &visibility);
    println!("transfer {error:.2e}, visibility {visibility_error:.2e}");
    assert!(error < 1e-3, "{:?} for {transfer:?}", baked.transfer.vector(0));
    assert!(visibility_error < 2e-3, "{:?} for {visibility:?}", baked.transfer.visibility_vector(0));
}

/// A ball of angular radius asin(0.6) straight above: everything is zonal.
fn under_a_ball(settings: &Settings, transform: Mat4) -> (Vec<f32>, Vec<f32>) {
    let ball = Shape::sphere(256, 128, |_| 0.6);
    let above = Occluder { transform: Mat4::from_translation(Vec3::Z), ..ball.mesh().occluder() };
    let vertex = Shape::vertex(Vec3::ZERO, Vec3::Z);
    let baked = bake_at(&vertex.mesh(), transform, &[above], settings);
    (baked.transfer.vector(0).to_vec(), baked.transfer.visibility_vector(0).to_vec())
}

#[test]
fn a_ball_overhead_leaves_a_zonal_ring() {
    let ring = [0.6_f64.asin(), FRAC_PI_2];
    let turn = Quat::from_euler(glam::EulerRot::XYZ, 0.9, -0.4, 2.2);
    let normal = turn.as_dquat() * DVec3::Z;
    let turned = |about_z: Vec<f64>| {
        let bands: Vec<f64> = (0..6).map(|l| about_z[l * (l + 1)]).collect();
        let mut out = vec![0.0; 36];
        zonal::rotate_to_direction(&zonal::factors_from_coefficients(&bands).unwrap(), normal, &mut out)
            .unwrap();
        out
    };
    let transfer = turned(integral(6, ring, [0.0, TAU], cosine));
    let full = [0.0, TAU];
    let upper = integral(6, ring, full, |_| 1.0);
    let lower = integral(6, [FRAC_PI_2, PI], full, |_| 1.0);
    // The free share of the cosine-weighted hemisphere is 1 - sin² of the ball's radius.
    for (below, value) in
        [(BelowHorizon::Blocked, 0.0), (BelowHorizon::Visible, 1.0), (BelowHorizon::Mean, 0.64)]
    {
        let settings = Settings { order: 6, rays: 16384, visibility: Some(below), ..Settings::default() };
        let (baked, baked_visibility) =
            under_a_ball(&settings, Mat4::from_rotation_translation(turn, Vec3::splat(3.0)));
        let visibility = turned(upper.iter().zip(&lower).map(|(u, l)| u + value * l).collect());
        let (error, visibility_error) =
            (relative(&baked, &transfer), relative(&baked_visibility, &visibility));
        println!("{below:?}: transfer {error:.2e}, visibility {visibility_error:.2e}");
        assert!(error < 1e-3, "{baked:?} for {transfer:?}");
        assert!(visibility_error < 1e-3, "{baked_visibility:?} for {visibility:?}");
    }
}

/// Low-discrepancy rays against a smooth silhouette: the error falls faster than random sampling's 1/√n.
#[test]
fn the_error_falls_with_the_rays() {
    let ball = Shape::sphere(192, 96, |_| 0.5);
    let beside =
        Occluder { transform: Mat4::from_translation(Vec3::new(0.5, 0.3, 0.9)), ..ball.mesh().occluder() };
    // Many vertices at one place: they differ by the turn of their direction sets.
    let vertices =
        Shape { positions: vec![[0.0; 3]; 48], normals: vec![[0.1, -0.2, 1.0]; 48], indices: vec![] };
    let exact = {
        let settings = Settings { order: 5, rays: 1 << 18, visibility: BLOCKED, ..Settings::default() };
        let one = Shape::vertex(Vec3::ZERO, Vec3::new(0.1, -0.2, 1.0));
        bake_at(&one.mesh(), Mat4::IDENTITY, &[beside], &settings).transfer
    };
    let rms = |rays: u32| {
        let settings = Settings { order: 5, rays, visibility: BLOCKED, ..Settings::default() };
        let baked = bake_at(&vertices.mesh(), Mat4::IDENTITY, &[beside], &settings).transfer;
        let mean =
            |error: &dyn Fn(usize) -> f64| (0..48).map(|v| error(v).powi(2) / 48.0).sum::<f64>().sqrt();
        (
            mean(&|v| relative(baked.vector(v), &widen(exact.vector(0)))),
            mean(&|v| relative(baked.visibility_vector(v), &widen(exact.visibility_vector(0)))),
        )
    };
    let counts = [64_u32, 256, 1024, 4096];
    let errors = counts.map(rms);
    for (count, (transfer, visibility)) in counts.iter().zip(&errors) {
        println!("{count:6} rays: transfer {transfer:.2e}, visibility {visibility:.2e}");
    }
    let slope = |first: f64, last: f64| (last / first).ln() / 64_f64.ln();
    let slopes = [slope(errors[0].0, errors[3].0), slope(errors[0].1, errors[3].1)];
    assert!(slopes.iter().all(|slope| *slope < -0.6), "error ~ rays^{slopes:?}, expected about -0.75");
}
