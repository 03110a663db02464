//! The pass on a device: its pipeline and tables, the receivers, and what it records.

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{
    Binding, Buffer, BufferSlice, ComputePipeline, Context, GpuError, Kernel, Label, Location, Recorder,
    Requirements,
};
use airglow_graph::{Access, BufferDesc};
use bytemuck::Pod;

use crate::blockers::{Blockers, Range};
use crate::clusters::{self, CLUSTER};
use crate::envelope::Pipelines;
use crate::kernels::{
    self, CLAMPED, CONTINUED, Kind, LOGARITHM, Program, VISIBILITY_BINDINGS, VisibilityConstants,
};
use crate::polynomial::{ROW, ROWS};
use crate::settings::Settings;
use crate::table::Tables;
use crate::{Exponential, ShadowError, check_order};

/// What the memory report charges this room's buffers to.
const OWNER: &str = "shadow";
/// Workgroups of one dispatch: the least limit of any device.
const GROUPS: u32 = 65_535;

/// What the pass does with a host's resources, for a host with a frame graph of its own: names as in [`Bindings`].
pub const ACCESSES: [(&str, Access); 4] = [
    ("positions", Access::ComputeStorageRead),
    ("normals", Access::ComputeStorageRead),
    ("visibility", Access::ComputeStorageWrite),
    ("records", Access::ComputeStorageWrite),
];

/// The buffers of one recording.
pub struct Bindings {
    /// `[f32; 3]` a receiver in object space, tightly packed.
    pub positions: BufferSlice,
    /// `[f32; 3]` a receiver in object space, of any length but 0; with [`Settings::normals`].
    pub normals: Option<BufferSlice>,
    /// Written: `[f32; order^2]` a receiver, vertex-major, as relighting takes dynamic visibility.
    pub visibility: BufferSlice,
    /// Written: `[u32; 2]` a cluster, for [`Counts::of`](crate::Counts::of).
    pub records: BufferSlice,
}

/// The pass, ready for a device. Clones share everything.
#[derive(Clone)]
pub struct Shadow {
    settings: Settings,
    program: Program,
    pipeline: ComputePipeline,
    pipeline_count: usize,
    factors: Buffer,
    /// Of the exponential, and its end; `None` for the rival.
    table: Option<(Buffer, f32)>,
    /// Ends with the sum of the logarithms.
    logarithm: bool,
}

/// Receivers of one mesh, in clusters. Clones share them.
#[derive(Clone)]
pub struct Receivers {
    slots: Buffer,
    count: u32,
    clusters: u32,
}

impl Receivers {
    /// Vertices.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Clusters of up to 64.
    #[must_use]
    pub fn clusters(&self) -> u32 {
        self.clusters
    }

    /// Bytes of the visibility of an order.
    #[must_use]
    pub fn visibility_bytes(&self, order: usize) -> u64 {
        4 * (order * order) as u64 * u64::from(self.count)
    }

    /// Bytes of the records.
    #[must_use]
    pub fn record_bytes(&self) -> u64 {
        8 * u64::from(self.clusters)
    }
}

impl Shadow {
    /// What the device must offer.
    #[must_use]
    pub fn requirements() -> Requirements {
        Requirements::engine().with_descriptors(&VISIBILITY_BINDINGS)
    }

    /// Makes tables and pipeline.
    ///
    /// # Errors
    /// As [`Settings::check`]; [`ShadowError::Gpu`].
    pub fn new(context: &Context, settings: Settings) -> Result<Self, ShadowError> {
        settings.check()?;
        Self::with_program(context, settings, Program::of(settings.exponential))
    }

