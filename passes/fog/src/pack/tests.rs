//! A host's conventions do not show in what the shader gets.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail the test they are called from")]

use airglow_math::World;
use airglow_math::world::Axes;

use super::*;
use crate::light::{Bounds, Cone};
use crate::{Camera, Light, Medium};

const EYE: DVec3 = DVec3::new(3.0, 1.7, 8.0);

/// A view as a host of that world states it, its eye moved by `far`.
fn view(world: World, far: DVec3) -> View {
    let place = |metres: DVec3| world.host_position(metres + far);
    let towards = |direction: DVec3| world.host_direction(direction);
    let camera = Camera {
        position: place(EYE),
        right: towards(DVec3::X),
        up: towards(DVec3::Y),
        forward: towards(DVec3::NEG_Z),
        edges: [-0.8, 0.7, -0.45, 0.5],
    };
    let corners = [DVec3::new(-2.0, 0.0, -5.0), DVec3::new(4.0, 6.0, 9.0)].map(place);
    let unit = world.metres_per_unit;
    let light = Light {
        radius: 0.1 / unit,
        range: Some(30.0 / unit),
        cone: Some(Cone { direction: towards(DVec3::new(0.3, -1.0, 0.2)), inner: 0.2, outer: 0.8 }),
        bounds: Some(Bounds { low: corners[0].min(corners[1]), high: corners[0].max(corners[1]) }),
        ..Light::point(place(DVec3::new(1.0, 3.0, 0.0)), [40.0, 30.0, 15.0])
    };
    View { world, camera, medium: Medium::with_visibility(60.0), lights: vec![light], environment: None }
}

fn assert_same(name: &str, found: &FrameConstants, expected: &FrameConstants) {
    // The coefficients of depth may differ by a factor: what counts is the distance.
    let floats = |constants: &FrameConstants| {
        let [a, b, c, d] = constants.depth;
        let depth = [0.0, 0.3, 0.6, 0.9].map(|depth| (a + b * depth) / (c + d * depth));
        let same = FrameConstants { depth, ..*constants };
        bytemuck::cast_slice::<_, f32>(&[same]).to_vec()
    };
    for (place, (found, expected)) in floats(found).into_iter().zip(floats(expected)).enumerate() {
        let near = (found - expected).abs() <= 1e-6 * expected.abs().max(1.0);
        assert!(near || found.to_bits() == expected.to_bits(), "{name}, float {place}: {found}, {expected}");
    }
}

#[test]
fn a_host_s_axes_units_and_origin_change_nothing() {
    let settings = Settings::default();
    let packed = |view: &View| pack(&settings, view, [64, 48]).unwrap().constants;
    let expected = packed(&view(World::default(), DVec3::ZERO));
    for axes in
        [Axes::Y_UP_LEFT_HANDED, Axes::Z_UP_LEFT_HANDED, Axes::Z_UP_RIGHT_HANDED, Axes::Y_DOWN_RIGHT_HANDED]
    {
        for metres_per_unit in [1.0, 0.01] {
            let mut world = World { axes, metres_per_unit, ..World::default() };
            (world.depth.near, world.depth.far) = (0.1 / metres_per_unit, Some(1000.0 / metres_per_unit));
            world.origin = DVec3::new(5.0, -7.0, 2.0);
            assert_same(
                &format!("{axes:?}, {metres_per_unit} m"),
                &packed(&view(world, DVec3::ZERO)),
                &expected,
            );
        }
    }
    let far = DVec3::new(1e7, -3e6, 5e6);
    assert_same("far from the origin", &packed(&view(World::default(), far)), &expected);
}

#[test]
fn a_jitter_of_a_pixel_shows_what_the_neighbour_showed() {
    let (settings, size) = (Settings::default(), [64, 48]);
    let still = pack(&settings, &view(World::default(), DVec3::ZERO), size).unwrap().constants;
    let world = World { jitter: [1.0, 0.0], ..World::default() };
    let moved = pack(&settings, &view(world, DVec3::ZERO), size).unwrap().constants;
    let ray = |constants: &FrameConstants, column: f32| {
        let [corner, across, _] = constants.direction.map(glam::Vec4::from);
        corner + column / size[0] as f32 * across
    };
    let (found, expected) = (ray(&moved, 11.0), ray(&still, 10.0));
    assert!((found - expected).length() < 1e-6, "{found} instead of {expected}");
}
