//! The pass: its kernels, tables and meshes, kept from frame to frame.

use std::collections::BTreeMap;

use airglow_gpu::ash::vk;
use airglow_gpu::requirements::{FormatNeed, Limit, LimitNeed};
use airglow_gpu::{Buffer, Context, Health, Label, Location, Requirements};
use airglow_graph::BufferDesc;
use airglow_math::World;

use crate::RelightError;
use crate::control::Projected;
use crate::envelope::{LightPipelines, Pipelines, VertexPipeline, kernels_of, of_light, of_vertices};
use crate::kernels::Source;
use crate::mesh::{Mesh, MeshId, Meshes};
use crate::pack::{ChunkLimits, RECTANGLE_FORMAT, RECTANGLE_WIDTH, VERTEX_ALIGNMENT, chunk_vertices};
use crate::resident::{OWNER, Resident};
use crate::settings::{LightKind, Method, Output, Settings};
use crate::tables::{MapTables, tensor};

/// What is counted with [`Settings::health`]: texels of the environment with a component that is not finite, which counts
/// as 0, and others with one below 0, which is taken as it is.
pub const HEALTH: [&str; 2] = ["relight texels not finite", "relight texels negative"];

/// Tables for environments of one size, and what was projected with them.
pub(crate) struct Map {
    pub width: u32,
    pub height: u32,
    pub columns: Resident,
    pub rows: Resident,
    pub projected: Projected,
}

/// Relighting by precomputed radiance transfer.
///
/// Made once for a device and [`Settings`]; holds pipelines, meshes and tables, and no frame.
pub struct Relight {
    pub(crate) settings: Settings,
    pub(crate) world: World,
    pub(crate) chunk_vertices: u32,
    pub(crate) meshes: Meshes,
    /// Those that the settings can need.
    pub(crate) vertex_pipelines: BTreeMap<Source, VertexPipeline>,
    /// Those that were prepared, needed or not.
    pub(crate) pipeline_count: usize,
    /// With uniform light only.
    pub(crate) light_pipelines: Option<LightPipelines>,
    /// With uniform light and [`Settings::health`] only.
    pub(crate) health: Option<Health>,
    /// With uniform light only: the environment's coefficients.
    pub(crate) environment_light: Option<Buffer>,
    pub(crate) map: Option<Map>,
    /// Where some kernel reads it.
    pub(crate) tensor: Option<Resident>,
}

impl Relight {
    /// What a device must offer for these settings, to be joined to those of other passes before it is made.
    #[must_use]
    pub fn requirements(settings: &Settings) -> Requirements {
        let mut requirements = Requirements::engine();
        requirements.limits.push(LimitNeed {
            limit: Limit::ComputeSharedMemorySize,
            at_least: 16 * 128 * (2 * settings.order.max(1) as u64 - 1),
            why: "sums of a row of the environment",
        });
        let usage = match settings.method {
            Method::Compute => vk::FormatFeatureFlags::VERTEX_BUFFER,
            Method::Fragment => {
                vk::FormatFeatureFlags::VERTEX_BUFFER | vk::FormatFeatureFlags::COLOR_ATTACHMENT
            }
        };
        requirements.formats.push(FormatNeed { format: RECTANGLE_FORMAT, usage, why: "vertex colours" });
        if settings.check().is_err() {
            return requirements;
        }
        kernels_of(settings)
            .iter()
            .fold(requirements, |all, made| all.with_descriptors(&made.kernel.binding_descs()))
    }

    /// Makes the kernels and tables that `settings` need on a device.
    ///
    /// # Errors
    /// [`RelightError::Order`] and [`RelightError::Settings`] for what has no kernel, [`RelightError::Gpu`] when the
    /// device refuses.
    pub fn new(context: &Context, settings: Settings) -> Result<Self, RelightError> {
        Self::with_chunk_limits(context, settings, &chunk_limits(context))
    }

    /// The same with pipelines that were made before, on whatever thread: none is made here or while recording.
    ///
    /// # Errors
    /// [`RelightError::Envelope`] for settings outside the envelope they were prepared for; else as [`Relight::new`].
    pub fn with_pipelines(
        context: &Context,
        settings: Settings,
        pipelines: &Pipelines,
    ) -> Result<Self, RelightError> {
        Self::make(context, settings, &chunk_limits(context), pipelines)
    }

    /// The same with limits below the device's, for memory budgets and tests of chunking.
    ///
    /// # Errors
    /// As [`Relight::new`]; [`RelightError::Settings`] when no chunk fits the limits.
    pub fn with_chunk_limits(
        context: &Context,
        settings: Settings,
        limits: &ChunkLimits,
    ) -> Result<Self, RelightError> {
        settings.check()?;
        Self::make(context, settings, limits, &Pipelines::prepare(context, settings.into())?)
    }

