//! What each instance of a scene is lit with: transfer vectors, baked once and then read from the cache.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use airglow_bake::cache::{CacheKey, Precision, Source, bake_cached};
use airglow_bake::{
    BelowHorizon, LightFrame, Mesh, Occluder, Report, Settings, Threads, Transfer, unshadowed,
};
use airglow_scene::{Instance, Quality, Scene, Shadow};
use glam::{DQuat, Mat4};
use serde::Serialize;

use super::holes;
use crate::failure::{Failure, Outcome};
use crate::files::file_name;
use crate::output::Output;

/// The transfer of a whole scene.
#[derive(Debug)]
pub struct SceneTransfer {
    /// Different transfers; instances of one mesh may share one.
    pub transfers: Vec<Transfer>,
    /// For each instance of the scene.
    pub instances: Vec<InstanceTransfer>,
    /// How each transfer came to be.
    pub accounts: Vec<Account>,
    /// The spheres of what moves.
    #[cfg(all(feature = "relight", feature = "shadow"))]
    pub spheres: Vec<super::spheres::InstanceSpheres>,
    /// The radiance pass's tree over all vertices, once it is built; for plans alone it is not.
    #[cfg(all(feature = "relight", feature = "radiance"))]
    pub tree: Option<airglow::radiance::Hierarchy>,
    /// Whether the pass is to count bad texels of the environment.
    pub health: bool,
}

/// Which transfer lights an instance.
#[derive(Clone, Copy, Debug)]
pub struct InstanceTransfer {
    /// Index into [`SceneTransfer::transfers`].
    pub transfer: usize,
    /// World from the space the transfer is in, mirrored or not: the identity for a bake in world space.
    pub rotation: DQuat,
    /// Whether that space is mirrored through its origin before it is turned.
    pub inverted: bool,
    /// Whether the transfer is in world space.
    #[cfg_attr(
        not(any(feature = "shadow", feature = "normals")),
        expect(dead_code, reason = "only shadows and normal maps ask")
    )]
    pub in_world: bool,
    /// Whether the instance moves by itself: then it is lit by its normals, and no transfer is baked.
    pub moves: bool,
}

/// What a bake took.
#[derive(Clone, Debug, Serialize)]
pub struct Account {
    /// Mesh, or mesh and instance.
    pub name: String,
    /// Vertices baked.
    pub vertices: usize,
    /// Triangles that cast shadows on it.
    pub occluders: usize,
    /// `cache`, `baked` with the reason, or `closed form`.
    pub source: String,
    /// Rays traced in this run.
    pub rays: u64,
    /// Rays a second, all threads; 0 if none were traced.
    pub rays_per_second: f64,
    /// The cache file, if there is one.
    pub file: Option<PathBuf>,
}

/// One bake to make: a mesh in some space, and what blocks its rays there.
struct Job<'a> {
    /// Nothing static shadows it: it has the closed form.
    open: bool,
    name: String,
    mesh: Mesh<'a>,
    transform: Mat4,
    occluders: Vec<Occluder<'a>>,
}

impl Job<'_> {
    /// Of a closed form, before any ray.
    fn account(&self) -> Account {
        Account {
            name: self.name.clone(),
            vertices: self.mesh.positions.len(),
            occluders: self.occluders.iter().map(|occluder| occluder.indices.len() / 3).sum(),
            source: "closed form".to_owned(),
            rays: 0,
            rays_per_second: 0.0,
            file: None,
        }
    }
}

/// Bakes what `quality` asks for, or reads it from `cache`.
pub fn of_scene(scene: &Scene, quality: &Quality, cache: &Path, output: &Output) -> Outcome<SceneTransfer> {
    let holes = holes::of_scene(scene);
    let (jobs, instances) = jobs(scene, quality.shadow, &holes);
    let mut result = SceneTransfer {
        transfers: Vec::new(),
        instances,
        accounts: Vec::new(),
        #[cfg(all(feature = "relight", feature = "shadow"))]
        spheres: super::spheres::of_scene(scene, cache, output)?,
        #[cfg(all(feature = "relight", feature = "radiance"))]
        tree: None,
        health: false,
    };
    for (index, job) in jobs.iter().enumerate() {
        let seen = is_seen(scene, &result.instances, index).then_some(BelowHorizon::Mean);
        let (transfer, account) = bake(job, quality, seen, cache, output)?;
        result.transfers.push(transfer);
        result.accounts.push(account);
    }
    Ok(result)
}

