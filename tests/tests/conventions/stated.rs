//! What CONVENTIONS.md states, in code: a change of sign, order or unit anywhere fails here first.

use std::f64::consts::PI;

use airglow_math::sh::{self, rotation::Rotation, zonal};
use airglow_math::sphere::cube::{self, Face};
use airglow_math::sphere::equirect;
use airglow_scene::{Camera, LightKind, Projection};
use glam::{DQuat, DVec3, Mat4, Vec4};

/// Prints both values when they differ by more than `tolerance`.
fn assert_near(what: &str, actual: f64, expected: f64, tolerance: f64) {
    let error = (actual - expected).abs();
    assert!(error <= tolerance, "{what}: {actual} but the convention says {expected} (off by {error:e})");
}

fn basis(order: usize, direction: DVec3) -> Vec<f64> {
    let mut values = vec![0.0; sh::coefficient_count(order)];
    sh::evaluate(order, direction, &mut values).expect("the order is within range");
    values
}

#[test]
fn harmonics_are_indexed_and_signed_as_in_directxmath() {
    let direction = DVec3::new(0.48, -0.6, 0.64);
    let DVec3 { x, y, z } = direction;
    let values = basis(3, direction);
    let expected = [
        (0.25 / PI).sqrt(),
        -(0.75 / PI).sqrt() * y,
        (0.75 / PI).sqrt() * z,
        -(0.75 / PI).sqrt() * x,
        (3.75 / PI).sqrt() * x * y,
        -(3.75 / PI).sqrt() * y * z,
        (0.3125 / PI).sqrt() * (3.0 * z * z - 1.0),
        -(3.75 / PI).sqrt() * x * z,
        (0.9375 / PI).sqrt() * (x * x - y * y),
    ];
    for (index, (actual, expected)) in values.iter().zip(expected).enumerate() {
        assert_near(&format!("Y_{index}"), *actual, expected, 1e-14);
    }
    assert_eq!(sh::index(2, -1), 5, "i = l(l+1)+m");
    assert_eq!(sh::coefficient_count(6), 36, "order n has n^2 coefficients");
}

#[test]
fn rotating_by_q_moves_the_function_with_q() {
    let q = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 0.7);
    let coefficients: Vec<f64> = (0..16).map(|i| f64::from(i) * 0.13 - 0.8).collect();
    let mut rotated = vec![0.0; 16];
    Rotation::from_quaternion(4, q).unwrap().apply(&coefficients, &mut rotated).unwrap();
    let direction = DVec3::new(0.1, -0.7, 0.3).normalize();
    let value = sh::reconstruct(4, &rotated, direction).unwrap();
    let truth = sh::reconstruct(4, &coefficients, q.inverse() * direction).unwrap();
    assert_near("rotated(s) = f(q^-1 s)", value, truth, 1e-12);
}