    fn make(
        context: &Context,
        settings: Settings,
        limits: &ChunkLimits,
        pipelines: &Pipelines,
    ) -> Result<Self, RelightError> {
        settings.check()?;
        pipelines.envelope().check(&settings)?;
        let Some(chunk_vertices) = chunk_vertices(&settings, limits, alignment(&settings)) else {
            return Err(RelightError::Settings {
                what: "not even the smallest chunk of vertices fits the storage-buffer range",
                mend: "raise the limit, or lower the order",
            });
        };
        let uniform = settings.light == LightKind::Uniform;
        let light_buffer = || {
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER
                | vk::BufferUsageFlags::UNIFORM_BUFFER
                | vk::BufferUsageFlags::TRANSFER_SRC;
            let desc = BufferDesc { size: 16 * settings.coefficients() as u64, usage };
            context.create_buffer(Label::new(OWNER, "relight environment light"), &desc, Location::Device)
        };
        let tensor = match settings.shadows() {
            true => Some(Resident::new(context, "relight tensor", &tensor(settings.order)?)?),
            false => None,
        };
        let health = match settings.health && uniform {
            true => Some(Health::new(context, &HEALTH)?),
            false => None,
        };
        Ok(Self {
            settings,
            health,
            world: World::default(),
            chunk_vertices,
            meshes: Meshes::default(),
            vertex_pipelines: of_vertices(pipelines, &settings)?,
            light_pipelines: of_light(pipelines, &settings)?,
            pipeline_count: pipelines.count(),
            environment_light: uniform.then(light_buffer).transpose()?,
            map: None,
            tensor,
        })
    }

    /// The settings it was made for.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// States the host's world, in whose axes rotations of light and instances and light as SH RGB come in from the
    /// next frame on, and whose pre-exposure results are multiplied with. Before, it is [`World::default`]. Object
    /// space, and so the bake, is in any axes.
    ///
    /// # Errors
    /// [`RelightError::Math`] for what no host can mean; the world stays then.
    pub fn set_world(&mut self, world: World) -> Result<(), RelightError> {
        world.check()?;
        self.world = world;
        Ok(())
    }

    /// Adds a mesh of `vertices` vertices, in the host's order. `vectors` are vertex-major, order^2 values a vertex:
    /// transfer vectors for colours (1/pi in them, no albedo), static visibility vectors for incident radiance. The
    /// copy to the device becomes part of the next frame that uses the mesh.
    ///
    /// A mesh without vectors is one that nothing static shadows: its instances bring their normals for colours, and
    /// its incident radiance is the light, with the dynamic visibility where there is one.
    ///
    /// # Errors
    /// [`RelightError::Length`], [`RelightError::Values`] with a count for values that are not finite or do not fit
    /// half floats, [`RelightError::Size`] for no vertices, [`RelightError::Settings`], [`RelightError::Gpu`].
    pub fn add_mesh(
        &mut self,
        context: &Context,
        name: &str,
        vertices: u32,
        vectors: Option<&[f32]>,
    ) -> Result<MeshId, RelightError> {
        if vectors.is_none() && self.settings.output == Output::Colour && !self.settings.normals {
            return Err(RelightError::Settings {
                what: "a mesh without vectors has nothing to be lit by",
                mend: "give its vectors, or set Settings::normals and give Instance::normals",
            });
        }
        let mesh = Mesh::new(context, &self.settings, self.chunk_vertices, name, vertices, vectors)?;
        Ok(self.meshes.add(mesh))
    }

    /// Puts a mesh in the place of another, whose memory goes back when no frame in flight can use it. The old id is
    /// refused from now on. On an error the old mesh stays.
    ///
    /// # Errors
    /// As [`Relight::add_mesh`], and [`RelightError::UnknownMesh`].
    pub fn replace_mesh(
        &mut self,
        context: &Context,
        old: MeshId,
        name: &str,
        vertices: u32,
        vectors: Option<&[f32]>,
    ) -> Result<MeshId, RelightError> {
        self.meshes.get(old)?;
        let new = self.add_mesh(context, name, vertices, vectors)?;
        self.meshes.remove(old)?;
        Ok(new)
    }

    /// Drops a mesh; its memory goes back when no frame in flight, and no plan still held, can use it.
    ///
    /// # Errors
    /// [`RelightError::UnknownMesh`].
    pub fn drop_mesh(&mut self, mesh: MeshId) -> Result<(), RelightError> {
        self.meshes.remove(mesh)
    }

    /// The counters of [`HEALTH`], which the host clears before a frame's commands and collects after them, and reads when
    /// that frame is done: `None` without [`Settings::health`], and for light of each vertex. A frame that does not
    /// project the environment counts nothing.
    pub fn health(&mut self) -> Option<&mut Health> {
        self.health.as_mut()
    }

    /// Forgets that the environment was projected: for a host that threw away a recorded frame.
    pub fn forget_environment(&self) {
        if let Some(map) = &self.map {
            map.projected.forget();
        }
    }

    /// The tables for an environment of that size, made on first use and when the size changes.
    pub(crate) fn map(&mut self, context: &Context, width: u32, height: u32) -> Result<&Map, RelightError> {
        let fits = |map: &Map| map.width == width && map.height == height;
        let map = match self.map.take() {
            Some(map) if fits(&map) => map,
            _ => {
                let tables = MapTables::new(self.settings.order, width, height)?;
                let columns = Resident::from_values(context, "relight column table", &tables.columns)?;
                let rows = Resident::from_values(context, "relight row table", &tables.rows)?;
                Map { width, height, columns, rows, projected: Projected::default() }
            }
        };
        Ok(self.map.insert(map))
    }
}

/// What the device lets a binding and a dispatch reach.
fn chunk_limits(context: &Context) -> ChunkLimits {
    let limits = context.limits();
    ChunkLimits {
        storage_range: u64::from(limits.max_storage_buffer_range),
        workgroups: limits.max_compute_work_group_count[0],
    }
}

/// Vertices that chunks and instances are aligned to.
pub(crate) fn alignment(settings: &Settings) -> u32 {
    match settings.method {
        Method::Compute => VERTEX_ALIGNMENT,
        Method::Fragment => RECTANGLE_WIDTH,
    }
}