/// Transfer of the shapes that [`of_scene`] would give, without a ray: as if nothing cast a shadow. For plans, which do
/// not depend on what is in it.
pub fn unbaked(scene: &Scene) -> Outcome<SceneTransfer> {
    let none: Vec<_> = scene.instances.iter().map(|_| None).collect();
    let (jobs, instances) = jobs(scene, scene.quality.shadow, &none);
    let order = scene.quality.order as usize;
    let mut result = SceneTransfer {
        transfers: Vec::new(),
        instances,
        accounts: Vec::new(),
        #[cfg(all(feature = "relight", feature = "shadow"))]
        spheres: super::spheres::unfitted(scene)?,
        #[cfg(all(feature = "relight", feature = "radiance"))]
        tree: None,
        health: false,
    };
    for job in &jobs {
        let baked = unshadowed(&job.mesh, job.transform, order).map_err(Failure::input)?;
        result.transfers.push(baked.transfer);
        result.accounts.push(job.account());
    }
    Ok(result)
}

/// Vertices whose vectors [`of_scene`] would give the device, and vertices of all instances.
pub fn vertex_counts(scene: &Scene) -> [u64; 2] {
    let none: Vec<_> = scene.instances.iter().map(|_| None).collect();
    let (jobs, instances) = jobs(scene, scene.quality.shadow, &none);
    let drawn = scene.instances.iter().map(|instance| scene.meshes[instance.mesh].positions.len() as u64);
    let baked = (0..jobs.len()).filter(|job| !instances.iter().any(|lit| lit.moves && lit.transfer == *job));
    [baked.map(|job| jobs[job].mesh.positions.len() as u64).sum(), drawn.sum()]
}

/// One job for each mesh that its instances can share in object space, and one for each other instance.
fn jobs<'a>(
    scene: &'a Scene,
    shadow: Shadow,
    holes: &'a [Option<holes::Holes<'a>>],
) -> (Vec<Job<'a>>, Vec<InstanceTransfer>) {
    let mut jobs: Vec<Job<'a>> = Vec::new();
    let mut shared: Vec<Option<usize>> = vec![None; scene.meshes.len()];
    let mut instances = Vec::with_capacity(scene.instances.len());
    for (number, instance) in scene.instances.iter().enumerate() {
        let moves = scene.moves(number);
        let frame = if shadow == Shadow::Scene || moves { None } else { shared_frame(instance) };
        let transfer = match (frame, shared[instance.mesh]) {
            (Some(_), Some(job)) => job,
            (Some(_), None) => {
                jobs.push(object_job(scene, number, shadow, holes));
                shared[instance.mesh] = Some(jobs.len() - 1);
                jobs.len() - 1
            }
            (None, _) => {
                jobs.push(world_job(scene, number, shadow, holes));
                jobs.len() - 1
            }
        };
        let in_world = frame.is_none();
        let (rotation, inverted) = frame.unwrap_or((DQuat::IDENTITY, false));
        instances.push(InstanceTransfer { transfer, rotation, inverted, in_world, moves });
    }
    (jobs, instances)
}

/// World from object, where that is a rotation, a mirroring and a uniform scale; a stretched instance is baked in
/// world space instead.
fn shared_frame(instance: &Instance) -> Option<(DQuat, bool)> {
    let frame = LightFrame::of_instance(instance.transform).ok()?;
    Some((frame.world_to_object.conjugate(), frame.inverted))
}

/// The mesh of an instance as the bake takes it.
pub fn bake_mesh(scene: &Scene, instance: usize) -> Mesh<'_> {
    let mesh = &scene.meshes[scene.instances[instance].mesh];
    Mesh { name: &mesh.name, positions: &mesh.positions, normals: &mesh.normals, indices: &mesh.indices }
}

/// An instance as something that casts shadows, placed by `transform`.
pub fn occluder<'a>(
    scene: &'a Scene,
    instance: usize,
    transform: Mat4,
    holes: &'a [Option<holes::Holes<'a>>],
) -> Occluder<'a> {
    let mask = holes[instance].as_ref().map(holes::Holes::mask);
    Occluder { mask, ..bake_mesh(scene, instance).occluder_at(transform) }
}