#[test]
fn irradiance_of_constant_radiance_is_pi_and_a_white_surface_returns_it() {
    let factors = zonal::clamped_cosine(3).unwrap();
    let radiance = [1.0 * (4.0 * PI).sqrt(), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let mut irradiance = [0.0; 9];
    zonal::convolve(&factors, &radiance, &mut irradiance).unwrap();
    let at = sh::reconstruct(3, &irradiance, DVec3::Y).unwrap();
    assert_near("irradiance under radiance 1", at, PI, 1e-12);

    // The transfer vector of eq. 5.14 divides by pi: a white surface under radiance 1 leaves radiance 1.
    let mesh = airglow_bake::Mesh {
        name: "point",
        positions: &[[0.0; 3]],
        normals: &[[0.0, 1.0, 0.0]],
        indices: &[],
    };
    let baked = airglow_bake::unshadowed(&mesh, Mat4::IDENTITY, 3).unwrap();
    let colour: f64 = baked.transfer.coefficients.iter().zip(radiance).map(|(t, l)| f64::from(*t) * l).sum();
    assert_near("white surface under radiance 1", colour, 1.0, 1e-6);
}

#[test]
fn equirectangular_maps_look_down_minus_z_with_plus_y_on_top() {
    for (u, v, expected) in [
        (0.5, 0.5, DVec3::NEG_Z),
        (0.75, 0.5, DVec3::X),
        (0.25, 0.5, DVec3::NEG_X),
        (0.0, 0.5, DVec3::Z),
        (0.5, 0.0, DVec3::Y),
        (0.5, 1.0, DVec3::NEG_Y),
    ] {
        let direction = equirect::direction(u, v);
        assert_near(&format!("direction of ({u}, {v})"), direction.distance(expected), 0.0, 1e-15);
    }
    let total: f64 = (0..7).map(|row| 5.0 * equirect::texel_solid_angle(5, 7, row).unwrap()).sum();
    assert_near("solid angle of all texels", total, 4.0 * PI, 1e-12);
}

#[test]
fn cube_faces_have_vulkans_order_and_orientation() {
    // Vulkan 1.3, 16.5.4: for each face the axes that s (right) and t (down) follow.
    let expected = [
        (DVec3::X, DVec3::NEG_Z, DVec3::NEG_Y),
        (DVec3::NEG_X, DVec3::Z, DVec3::NEG_Y),
        (DVec3::Y, DVec3::X, DVec3::Z),
        (DVec3::NEG_Y, DVec3::X, DVec3::NEG_Z),
        (DVec3::Z, DVec3::X, DVec3::NEG_Y),
        (DVec3::NEG_Z, DVec3::NEG_X, DVec3::NEG_Y),
    ];
    for (face, (centre, right, down)) in Face::ALL.into_iter().zip(expected) {
        for (u, v) in [(0.5, 0.5), (0.9, 0.5), (0.5, 0.8)] {
            let truth = (centre + (2.0 * u - 1.0) * right + (2.0 * v - 1.0) * down).normalize();
            let actual = cube::direction(face, u, v);
            assert_near(&format!("{face:?} at ({u}, {v})"), actual.distance(truth), 0.0, 1e-15);
        }
    }
    // The four-arctangent form: a face of one texel is a sixth of the sphere.
    assert_near("one-texel face", cube::texel_solid_angle(1, 0, 0).unwrap(), 4.0 * PI / 6.0, 1e-14);
}

#[test]
fn cameras_look_down_minus_z_and_depth_is_zero_near() {
    let camera = Camera {
        name: "test".to_owned(),
        transform: Mat4::IDENTITY,
        projection: Projection::Perspective { vertical_angle: 1.0, near: 0.5, far: Some(10.0), aspect: None },
    };
    let clip = camera.clip_from_view(1.0) * Vec4::new(0.0, 0.1, -0.5, 1.0);
    assert_near("depth at the near plane", f64::from(clip.z / clip.w), 0.0, 1e-6);
    assert!(clip.w > 0.0, "a point down -Z is in front of the camera, w = {}", clip.w);
    assert!(clip.y < 0.0, "+Y is up: clip y points down in Vulkan, y = {}", clip.y);
    let far = camera.clip_from_view(1.0) * Vec4::new(0.0, 0.0, -10.0, 1.0);
    assert_near("depth at the far plane", f64::from(far.z / far.w), 1.0, 1e-6);
}

#[test]
fn candela_are_watts_per_steradian() {
    let scene = airglow_scene::load(std::path::Path::new(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../assets/mesh/lights_room.glb"
    )))
    .unwrap();
    let intensity = scene.lights.iter().find_map(|light| match light.kind {
        LightKind::Point { intensity, .. } => Some(intensity),
        _ => None,
    });
    let expected = [60.0, 0.85 * 60.0, 0.6 * 60.0];
    for (channel, (actual, expected)) in intensity.unwrap().into_iter().zip(expected).enumerate() {
        assert_near(&format!("60 candela, channel {channel}"), f64::from(actual), expected, 1e-4);
    }
}
