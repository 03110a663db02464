//! What the pass costs by its lamps, and what tiles leave out: frames of 512 x 512 pixels in turn, and the host's part.
//!
//! ```text
//! cargo run --release -p airglow-fog --example tiles
//! ```
//!
//! Milliseconds from submission to the copied picture, the least of all frames; those beside a frame without lamps are what
//! the lamps cost.

use std::f64::consts::FRAC_PI_3;
use std::time::Instant;

use airglow_fog::{Camera, Cone, Fog, FogError, Frame, Light, Medium, Pass, Prepared, Settings, TILE, View};
use airglow_math::World;
use airglow_tests::device::fixture_with;
use glam::DVec3;

#[expect(dead_code, reason = "the example draws another picture than the tests")]
#[path = "../tests/gpu/images.rs"]
mod images;

const SIDE: u32 = 512;
const FRAMES: usize = 11;

fn view(lights: Vec<Light>) -> View {
    let camera = Camera {
        position: DVec3::new(0.0, 1.7, 0.0),
        right: DVec3::X,
        up: DVec3::Y,
        forward: DVec3::NEG_Z,
        edges: [-0.6, 0.6, -0.6, 0.6],
    };
    let medium = Medium::with_visibility(60.0);
    View { world: World::default(), camera, medium, lights, environment: None }
}

/// Lamps along both sides of a street.
fn street(i: u32) -> Light {
    let position =
        DVec3::new(if i.is_multiple_of(2) { -4.0 } else { 4.0 }, 4.0, -3.0 - 2.0 * f64::from(i / 2));
    Light { radius: 0.1, ..Light::point(position, [40.0, 30.0, 15.0]) }
}

/// The same with ranges from 2 to 16 m.
fn ranged(i: u32) -> Light {
    Light { range: Some(f64::from(2_u32 << (i % 4))), ..street(i) }
}

/// The same as spots that shine down.
fn spot(i: u32) -> Light {
    Light { cone: Some(Cone { direction: DVec3::NEG_Y, inner: 0.6, outer: FRAC_PI_3 }), ..street(i) }
}

/// Before the camera, in a range too small for a tile to see more than one of them in.
fn tiny(i: u32) -> Light {
    let position = DVec3::new(0.3 * (f64::from(i) - 32.0), 1.7, -50.0);
    Light { range: Some(1e-5), position, ..street(i) }
}

/// Behind the camera.
fn behind(i: u32) -> Light {
    let lamp = ranged(i);
    Light { position: lamp.position * DVec3::new(1.0, 1.0, -10.0), ..lamp }
}

/// A ground below the horizon, and nothing above it.
fn depth(pixel: usize) -> f32 {
    let depth = World::default().depth;
    let row = (pixel / SIDE as usize) as f64 + 0.5 - 0.5 * f64::from(SIDE);
    let metres = 1.7 * 0.5 * f64::from(SIDE) / (0.6 * row);
    let value = if (0.0..500.0).contains(&metres) { depth.value(metres) } else { depth.farthest() };
    value as f32
}

fn prepared(fog: &Fog, size: [u32; 2], view: &View) -> Result<Option<Pass>, FogError> {
    let frame = Frame { size, surface: (), depth: (), target: Some(()), view: view.clone() };
    Ok(match fog.prepare(&frame)? {
        Prepared::Pass(pass) => Some(pass),
        Prepared::LeftOut(_) => None,
    })
}

fn main() -> Result<(), FogError> {
    let settings = Settings::default();
    let fixture = fixture_with(&Fog::requirements(&settings));
    let fog = Fog::new(fixture.context(), settings)?;
    let images = images::Images::of(&fixture, [SIDE; 2], |_| 0.1, depth);
    let lamps = |of: fn(u32) -> Light, count: u32| view((0..count).map(of).collect());
    let views = [
        ("none", lamps(street, 0)),
        ("1 point", lamps(street, 1)),
        ("8 points", lamps(street, 8)),
        ("16 points", lamps(street, 16)),
        ("32 points", lamps(street, 32)),
        ("64 points", lamps(street, 64)),
        ("8 spots", lamps(spot, 8)),
        ("64 of mixed ranges", lamps(ranged, 64)),
        ("64 of ranges that no ray meets", lamps(tiny, 64)),
        ("64 behind the camera", lamps(behind, 64)),
    ];
    let mut times = [f64::INFINITY; 10];
    for _ in 0..FRAMES {
        for (time, (_, view)) in times.iter_mut().zip(&views) {
            let Some(pass) = prepared(&fog, [SIDE; 2], view)? else { continue };
            let start = Instant::now();
            images.draw(&fixture, &pass);
            *time = time.min(1e3 * start.elapsed().as_secs_f64());
        }
    }
    println!("{SIDE} x {SIDE} pixels, tiles of {TILE}, {} taps, Henyey-Greenstein", 6);
    println!("{:32} {:>9} {:>12} {:>22}", "lamps", "ms", "beside none", "pairs, left out");
    for (time, (name, view)) in times.iter().zip(&views) {
        let Some(pass) = prepared(&fog, [SIDE; 2], view)? else { continue };
        let counts = pass.control.counts();
        let beside = time - times[0];
        println!("{name:32} {time:9.1} {beside:12.1} {:11} {:10}", counts.pairs, counts.pairs_left_out);
    }
    for size in [[SIDE; 2], [1920, 1080]] {
        let view = &views[7].1;
        let Some(pass) = prepared(&fog, size, view)? else { continue };
        let mut least = f64::INFINITY;
        for _ in 0..200 {
            let start = Instant::now();
            pass.control.set(view)?;
            least = least.min(1e6 * start.elapsed().as_secs_f64());
        }
        println!("the host's part, 64 of mixed ranges, {size:?}: {least:.0} us");
    }
    Ok(())
}
