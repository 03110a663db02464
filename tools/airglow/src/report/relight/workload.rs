//! What the report lights: the largest mesh of a scene, baked at every quality, with its truth.

use airglow_bake::{Mesh, Occluders, Probe};
use airglow_math::sphere::equirect::Projector;
use airglow_scene::{Environment, Scene, Shadow};

use super::baker::{Bake, Baker};
use super::effort::Effort;
use super::subset::Subset;
use super::truth::Truth;
use super::vectors::FULL_ORDER;
use crate::failure::{Failure, Outcome};
use crate::host::environment_samples::EnvironmentSamples;
use crate::host::{holes, transfer};
use crate::output::Output;

/// The mesh, its light and its bakes.
pub struct Workload {
    /// In a sentence.
    pub description: String,
    /// Vertices lit: all of the mesh, or an even part of them.
    pub vertex_count: usize,
    /// Vertices of the part whose bake is timed.
    pub timed_vertices: usize,
    /// One for each of the effort's numbers of rays.
    pub bakes: Vec<Bake>,
    /// Vectors of [`FULL_ORDER`] from two independent halves of the truth's rays, neither the rays of `bakes`.
    pub halves: [Vec<f32>; 2],
    /// The mean of the halves: the converged bake.
    pub converged: Vec<f32>,
    /// Rays a second of a half, all threads.
    pub rays_per_second: f64,
    /// The environment's f64 coefficients at [`FULL_ORDER`], turned into the world.
    pub light: Vec<[f64; 3]>,
    /// Ray-traced colours of the vertices.
    pub truth: Truth,
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
        let whole = transfer::bake_mesh(scene, number);
        let (lit, timed) = (Subset::new(&whole, effort.lit), Subset::new(&whole, effort.timed_bake));
        let transform = scene.instances[number].transform;
        let baker = Baker { occluders: &occluders, transform, output };
        let probe = Probe::new(&lit.mesh(), transform, &occluders, f32::INFINITY).map_err(Failure::input)?;
        let samples = EnvironmentSamples::new(environment).map_err(Failure::input)?;
        let half = |seed| baker.bake(&lit.mesh(), FULL_ORDER, effort.truth_rays / 2, seed);
        let (first, second) = (half(1)?, half(2)?);
        let halves = [first.transfer.coefficients, second.transfer.coefficients];
        let vertex_count = lit.mesh().positions.len();
        Ok(Self {
            description: format!(
                "{}, {} triangles cast shadows, under {} ({} x {})",
                counted(&whole, vertex_count),
                blockers.iter().map(|blocker| blocker.indices.len() / 3).sum::<usize>(),
                environment
                    .file
                    .file_name()
                    .map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
                environment.width,
                environment.height
            ),
            vertex_count,
            timed_vertices: timed.mesh().positions.len(),
            bakes: baker.compare(&lit.mesh(), &timed.mesh(), effort)?,
            converged: halves[0].iter().zip(&halves[1]).map(|(a, b)| 0.5 * (a + b)).collect(),
            halves,
            rays_per_second: first.stats.rays_per_second(),
            light: project(environment)?,
            truth: Truth::trace(whole.name, &probe, &samples, effort.truth_rays, output)?,
        })
    }

    /// The first `order`^2 coefficients of the light.
    pub fn light_of(&self, order: usize) -> &[[f64; 3]] {
        &self.light[..order * order]
    }
}

/// A mesh and its vertices, and how many of them are lit if that is not all.
fn counted(mesh: &Mesh<'_>, lit: usize) -> String {
    let all = mesh.positions.len();
    let part = if lit < all {
        format!(", {lit} of them lit here, in even runs of triangles")
    } else {
        String::new()
    };
    format!("{} ({all} vertices{part})", mesh.name)
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
