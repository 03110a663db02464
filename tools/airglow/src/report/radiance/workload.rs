//! What the report lights: the vertices of a scene, their transfer and emitters, and the truths of their colours.

use std::ops::ControlFlow;

use airglow::math::sh::rotation::Rotation;
use airglow::radiance::gpu::bench::Bench;
use airglow::radiance::gpu::{LightShape, TexelSettings, Texels};
use airglow::radiance::{Hierarchy, Triangle};
use airglow_bake::{Occluders, Probe};
use airglow_scene::{Quality, Scene, Shadow};
use glam::{DMat3, DVec3};

use super::truth;
use crate::failure::{Failure, Outcome};
use crate::host::device::Device;
use crate::host::placed::Placed;
use crate::host::transfer::{self, SceneTransfer};
use crate::host::{bake, emitters, holes};
use crate::output::Output;
use crate::report::relight::truth::Truth;

/// The highest order with kernels: what is measured is truncated from it.
pub const FULL_ORDER: usize = 6;
const FULL: usize = FULL_ORDER * FULL_ORDER;

/// Cube maps of the converged samples, one at each vertex.
pub const CONVERGED: (u32, u32) = (32, 4);

/// Cube maps of the curves over bound and limit, whose errors those of rays would hide.
pub const FINE: (u32, u32) = (16, 4);

/// Samples of a dispatch.
const BATCH: usize = 2048;

/// The vertices, their light and their truths.
pub struct Workload {
    /// In a sentence.
    pub description: String,
    /// In the world, metres.
    pub positions: Vec<[f32; 3]>,
    /// Of [`FULL_ORDER`], about the world's axes.
    vectors: Vec<f32>,
    /// Corners are exact in single precision.
    pub emitters: Vec<Triangle>,
    /// Light of [`FULL_ORDER`] sampled at each vertex, as finely as there is, and by [`FINE`] faces.
    finest: Vec<[f32; 3]>,
    fine: Vec<[f32; 3]>,
    /// Ray-traced colours.
    pub truth: Truth,
}

impl Workload {
    /// Bakes, samples and traces.
    pub fn new(
        device: &Device<'_>,
        scene: &Scene,
        cache: &std::path::Path,
        output: &Output,
    ) -> Outcome<Self> {
        let mut emitters = emitters::triangles(&scene.emitters, 0.0);
        for corner in emitters.iter_mut().flat_map(|triangle| &mut triangle.corners) {
            *corner = corner.as_vec3().as_dvec3();
        }
        if !emitters.iter().any(Triangle::emits) {
            return Err(Failure::input("the scene has no emitter; add an [[emitter]] to the scene file"));
        }
        let quality = Quality { order: FULL_ORDER as u32, ..scene.quality };
        let transfer = bake::of_scene(scene, &quality, cache, output)?;
        let (positions, vectors) = in_the_world(scene, &transfer)?;
        output.say(format!("sampling light at {} vertices", positions.len()));
        let finest = sampled(device, &positions, &emitters, CONVERGED)?;
        let fine = sampled(device, &positions, &emitters, FINE)?;
        output.say("tracing the truth");
        let half = |seed| traced(scene, &positions, &emitters, seed);
        let truth = Truth::of_halves(&half(1)?, &half(2)?)?;
        let names: Vec<_> =
            scene.instances[..emitters::surfaces(scene)].iter().map(|i| i.name.as_str()).collect();
        let description = format!(
            "{} ({} vertices) before {} emitters of {} triangles",
            names.join(", "),
            positions.len(),
            scene.emitters.len(),
            emitters.len()
        );
        Ok(Self { description, positions, vectors, emitters, finest, fine, truth })
    }

    /// The tree over the vertices with transfer of an order.
    pub fn tree(&self, order: usize) -> Outcome<Hierarchy> {
        let rows = self.vectors.chunks_exact(FULL);
        let vectors: Vec<f32> = rows.flat_map(|row| &row[..order * order]).copied().collect();
        let tree = Hierarchy::build(&self.positions, &vectors, &mut |_, _| ControlFlow::Continue(()));
        tree.map_err(Failure::work)
    }

    /// A vertex.
    pub fn point(&self, vertex: usize) -> DVec3 {
        DVec3::from(self.positions[vertex].map(f64::from))
    }

    /// Colours of all vertices from light of an order at each.
    pub fn colours(&self, order: usize, light: &[[f32; 3]]) -> Vec<[f32; 3]> {
        self.coloured(order, light, order * order)
    }

    /// The same from the finest samples at each vertex.
    pub fn finest(&self, order: usize) -> Vec<[f32; 3]> {
        self.coloured(order, &self.finest, FULL)
    }

