//! The pass on a device: its pipeline and tables, the receivers, and what it records.

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{
    Binding, Buffer, BufferSlice, ComputePipeline, ComputePipelineDesc, Context, GpuError, Label, Location,
    Recorder, Requirements,
};
use airglow_graph::{Access, BufferDesc};
use bytemuck::Pod;

use crate::blockers::{Blockers, MAX_SPHERES};
use crate::clusters::{self, CLUSTER};
use crate::kernels::{self, Kind, Program, VISIBILITY_BINDINGS, VisibilityConstants};
use crate::settings::Settings;
use crate::table::Tables;
use crate::{ShadowError, check_order};

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
    factors: Buffer,
    linear: Buffer,
    linear_end: f32,
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

    /// The pass with the kernel of `kind`: rivals and parts.
    pub(crate) fn with_kind(context: &Context, settings: Settings, kind: Kind) -> Result<Self, ShadowError> {
        Self::with_program(context, settings, Program::without_constants(kind))
    }

    fn with_program(context: &Context, settings: Settings, program: Program) -> Result<Self, ShadowError> {
        check_order(settings.order)?;
        let Some(spirv) = kernels::visibility(program.kind, settings.order, settings.normals) else {
            let (method, known) = (format!("{:?}", settings.exponential), "one with a kernel over receivers");
            return Err(ShadowError::Method { method, known });
        };
        let desc = ComputePipelineDesc {
            name: "shadow visibility",
            spirv: &spirv,
            bindings: &kernels::visibility_bindings(program, settings.normals),
            push_constant_size: size_of::<VisibilityConstants>() as u32,
        };
        let pipeline = context.create_compute_pipeline(&desc)?;
        let tables = Tables::new(settings.order, settings.clip)?;
        let factors = match program.kind {
            Kind::Products => &tables.visibility,
            _ => &tables.logarithm,
        };
        let factors = upload(context, "factors", factors)?;
        let linear = upload(context, "optimal linear", &tables.linear)?;
        Ok(Self { settings, program, pipeline, factors, linear, linear_end: tables.linear_end })
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
        let mut all = [[0.0_f32; 4]; MAX_SPHERES];
        let sphere_count = blockers.with(|spheres| {
            all.iter_mut().zip(spheres).for_each(|(place, sphere)| *place = *sphere);
            spheres.len() as u32
        });
        let spheres = recorder.upload(&all)?;
        let always = [
            Binding::storage(0, &bindings.positions),
            Binding::storage(1, &receivers.slots),
            Binding::uniform(2, &spheres),
            Binding::uniform(3, &self.factors),
            Binding::storage(4, &bindings.visibility),
            Binding::storage(5, &bindings.records),
        ];
        let [a, b, c, d, e, f] = always;
        if self.settings.normals {
            let Some(normals) = &bindings.normals else {
                return Err(GpuError::misuse(
                    "the normals of receivers",
                    "not bound: the settings ask for them",
                ));
            };
            long_enough(normals, vectors)?;
            recorder.bind_compute(&self.pipeline, &[a, b, c, d, e, f, Binding::storage(6, normals)])?;
        } else if self.program.reads_linear() {
            recorder.bind_compute(&self.pipeline, &[a, b, c, d, e, f, Binding::storage(7, &self.linear)])?;
        } else {
            recorder.bind_compute(&self.pipeline, &[a, b, c, d, e, f])?;
        }
        let mut first = 0;
        while first < receivers.clusters {
            recorder.push_constants(&self.constants(sphere_count, first))?;
            let groups = (receivers.clusters - first).min(GROUPS);
            recorder.dispatch([groups, 1, 1])?;
            first += groups;
        }
        Ok(())
    }

    fn constants(&self, sphere_count: u32, first: u32) -> VisibilityConstants {
        VisibilityConstants {
            sphere_count,
            degree: self.program.degree,
            norm: self.program.norm,
            reach: self.settings.reach as f32,
            window: self.settings.window as f32,
            clamped: u32::from(self.settings.clamp && self.program.kind != Kind::Logarithm),
            end: self.linear_end,
            first,
        }
    }
}

fn long_enough(buffer: &BufferSlice, bytes: u64) -> Result<(), GpuError> {
    if buffer.size() >= bytes {
        return Ok(());
    }
    let problem = format!("{bytes} bytes are needed, it has {}", buffer.size());
    Err(GpuError::misuse(buffer.buffer().name(), problem))
}

/// A buffer of this room's, written once.
fn upload<T: Pod>(context: &Context, name: &str, values: &[T]) -> Result<Buffer, GpuError> {
    let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::UNIFORM_BUFFER;
    let desc = BufferDesc { size: size_of_val(values) as u64, usage };
    let buffer = context.create_buffer(Label::new(OWNER, name), &desc, Location::Upload)?;
    buffer.write(0, values)?;
    Ok(buffer)
}