    /// The same with pipelines that were made before, on whatever thread: none is made here or while recording.
    ///
    /// # Errors
    /// [`ShadowError::Envelope`] for settings outside the envelope they were prepared for; else as [`Shadow::new`].
    pub fn with_pipelines(
        context: &Context,
        settings: Settings,
        pipelines: &Pipelines,
    ) -> Result<Self, ShadowError> {
        settings.check()?;
        pipelines.envelope().check(&settings)?;
        let program = Program::of(settings.exponential);
        let pipeline = pipelines.compute(&kernel(&settings, program)?)?;
        Self::with_pipeline(context, settings, program, pipeline, pipelines.count())
    }

    /// The rival: products of the spheres' visibilities, one after the other.
    pub(crate) fn products(context: &Context, settings: Settings) -> Result<Self, ShadowError> {
        Self::with_program(context, settings, Program::without_constants(Kind::Products))
    }

    /// The pass without exponential.
    pub(crate) fn logarithm(context: &Context, settings: Settings) -> Result<Self, ShadowError> {
        Ok(Self {
            logarithm: true,
            ..Self::with_program(context, settings, Program::of(Exponential::Adaptive))?
        })
    }

    fn with_program(context: &Context, settings: Settings, program: Program) -> Result<Self, ShadowError> {
        check_order(settings.order)?;
        let pipeline = kernel(&settings, program)?.compute_pipeline(context)?;
        Self::with_pipeline(context, settings, program, pipeline, 1)
    }

    /// With the pipeline of [`kernel`], one of so many that are ready.
    fn with_pipeline(
        context: &Context,
        settings: Settings,
        program: Program,
        pipeline: ComputePipeline,
        pipeline_count: usize,
    ) -> Result<Self, ShadowError> {
        let tables = Tables::new(settings.order, settings.clip)?;
        let factors = upload(context, "factors", &tables.logarithm)?;
        let table = match program.table(&tables) {
            Some((mut values, end)) => {
                values.resize(ROW * ROWS, 0.0);
                Some((upload(context, "exponential", &values)?, end))
            }
            None => None,
        };
        Ok(Self { settings, program, pipeline, pipeline_count, factors, table, logarithm: false })
    }

    /// Pipelines that it and its like hold ready.
    pub(crate) fn pipeline_count(&self) -> usize {
        self.pipeline_count
    }

    /// What it was made for.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Puts the vertices of a mesh in clusters. A mesh that moves may keep them: they only have to lie together as a rule.
    ///
    /// # Errors
    /// [`ShadowError::Range`] for none or more than the device's storage-buffer range holds at this order,
    /// [`ShadowError::Gpu`].
    pub fn receivers(
        &self,
        context: &Context,
        name: &str,
        positions: &[[f32; 3]],
    ) -> Result<Receivers, ShadowError> {
        let bytes = 4 * (self.settings.order * self.settings.order) as u64;
        let range = u64::from(context.limits().max_storage_buffer_range);
        let most = (range / bytes).min(u64::from(u32::MAX - 1));
        if positions.is_empty() || positions.len() as u64 > most {
            let value = positions.len() as f64;
            let range = "1 to what the device's storage-buffer range holds; split the mesh";
            return Err(ShadowError::Range { what: "the number of receivers", value, range });
        }
        let slots = clusters::slots(positions);
        let clusters = (slots.len() / CLUSTER) as u32;
        Ok(Receivers { slots: upload(context, name, &slots)?, count: positions.len() as u32, clusters })
    }

    /// Records the pass: no barrier before or after. The host has made positions and normals visible to [`ACCESSES`].
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for a buffer that is too short or missing.
    pub fn record(
        &self,
        recorder: &mut Recorder<'_>,
        receivers: &Receivers,
        blockers: &Blockers,
        bindings: &Bindings,
    ) -> Result<(), GpuError> {
        let vectors = 12 * u64::from(receivers.count);
        long_enough(&bindings.positions, vectors)?;
        long_enough(&bindings.visibility, receivers.visibility_bytes(self.settings.order))?;
        long_enough(&bindings.records, receivers.record_bytes())?;
        let ranges = blockers.ranges();
        if ranges.len() > 1 && self.program.kind == Kind::Products {
            return Err(GpuError::misuse("the spheres of products", "more than one uniform range holds"));
        }
        for (at, range) in ranges.iter().enumerate() {
            if at > 0 {
                recorder.memory_barrier(Access::ComputeStorageReadWrite, Access::ComputeStorageReadWrite)?;
            }
            self.record_range(recorder, receivers, range, bindings)?;
            let flags = self.flags(at > 0, at + 1 < ranges.len());
            let mut first = 0;
            while first < receivers.clusters {
                recorder.push_constants(&self.constants(range.len() as u32, flags, first))?;
                let groups = (receivers.clusters - first).min(GROUPS);
                recorder.dispatch([groups, 1, 1])?;
                first += groups;
            }
        }
        Ok(())
    }

