//! Hosts that differ in axes, hand, units, depth, jitter and pre-exposure, with positions relative to the camera or not,
//! get the same picture.

use airglow_fog::{Camera, Cone, Fog, Frame, Light, Medium, Prepared, Settings, View};
use airglow_math::World;
use airglow_math::world::Depth;
use airglow_tests::device::{Fixture, fixture_with};
use airglow_tests::hosts::hosts;
use glam::DVec3;

use crate::images::{Images, PIXELS, SIZE};

const EYE: DVec3 = DVec3::new(0.4, 1.7, 8.0);
const EDGES: [f64; 4] = [-0.8, 0.8, -0.45, 0.45];
/// Of the projection, pixels.
const JITTER: [f64; 2] = [0.25, -0.4];

/// Metres to the surface of a pixel along the view's axis, 1 m to 40 m; none in the upper third.
fn distance(pixel: usize) -> Option<f64> {
    let share = (pixel * 7 % PIXELS) as f64 / PIXELS as f64;
    (pixel >= PIXELS / 3).then(|| 40_f64.powf(share))
}

/// What the host says of the one scene there is.
fn view(world: World) -> View {
    let units = |metres: f64| metres / world.metres_per_unit;
    let point = |place: DVec3| world.host_position(place);
    let [right, up, forward] = [DVec3::X, DVec3::Y, DVec3::NEG_Z].map(|axis| world.host_direction(axis));
    let camera = Camera { position: point(EYE), right, up, forward, edges: EDGES };
    let lamp =
        |place: DVec3, intensity| Light { radius: units(0.1), ..Light::point(point(place), intensity) };
    let cone = Cone {
        direction: world.host_direction(DVec3::new(0.3, -1.0, -0.2).normalize()),
        inner: 0.3,
        outer: 0.6,
    };
    let spot = lamp(DVec3::new(-2.0, 4.0, 1.0), [10.0, 20.0, 60.0]);
    let lights = vec![
        lamp(DVec3::new(1.0, 3.0, 0.0), [40.0, 30.0, 15.0]),
        Light { cone: Some(cone), range: Some(units(30.0)), ..spot },
    ];
    View { world, camera, medium: Medium::with_visibility(60.0), lights, environment: None }
}

/// The picture without pre-exposure.
fn picture(fixture: &Fixture, world: World) -> Vec<f64> {
    let radiance = |pixel: usize| (world.pre_exposure * (0.1 + 0.01 * (pixel % 90) as f64)) as f32;
    let depth = |pixel: usize| {
        let units = distance(pixel).map(|metres| metres / world.metres_per_unit);
        units.map_or(world.depth.farthest(), |units| world.depth.value(units)) as f32
    };
    let images = Images::of(fixture, SIZE, radiance, depth);
    let fog = Fog::new(fixture.context(), Settings { bound: 0.0, ..Settings::default() }).unwrap();
    let frame = Frame { size: SIZE, surface: (), depth: (), target: Some(()), view: view(world) };
    let Prepared::Pass(pass) = fog.prepare(&frame).unwrap() else { panic!("there is a medium") };
    let colours = images.draw(fixture, &pass);
    colours.iter().flat_map(|texel| texel[..3].iter().map(|c| f64::from(*c) / world.pre_exposure)).collect()
}

#[test]
fn differently_set_hosts_get_the_same_picture() {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let mut worlds = hosts().map(|world| World { jitter: JITTER, ..world }).to_vec();
    // Relative to the camera; and with depth reversed to a far plane.
    worlds.push(World { origin: worlds[1].host_position(EYE), ..worlds[1] });
    let depth = Depth { reversed: true, near: 0.2, far: Some(60.0), ..Depth::default() };
    worlds.push(World { depth, ..worlds[2] });
    let pictures: Vec<_> = worlds.iter().map(|world| picture(&fixture, *world)).collect();
    let brightest = pictures[0].iter().copied().fold(0.0, f64::max);
    for (host, theirs) in pictures.iter().enumerate().skip(1) {
        let differences = pictures[0].iter().zip(theirs).map(|(ours, theirs)| (ours - theirs).abs());
        let worst = differences.fold(0.0, f64::max) / brightest;
        println!("host {host}: {worst:.1e} of the brightest pixel");
        assert!(worst < 1e-3, "host {host}: {worst:e}");
    }
    let straight = picture(&fixture, World::default());
    let moved = pictures[0].iter().zip(&straight).any(|(a, b)| (a - b).abs() > 1e-3 * brightest);
    assert!(moved, "jitter moves the picture");
}
