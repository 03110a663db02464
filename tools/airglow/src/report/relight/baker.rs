//! The bakes that a report compares: their vectors, their time in turn, and the bytes of their cache files.

use std::time::Instant;

use airglow::relight::Settings as PassSettings;
use airglow_bake::cache::{CacheKey, Precision, store};
use airglow_bake::{Baked, Mesh, Occluders, Settings, Silent, Threads, Transfer, bake};
use glam::Mat4;

use super::effort::Effort;
use super::vectors::{FULL_ORDER, truncate};
use crate::failure::{Failure, Outcome};
use crate::output::Output;
use crate::report::interleave;

/// A bake of the mesh.
pub struct Bake {
    /// Rays for each vertex.
    pub rays: u32,
    /// Vertex-major vectors of [`FULL_ORDER`].
    pub vectors: Vec<f32>,
    /// Wall-clock milliseconds of each round that baked the timed part of the mesh at the default
    /// order, hierarchy not included.
    pub milliseconds: Vec<f64>,
    /// Bytes of the cache file of the vertices lit, at the default order.
    pub file_bytes: u64,
}

/// Where to bake.
pub struct Baker<'a> {
    /// What blocks rays.
    pub occluders: &'a Occluders<'a>,
    /// World from object.
    pub transform: Mat4,
    /// Where progress goes.
    pub output: &'a Output,
}

impl Baker<'_> {
    /// A bake with all threads, not from the cache.
    pub fn bake(&self, mesh: &Mesh<'_>, order: usize, rays: u32, seed: u32) -> Outcome<Baked> {
        let vertices = mesh.positions.len();
        self.output.say(format!("baking {vertices} vertices of {} with {rays} rays each", mesh.name));
        self.run(mesh, &Settings { order, rays, seed, ..Settings::default() })
    }

    /// All of the effort's bakes of `lit`, timed in turn on `timed`.
    pub fn compare(&self, lit: &Mesh<'_>, timed: &Mesh<'_>, effort: &Effort) -> Outcome<Vec<Bake>> {
        let order = PassSettings::default().order;
        let vertices = timed.positions.len();
        self.output.say(format!("timing bakes of {vertices} vertices of {}", timed.name));
        let times = interleave::measure(effort.bake_rounds, effort.rays.len(), |rival| {
            let settings = Settings { order, rays: effort.rays[rival], ..Settings::default() };
            let start = Instant::now();
            self.run(timed, &settings).map(|_| 1e3 * start.elapsed().as_secs_f64())
        })?;
        let one = |(&rays, milliseconds): (&u32, Vec<f64>)| {
            let vectors = self.bake(lit, FULL_ORDER, rays, 0)?.transfer.coefficients;
            let settings = Settings { order, rays, ..Settings::default() };
            let file_bytes = self.file_bytes(lit, &settings, truncate(&vectors, order))?;
            Ok(Bake { rays, vectors, milliseconds, file_bytes })
        };
        effort.rays.iter().zip(times).map(one).collect()
    }

    fn run(&self, mesh: &Mesh<'_>, settings: &Settings) -> Outcome<Baked> {
        let threads = Threads::new(std::thread::available_parallelism().map_or(1, usize::from));
        bake(mesh, self.transform, self.occluders, settings, &threads, &mut Silent).map_err(Failure::input)
    }

    /// Writes the cache file of these vectors and looks how large it is.
    fn file_bytes(&self, mesh: &Mesh<'_>, settings: &Settings, coefficients: Vec<f32>) -> Outcome<u64> {
        let vertex_count = mesh.positions.len();
        let transfer = Transfer { order: settings.order, vertex_count, coefficients, visibility: None };
        let folder = tempfile::tempdir().map_err(Failure::work)?;
        let path = folder.path().join("bake.safetensors");
        let key = CacheKey::new(mesh, self.transform, &[], settings);
        store(&path, &key, Precision::F32, &transfer).map_err(Failure::work)?;
        Ok(std::fs::metadata(&path).map_err(|error| Failure::file(&path, "reading its size", error))?.len())
    }
}