/// Instances that cast baked shadows, the first ones. Near emitters cast none: they may move, and their light comes from
/// where their shadow would be.
pub fn casters(scene: &Scene) -> usize {
    #[cfg(all(feature = "radiance", feature = "relight"))]
    let casters = super::emitters::surfaces(scene);
    #[cfg(not(all(feature = "radiance", feature = "relight")))]
    let casters = scene.instances.len();
    casters
}

fn object_job<'a>(
    scene: &'a Scene,
    instance: usize,
    shadow: Shadow,
    holes: &'a [Option<holes::Holes<'a>>],
) -> Job<'a> {
    let mesh = bake_mesh(scene, instance);
    let occluders = match shadow {
        Shadow::Unshadowed => Vec::new(),
        Shadow::Object | Shadow::Scene => vec![occluder(scene, instance, Mat4::IDENTITY, holes)],
    };
    let open = shadow == Shadow::Unshadowed;
    Job { open, name: mesh.name.to_owned(), mesh, transform: Mat4::IDENTITY, occluders }
}

fn world_job<'a>(
    scene: &'a Scene,
    instance: usize,
    shadow: Shadow,
    holes: &'a [Option<holes::Holes<'a>>],
) -> Job<'a> {
    let placed = |number: usize| occluder(scene, number, scene.instances[number].transform, holes);
    let open = shadow == Shadow::Unshadowed || scene.moves(instance);
    let occluders = match shadow {
        _ if open => Vec::new(),
        Shadow::Unshadowed | Shadow::Object => vec![placed(instance)],
        // What moves casts its shadow in the frame.
        Shadow::Scene => (0..casters(scene)).filter(|number| !scene.moves(*number)).map(placed).collect(),
    };
    let mesh = bake_mesh(scene, instance);
    let (mesh_name, instance_name) = (mesh.name, &scene.instances[instance].name);
    let name = if mesh_name == instance_name {
        mesh_name.to_owned()
    } else {
        format!("{mesh_name} at {instance_name}")
    };
    Job { open, name, mesh, transform: scene.instances[instance].transform, occluders }
}

/// Whether the visibility of a transfer's vertices is asked for beside it: for the radiance that meets their normal maps.
fn is_seen(scene: &Scene, instances: &[InstanceTransfer], transfer: usize) -> bool {
    #[cfg(all(feature = "normals", feature = "relight"))]
    let gathers = |number| super::needed::incident_on(scene, number);
    #[cfg(not(all(feature = "normals", feature = "relight")))]
    let gathers = |_| scene.instances.is_empty();
    (0..instances.len()).any(|number| instances[number].transfer == transfer && gathers(number))
}

fn bake(
    job: &Job<'_>,
    quality: &Quality,
    visibility: Option<BelowHorizon>,
    cache: &Path,
    output: &Output,
) -> Outcome<(Transfer, Account)> {
    let mut account = job.account();
    let order = quality.order as usize;
    if job.open {
        let baked = unshadowed(&job.mesh, job.transform, order).map_err(Failure::input)?;
        return Ok((baked.transfer, account));
    }
    let settings = Settings { order, rays: quality.rays, visibility, ..Settings::default() };
    let key = CacheKey::new(&job.mesh, job.transform, &job.occluders, &settings).to_hex();
    std::fs::create_dir_all(cache).map_err(|error| Failure::file(cache, "making the cache folder", error))?;
    let file = cache.join(format!("{}-{}.safetensors", file_name(&job.name), &key[..16]));
    let bar = output.progress(&job.name, account.vertices as u64, "vertices");
    let mut progress = |report: &Report| {
        bar.set_position(report.vertices as u64);
        ControlFlow::Continue(())
    };
    let threads = Threads::new(std::thread::available_parallelism().map_or(1, usize::from));
    let (transfer, source) = bake_cached(
        &file,
        Precision::F32,
        &job.mesh,
        job.transform,
        &job.occluders,
        &settings,
        &threads,
        &mut progress,
    )
    .map_err(Failure::work)?;
    bar.finish_and_clear();
    account.source = match &source {
        Source::Cache => "cache".to_owned(),
        Source::Baked { stats, miss } => {
            account.rays = stats.rays;
            account.rays_per_second = stats.rays_per_second();
            format!("baked ({miss})")
        }
    };
    account.file = Some(file);
    Ok((transfer, account))
}
