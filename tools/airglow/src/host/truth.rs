//! The model's truth: direct light of the environment at each vertex, by rays, without any basis.
//!
//! The colour of a white diffuse surface is 1/pi times the integral of radiance, visibility and clamped cosine.
//! Half of the directions are drawn from the cosine and half from the environment, weighted by the balance
//! heuristic of Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering" (1995); both
//! from a scrambled low-discrepancy sequence of each vertex's own.

use std::f64::consts::PI;

use airglow_bake::{Occluders, Probe};
use airglow_math::sequence;
use airglow_scene::{Scene, Shadow};
use glam::{DQuat, DVec3};

use super::ball::Ball;
use super::environment_samples::EnvironmentSamples;
use super::{holes, transfer};
use crate::failure::{Failure, Outcome};
use crate::output::Output;

/// Colours of all vertices of each instance of a scene, with shadows cast as its bake casts them.
pub fn of_scene(
    scene: &Scene,
    environment: &EnvironmentSamples<'_>,
    samples: u32,
    output: &Output,
) -> Outcome<Vec<Vec<[f32; 3]>>> {
    let holes = holes::of_scene(scene);
    let balls: Vec<Ball> = scene.blockers.iter().map(Ball::new).collect();
    let placed = |number| transfer::occluder(scene, number, scene.instances[number].transform, &holes);
    let everything: Vec<_> = (0..transfer::casters(scene)).map(placed).collect();
    let one = |number| {
        let blocks = |other: &usize| {
            scene.moves(*other)
                || match scene.quality.shadow {
                    Shadow::Unshadowed => false,
                    Shadow::Object => *other == number,
                    Shadow::Scene => true,
                }
        };
        let blockers = (0..everything.len()).filter(blocks).map(|other| everything[other]);
        let blockers: Vec<_> = blockers.chain(balls.iter().map(Ball::occluder)).collect();
        let occluders = Occluders::build(&blockers).map_err(Failure::input)?;
        let instance = &scene.instances[number];
        let mesh = transfer::bake_mesh(scene, number);
        let probe =
            Probe::new(&mesh, instance.transform, &occluders, f32::INFINITY).map_err(Failure::input)?;
        Ok(colours(&instance.name, &probe, environment, samples, 0, output))
    };
    (0..scene.instances.len()).map(one).collect()
}

/// Colours of all vertices of `probe`, whose space is the world, from `samples` rays each (half of each kind).
/// Different seeds give independent estimates.
pub fn colours(
    name: &str,
    probe: &Probe<'_>,
    environment: &EnvironmentSamples<'_>,
    samples: u32,
    seed: u32,
    output: &Output,
) -> Vec<[f32; 3]> {
    let mut colours = vec![[0.0; 3]; probe.vertex_count()];
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let bar = output.progress(&format!("truth: {name}"), colours.len() as u64, "vertices");
    // Small blocks in turn, so that threads end together.
    const BLOCK: usize = 64;
    let blocks = std::sync::Mutex::new(colours.chunks_mut(BLOCK).enumerate());
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some((block, colours)) = next(&blocks) {
                    for (vertex, colour) in (block * BLOCK..).zip(colours.iter_mut()) {
                        *colour = vertex_colour(probe, vertex, environment, samples.div_ceil(2), seed);
                    }
                    bar.inc(colours.len() as u64);
                }
            });
        }
    });
    bar.finish_and_clear();
    colours
}

fn next<T>(blocks: &std::sync::Mutex<impl Iterator<Item = T>>) -> Option<T> {
    blocks.lock().unwrap_or_else(std::sync::PoisonError::into_inner).next()
}

/// `count` directions from the cosine and as many from the environment.
fn vertex_colour(
    probe: &Probe<'_>,
    vertex: usize,
    environment: &EnvironmentSamples<'_>,
    count: u32,
    seed: u32,
) -> [f32; 3] {
    let Some(normal) = probe.normal(vertex) else { return [0.0; 3] };
    let frame = DQuat::from_rotation_arc(DVec3::Z, normal);
    let mut sum = [0.0_f64; 3];
    let mut add = |direction: DVec3| {
        let cosine = direction.dot(normal);
        if cosine <= 0.0 {
            return;
        }
        let (radiance, environment_density) = environment.look_up(direction);
        if radiance == [0.0; 3] || !probe.sees(vertex, direction) {
            return;
        }
        let weight = cosine / PI / (cosine / PI + environment_density);
        sum = [0, 1, 2].map(|c| sum[c] + weight * f64::from(radiance[c]));
    };
    // Two sequences for each vertex; seeds lie far apart.
    let seed = (2 * vertex as u32) ^ seed.rotate_right(2);
    for index in 0..count {
        add(frame * sequence::cosine_hemisphere(sequence::sobol(index, seed)));
        if let Some(direction) = environment.sample(sequence::sobol(index, seed + 1)) {
            add(direction);
        }
    }
    sum.map(|value| (value / f64::from(count)) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use airglow_bake::Mesh;
    use airglow_scene::Environment;
    use glam::{Mat4, Quat};

    /// A uniform sky above a floor gives its own radiance; a half sky hidden by a wall the closed form's half.
    #[test]
    fn a_uniform_sky_gives_its_radiance() {
        let floor = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
        let mesh =
            Mesh { name: "floor", positions: &floor, normals: &[[0.0, 1.0, 0.0]; 3], indices: &[0, 1, 2] };
        let far = 1e6_f32;
        let wall = [[-1e-3, -far, -far], [-1e-3, -far, 3.0 * far], [-1e-3, 3.0 * far, -far]];
        let wall =
            Mesh { name: "wall", positions: &wall, normals: &[[1.0, 0.0, 0.0]; 3], indices: &[0, 1, 2] };
        let rotation = Quat::from_rotation_y(1.0);
        let pixels = vec![[3.0, 1.0, 0.0]; 32];
        let environment =
            Environment { file: "sky".into(), width: 8, height: 4, pixels, rotation, distance: None };
        let samples = EnvironmentSamples::new(&environment).unwrap();
        for (blockers, expected) in
            [(vec![mesh.occluder()], 3.0), (vec![mesh.occluder(), wall.occluder()], 1.5)]
        {
            let occluders = Occluders::build(&blockers).unwrap();
            let probe = Probe::new(&mesh, Mat4::IDENTITY, &occluders, f32::INFINITY).unwrap();
            let found = vertex_colour(&probe, 0, &samples, 4096, 0)[0];
            assert!((found - expected).abs() < 0.01 * expected, "{found} instead of {expected}");
        }
    }
}