    /// The same from samples of [`FINE`] faces at each vertex.
    pub fn fine(&self, order: usize) -> Vec<[f32; 3]> {
        self.coloured(order, &self.fine, FULL)
    }

    /// `stride` coefficients a vertex, of which those of `order` count.
    fn coloured(&self, order: usize, light: &[[f32; 3]], stride: usize) -> Vec<[f32; 3]> {
        let vertex = |(t, light): (&[f32], &[[f32; 3]])| {
            let sum = |c: usize| -> f64 {
                let products =
                    t[..order * order].iter().zip(light).map(|(t, l)| f64::from(*t) * f64::from(l[c]));
                products.sum()
            };
            [0, 1, 2].map(|c| sum(c) as f32)
        };
        self.vectors.chunks_exact(FULL).zip(light.chunks_exact(stride)).map(vertex).collect()
    }
}

/// Positions and transfer of all surfaces; the vectors turned about the world's axes.
fn in_the_world(scene: &Scene, transfer: &SceneTransfer) -> Outcome<(Vec<[f32; 3]>, Vec<f32>)> {
    let Placed { mut positions, mut vectors, parts } = Placed::new(scene, transfer);
    let surfaces = &parts[..emitters::surfaces(scene)];
    let count = surfaces.last().map_or(0, |part| part.vertices.end as usize);
    positions.truncate(count);
    vectors.truncate(count * FULL);
    for part in surfaces {
        let turn = part.turn.unwrap_or(DMat3::IDENTITY).transpose();
        if turn == DMat3::IDENTITY {
            continue;
        }
        let rotation = Rotation::from_matrix(FULL_ORDER, turn).map_err(Failure::work)?;
        let range = part.vertices.start as usize * FULL..part.vertices.end as usize * FULL;
        let (mut from, mut to) = ([0.0; FULL], [0.0; FULL]);
        for vector in vectors[range].chunks_exact_mut(FULL) {
            from.iter_mut().zip(&*vector).for_each(|(wide, t)| *wide = f64::from(*t));
            rotation.apply(&from, &mut to).map_err(Failure::work)?;
            vector.iter_mut().zip(to).for_each(|(t, wide)| *t = wide as f32);
        }
    }
    Ok((positions, vectors))
}

/// Light of [`FULL_ORDER`] at each vertex, by the device's cube maps of so many texels and rays.
fn sampled(
    device: &Device<'_>,
    positions: &[[f32; 3]],
    emitters: &[Triangle],
    (size, rays): (u32, u32),
) -> Outcome<Vec<[f32; 3]>> {
    let run = device.bench();
    let bench = Bench { context: device.context(), run: &run };
    let shape = LightShape { order: FULL_ORDER, gradients: false };
    let settings = TexelSettings { shape, size, rays };
    let texels = Texels::new(bench.context, settings).map_err(Failure::work)?;
    let mut light = Vec::with_capacity(positions.len() * FULL);
    for batch in positions.chunks(BATCH) {
        let points: Vec<DVec3> = batch.iter().map(|p| DVec3::from(p.map(f64::from))).collect();
        for sample in bench.texels(&texels, emitters, &points).map_err(Failure::work)? {
            light.extend(sample.coefficients.iter().map(|l| l.as_vec3().to_array()));
        }
    }
    Ok(light)
}

/// Colours of all surfaces by rays, shadows cast as the bake casts them.
fn traced(scene: &Scene, positions: &[[f32; 3]], emitters: &[Triangle], seed: u32) -> Outcome<Vec<[f32; 3]>> {
    let holes = holes::of_scene(scene);
    let placed = |number: usize| transfer::occluder(scene, number, scene.instances[number].transform, &holes);
    let mut colours = Vec::with_capacity(positions.len());
    for (number, instance) in scene.instances[..emitters::surfaces(scene)].iter().enumerate() {
        let blockers: Vec<_> = match scene.quality.shadow {
            Shadow::Unshadowed => Vec::new(),
            Shadow::Object => vec![placed(number)],
            Shadow::Scene => (0..transfer::casters(scene)).map(placed).collect(),
        };
        let occluders = Occluders::build(&blockers).map_err(Failure::input)?;
        let mesh = transfer::bake_mesh(scene, number);
        let probe =
            Probe::new(&mesh, instance.transform, &occluders, f32::INFINITY).map_err(Failure::input)?;
        let first = colours.len();
        let points: Vec<DVec3> = positions[first..first + mesh.positions.len()]
            .iter()
            .map(|p| DVec3::from(p.map(f64::from)))
            .collect();
        colours.extend(truth::colours(&probe, &points, emitters, seed));
    }
    Ok(colours)
}