    /// Binds what a dispatch over one range of spheres reads.
    fn record_range(
        &self,
        recorder: &mut Recorder<'_>,
        receivers: &Receivers,
        range: &Range,
        bindings: &Bindings,
    ) -> Result<(), GpuError> {
        let (spheres, nodes) = (recorder.upload(&range.spheres)?, recorder.upload(&range.nodes)?);
        let mut all = vec![
            Binding::storage(0, &bindings.positions),
            Binding::storage(1, &receivers.slots),
            Binding::uniform(2, &spheres),
            Binding::storage(4, &bindings.visibility),
            Binding::storage(5, &bindings.records),
            Binding::uniform(8, &nodes),
        ];
        if self.program.kind != Kind::Products {
            all.push(Binding::uniform(3, &self.factors));
        }
        if self.settings.normals {
            let Some(normals) = &bindings.normals else {
                return Err(GpuError::misuse(
                    "the normals of receivers",
                    "not bound: the settings ask for them",
                ));
            };
            long_enough(normals, 12 * u64::from(receivers.count))?;
            all.push(Binding::storage(6, normals));
        }
        if let Some((table, _)) = &self.table {
            all.push(Binding::uniform(7, table));
        }
        recorder.bind_compute(&self.pipeline, &all)
    }

    fn flags(&self, continued: bool, goes_on: bool) -> u32 {
        let flag = |flag, on| if on { flag } else { 0 };
        let logarithm = goes_on || self.logarithm;
        flag(CLAMPED, self.settings.clamp) | flag(CONTINUED, continued) | flag(LOGARITHM, logarithm)
    }

    fn constants(&self, count: u32, flags: u32, first: u32) -> VisibilityConstants {
        VisibilityConstants {
            count,
            degree: self.program.degree,
            norm: self.program.norm,
            reach: self.settings.reach as f32,
            cut: self.settings.cut as f32,
            window: self.settings.window as f32,
            flags,
            end: self.table.as_ref().map_or(1.0, |(_, end)| *end),
            first,
        }
    }
}

/// The kernel over receivers of a program.
fn kernel(settings: &Settings, program: Program) -> Result<Kernel, ShadowError> {
    kernels::visibility(program.kind, settings.order, settings.normals).ok_or_else(|| {
        let (method, known) = (format!("{:?}", settings.exponential), "one with a kernel over receivers");
        ShadowError::Method { method, known }
    })
}

fn long_enough(buffer: &BufferSlice, bytes: u64) -> Result<(), GpuError> {
    if buffer.size() >= bytes {
        return Ok(());
    }
    let problem = format!("{bytes} bytes are needed, it has {}", buffer.size());
    Err(GpuError::misuse(buffer.buffer().name(), problem))
}

/// A buffer of this room's, written once.
pub(crate) fn upload<T: Pod>(context: &Context, name: &str, values: &[T]) -> Result<Buffer, GpuError> {
    let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::UNIFORM_BUFFER;
    let desc = BufferDesc { size: size_of_val(values) as u64, usage };
    let buffer = context.create_buffer(Label::new(OWNER, name), &desc, Location::Upload)?;
    buffer.write(0, values)?;
    Ok(buffer)
}
