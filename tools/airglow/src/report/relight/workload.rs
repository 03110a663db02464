//! What the report lights: the largest mesh of a scene, baked at every quality, with its truth.

use std::time::Instant;

use airglow_bake::{Occluders, Probe, Settings, Silent, Threads, bake};
use airglow_math::sphere::equirect::Projector;
use airglow_scene::{Environment, Scene, Shadow};
use glam::Mat4;

use crate::failure::{Failure, Outcome};
use crate::host::environment_samples::EnvironmentSamples;
use crate::host::{holes, transfer, truth};
use crate::output::Output;

/// The highest order with kernels: what is measured is truncated from it.
pub const FULL_ORDER: usize = 6;

/// How much is measured.
#[derive(Clone, Debug)]
pub struct Effort {
    /// Rays for each vertex of the bakes compared, ascending; the last is the converged setting.
    pub rays: Vec<u32>,
    /// Rays for each vertex of the ray-traced truth.
    pub truth_rays: u32,
    /// Vertices that times are measured at.
    pub vertices: usize,
    /// Rounds of interleaved timing.
    pub rounds: super::super::interleave::Rounds,
}

impl Effort {
    /// What a committed report is made with, or with `quick` enough to see the shape of the curves.
    pub fn new(quick: bool) -> Self {
        use super::super::interleave::Rounds;
        if quick {
            let rounds = Rounds { warm_up: 2, measured: 9 };
            return Self { rays: vec![64, 256, 1024], truth_rays: 512, vertices: 100_000, rounds };
        }
        let rays = vec![64, 256, 1024, 4096, 16_384];
        Self { rays, truth_rays: 8192, vertices: 100_000, rounds: Rounds { warm_up: 3, measured: 41 } }
    }
}

/// A bake of the mesh.
pub struct Bake {
    /// Rays for each vertex.
    pub rays: u32,
    /// Vertex-major vectors of [`FULL_ORDER`].
    pub vectors: Vec<f32>,
    /// Wall-clock milliseconds it took, hierarchy not included.
    pub milliseconds: f64,
    /// Rays a second.
    pub rays_per_second: f64,
}

/// The mesh, its light and its bakes.
pub struct Workload {
    /// In a sentence.
    pub description: String,
    /// Vertices of the mesh.
    pub vertex_count: usize,
    /// One for each of the effort's numbers of rays.
    pub bakes: Vec<Bake>,
    /// The environment's f64 coefficients at [`FULL_ORDER`], turned into the world.
    pub light: Vec<[f64; 3]>,
    /// Ray-traced colours of the vertices.
    pub truth: Vec<[f32; 3]>,
}

impl Workload {
    /// Bakes and traces. The mesh is baked in world space with the shadows that the scene asks for.
    pub fn new(scene: &Scene, effort: &Effort, output: &Output) -> Outcome<Self> {
        let Some(environment) = &scene.environment else {
            return Err(Failure::input("the scene has no environment; name one with --environment"));
        };
        let size = |number: &usize| scene.meshes[scene.instances[*number].mesh].positions.len();
        let Some(number) = (0..scene.instances.len()).max_by_key(size) else {
            return Err(Failure::input("the scene has nothing to light"));
        };
        let holes = holes::of_scene(scene);
        let placed = |number| transfer::occluder(scene, number, scene.instances[number].transform, &holes);
        let blockers: Vec<_> = match scene.quality.shadow {
            Shadow::Unshadowed => Vec::new(),
            Shadow::Object => vec![placed(number)],
            Shadow::Scene => (0..scene.instances.len()).map(placed).collect(),
        };
        let occluders = Occluders::build(&blockers).map_err(Failure::input)?;
        let transform = scene.instances[number].transform;
        let mesh = transfer::bake_mesh(scene, number);
        let bakes = effort
            .rays
            .iter()
            .map(|&rays| bake_mesh(&mesh, transform, &occluders, rays, output))
            .collect::<Outcome<_>>()?;
        let probe = Probe::new(&mesh, transform, &occluders, f32::INFINITY).map_err(Failure::input)?;
        let samples = EnvironmentSamples::new(environment).map_err(Failure::input)?;
        Ok(Self {
            description: format!(
                "{} ({} vertices, {} triangles cast shadows) under {} ({} x {})",
                mesh.name,
                mesh.positions.len(),
                blockers.iter().map(|blocker| blocker.indices.len() / 3).sum::<usize>(),
                environment
                    .file
                    .file_name()
                    .map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
                environment.width,
                environment.height
            ),
            vertex_count: mesh.positions.len(),
            bakes,
            light: project(environment)?,
            truth: truth::colours(mesh.name, &probe, &samples, effort.truth_rays, output),
        })
    }

    /// The bake with most rays.
    pub fn converged(&self) -> Outcome<&Bake> {
        self.bakes.last().ok_or_else(|| Failure::work("no bake was made"))
    }

    /// The first `order`^2 coefficients of the light.
    pub fn light_of(&self, order: usize) -> &[[f64; 3]] {
        &self.light[..order * order]
    }
}

/// The first `order`^2 coefficients of vectors of [`FULL_ORDER`].
pub fn truncate(vectors: &[f32], order: usize) -> Vec<f32> {
    let rows = vectors.chunks_exact(FULL_ORDER * FULL_ORDER);
    rows.flat_map(|row| row[..order * order].iter().copied()).collect()
}

/// The vectors repeated until there are `vertices` of them.
pub fn tile(vectors: &[f32], order: usize, vertices: usize) -> Vec<f32> {
    vectors.iter().copied().cycle().take(vertices * order * order).collect()
}

/// Not from the cache: the time is part of what is reported.
fn bake_mesh(
    mesh: &airglow_bake::Mesh<'_>,
    transform: Mat4,
    occluders: &Occluders<'_>,
    rays: u32,
    output: &Output,
) -> Outcome<Bake> {
    output.say(format!("baking {} with {rays} rays a vertex", mesh.name));
    let threads = Threads::new(std::thread::available_parallelism().map_or(1, usize::from));
    let settings = Settings { order: FULL_ORDER, rays, ..Settings::default() };
    let start = Instant::now();
    let baked = bake(mesh, transform, occluders, &settings, &threads, &mut Silent).map_err(Failure::input)?;
    Ok(Bake {
        rays,
        vectors: baked.transfer.coefficients,
        milliseconds: 1e3 * start.elapsed().as_secs_f64(),
        rays_per_second: baked.stats.rays_per_second(),
    })
}

/// The environment in the world, exactly.
fn project(environment: &Environment) -> Outcome<Vec<[f64; 3]>> {
    let projector =
        Projector::new(FULL_ORDER, environment.width, environment.height).map_err(Failure::input)?;
    let light = projector.project(&environment.pixels).map_err(Failure::input)?;
    let turn = environment.rotation.as_dquat();
    airglow::relight::reference::light(FULL_ORDER, &light, turn, glam::DQuat::IDENTITY)
        .map_err(Failure::input)
}
