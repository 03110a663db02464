//! `cargo run --release -p airglow-shadow --example figures`: a mesh of 100 000 triangles to 64 spheres; and 40 000
//! receivers of ground and figure under one of 60 spheres, by stage on the device that tests use, then with half and twice
//! as many receivers and spheres.

use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::time::Instant;

use airglow_gpu::{GpuError, Recorder};
use airglow_shadow::families::figure;
use airglow_shadow::spheres::{FitSettings, Hierarchy, fit};
use airglow_shadow::{Bench, Blockers, Settings, Shadow};
use airglow_tests::device::fixture_with;
use glam::{DMat4, DVec3};

/// Runs of a frame; the least of them counts.
const RUNS: usize = 12;

/// A knot of a tube, `2 side^2` triangles.
fn knot(side: u32) -> (Vec<[f32; 3]>, Vec<u32>) {
    let curve = |t: f64| {
        DVec3::new(
            (2.0 + (3.0 * t).cos()) * (2.0 * t).cos(),
            (3.0 * t).sin(),
            (2.0 + (3.0 * t).cos()) * (2.0 * t).sin(),
        )
    };
    let point = |at: u32| {
        let (t, around) =
            (TAU * f64::from(at / side) / f64::from(side), TAU * f64::from(at % side) / f64::from(side));
        let along = (curve(t + 1e-4) - curve(t - 1e-4)).normalize();
        let (u, v) = along.any_orthonormal_pair();
        (curve(t) + 0.45 * (around.cos() * u + around.sin() * v)).as_vec3().to_array()
    };
    let corner = |i: u32, j: u32| (i % side) * side + j % side;
    let quad = |at: u32| {
        let (i, j) = (at / side, at % side);
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        [a, b, c, a, c, d]
    };
    ((0..side * side).map(point).collect(), (0..side * side).flat_map(quad).collect())
}

/// Ground, and a fifth of the receivers on a body that stands on it, with normals.
fn receivers(count: usize) -> [Vec<[f32; 3]>; 2] {
    let side = (0.8 * count as f64).sqrt() as usize;
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    for at in 0..side * side {
        let place = |k: usize| (8.0 * (k as f64 + 0.5) / side as f64 - 4.0) as f32;
        positions.push([place(at % side), 0.0, place(at / side)]);
        normals.push([0.0, 1.0, 0.0]);
    }
    let on_body = count - side * side;
    for at in 0..on_body {
        let (turn, height) = (PI * (1.0 + 5.0_f64.sqrt()) * at as f64, 1.8 * at as f64 / on_body as f64);
        positions.push([(0.3 * turn.cos()) as f32, height as f32, (0.3 * turn.sin()) as f32]);
        normals.push([turn.cos() as f32, 0.0, turn.sin() as f32]);
    }
    [positions, normals]
}

fn main() -> Result<(), Box<dyn Error>> {
    let (positions, indices) = knot(224);
    let begin = Instant::now();
    let set = fit(&positions, &indices, &FitSettings::default(), &mut |_| ())?;
    println!(
        "{} triangles to {} spheres in {:.1} s: {:.2} of volume outside a mesh of {:.2}",
        indices.len() / 3,
        set.spheres.len(),
        begin.elapsed().as_secs_f64(),
        set.outside,
        set.volume
    );
    let fixture = fixture_with(&Shadow::requirements());
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    let bench = Bench { context: fixture.context(), run: &run };
    for order in [4, 6] {
        println!(
            "order {order}: receivers, spheres: pose us, choose us, logarithm us, exponential us; ns a receiver"
        );
        for (receivers, spheres) in [(40_000, 60), (20_000, 60), (80_000, 60), (40_000, 30), (40_000, 120)] {
            frame(&bench, order, receivers, spheres)?;
        }
    }
    Ok(())
}

/// One frame by stage: each is what it adds to the ones before.
fn frame(bench: &Bench<'_>, order: usize, count: usize, spheres: usize) -> Result<(), Box<dyn Error>> {
    let ([positions, normals], body) = (receivers(count), figure(spheres));
    let hierarchy = Hierarchy::new(&body, order)?;
    let blockers = Blockers::default();
    let begin = Instant::now();
    for _ in 0..RUNS {
        blockers.set_nodes(&hierarchy.posed(&body)?, DMat4::IDENTITY)?;
    }
    let pose = begin.elapsed().as_secs_f64() / RUNS as f64;
    let settings = Settings { order, normals: true, ..Default::default() };
    let time = |shadow: &Shadow, blockers: &Blockers| -> Result<f64, Box<dyn Error>> {
        let frame = bench.blocked(shadow, &positions, Some(&normals), blockers, RUNS)?;
        Ok(frame.times[1..].iter().map(|time| time.as_secs_f64()).fold(f64::INFINITY, f64::min))
    };
    let pass = Shadow::new(bench.context, settings)?;
    // Far away: all is chosen from, nothing is reached.
    let far = Blockers::default();
    far.set_nodes(&hierarchy.posed(&body)?, DMat4::from_translation(DVec3::Y * 1e4))?;
    let choose = time(&pass, &far)?;
    let logarithm =
        time(&bench.shadow(settings, airglow_shadow::bench::SphereKernel::Logarithm)?, &blockers)?;
    let whole = time(&pass, &blockers)?;
    println!(
        "  {count:6} {spheres:4}: {:8.0} {:8.0} {:8.0} {:8.0}; {:6.0}",
        1e6 * pose,
        1e6 * choose,
        1e6 * (logarithm - choose),
        1e6 * (whole - logarithm),
        1e9 * whole / count as f64
    );
    Ok(())
}
