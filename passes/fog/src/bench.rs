//! One frame at a time, submitted and waited for by a host: what `eval`, `stability` and tests run kernels with.

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, ComputePipelineDesc, Context, GpuError, Label, Location, Recorder,
};
use airglow_graph::{Access, BufferDesc};
use airglow_math::World;
use bytemuck::{Pod, Zeroable};
use glam::DVec3;

pub use crate::kernels::WALL;
use crate::kernels::{self, Rows};
use crate::pack::{LightConstants, pack};
use crate::{Camera, FogError, Light, Medium, PhaseKind, Preset, Settings, View};

/// Records what it is given into one frame of the bench's context, submits it and waits until it is done.
pub type Run<'a> =
    dyn Fn(&mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>) -> Result<(), GpuError> + 'a;

/// A host for single frames. This crate never submits or waits; the caller does, in `run`.
#[derive(Clone, Copy)]
pub struct Bench<'a> {
    /// The context frames are recorded for.
    pub context: &'a Context,
    /// Submits one frame and waits.
    pub run: &'a Run<'a>,
}

/// A ray through a medium with one light: a row of `airlight_rows.comp`. Airglow's axes, metres.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where the ray begins.
    pub eye: DVec3,
    /// The medium.
    pub medium: Medium,
    /// The light.
    pub light: Light,
    /// Unit direction of the ray.
    pub direction: DVec3,
    /// Distance of the surface, or infinite.
    pub distance: f64,
}

/// `Row` of `airlight_rows.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct RowConstants {
    light: LightConstants,
    direction_distance: [f32; 4],
    extinction: [f32; 4],
    scattering: [f32; 4],
    phase: [f32; 4],
}

/// `Settings` of `airlight_rows.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct RowSettings {
    count: u32,
}

/// Rows of one dispatch: 40 MiB, below the least storage-buffer range of any device.
const ROWS: usize = 1 << 18;

/// Bindings of the rows: rows, airlight.
pub const ROW_BINDINGS: [BindingDesc; 2] =
    [BindingDesc::new(0, BindingKind::StorageBuffer), BindingDesc::new(1, BindingKind::StorageBuffer)];

impl Ray {
    fn constants(&self, settings: &Settings) -> Result<RowConstants, FogError> {
        // A view of the whole sphere would do as well: with a bound of 0 nothing is left out but a dark light.
        let camera = Camera {
            position: self.eye,
            right: DVec3::X,
            up: DVec3::Y,
            forward: DVec3::NEG_Z,
            edges: [-1.0, 1.0, -1.0, 1.0],
        };
        let view = View {
            world: World::default(),
            camera,
            medium: self.medium,
            lights: vec![self.light],
            environment: None,
        };
        let packed = pack(settings, &view, [1, 1])?.constants;
        let distance = self.distance.min(f64::from(kernels::FARTHEST));
        Ok(RowConstants {
            light: packed.first_light(),
            direction_distance: self.direction.extend(distance).as_vec4().to_array(),
            extinction: packed.extinction(),
            scattering: packed.scattering(),
            phase: packed.phase(),
        })
    }
}

impl Bench<'_> {
    /// The airlight of each ray by the pass's own functions, red, green and blue.
    ///
    /// # Errors
    /// [`FogError::Range`] for the first ray that no frame takes; [`FogError::Kernel`] where a medium has another phase
    /// function than `settings`, or thins with one that is not isotropic.
    pub fn airlight(&self, settings: &Settings, rays: &[Ray]) -> Result<Vec<[f32; 3]>, FogError> {
        self.rows(Rows::of(settings)?, settings, rays)
    }

    /// The same at the reference preset in isotropic media by a shader that defines `FOG_VISIBILITY`: no light arrives
    /// beyond [`WALL`].
    ///
    /// # Errors
    /// As [`Self::airlight`].
    pub fn airlight_with_wall(&self, rays: &[Ray]) -> Result<Vec<[f32; 3]>, FogError> {
        let settings = Settings {
            preset: Preset::Reference,
            phase: PhaseKind::Isotropic,
            bound: 0.0,
            ..Settings::default()
        };
        self.rows(Rows::Wall, &settings, rays)
    }

    fn rows(&self, rows: Rows, settings: &Settings, rays: &[Ray]) -> Result<Vec<[f32; 3]>, FogError> {
        let pipeline = self.context.create_compute_pipeline(&ComputePipelineDesc {
            name: "fog airlight rows",
            spirv: &kernels::rows(rows),
            bindings: &ROW_BINDINGS,
            push_constant_size: size_of::<RowSettings>() as u32,
        })?;
        let mut airlight = Vec::with_capacity(rays.len());
        for rays in rays.chunks(ROWS) {
            let rows: Vec<RowConstants> =
                rays.iter().map(|ray| ray.constants(settings)).collect::<Result<_, _>>()?;
            let buffer = |name, size, usage, location| {
                let desc = BufferDesc { size, usage: BufferUsageFlags::STORAGE_BUFFER | usage };
                self.context.create_buffer(Label::new("bench", name), &desc, location)
            };
            let none = BufferUsageFlags::empty();
            let input = buffer("fog rows", size_of_val(&rows[..]) as u64, none, Location::Upload)?;
            input.write(0, &rows)?;
            let bytes = 16 * rows.len() as u64;
            let output = buffer("fog airlight", bytes, BufferUsageFlags::TRANSFER_SRC, Location::Device)?;
            let mut copy = None;
            (self.run)(&mut |recorder| {
                recorder
                    .bind_compute(&pipeline, &[Binding::storage(0, &input), Binding::storage(1, &output)])?;
                recorder.push_constants(&RowSettings { count: rows.len() as u32 })?;
                recorder.dispatch([(rows.len() as u32).div_ceil(64), 1, 1])?;
                recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
                copy = Some(recorder.read_back_buffer(&output)?);
                Ok(())
            })?;
            let copy =
                copy.ok_or_else(|| GpuError::misuse("the bench", "its host did not record the frame"))?;
            airlight.extend(copy.read::<[f32; 4]>()?.into_iter().map(|[r, g, b, _]| [r, g, b]));
        }
        Ok(airlight)
    }
}

/// The settings of a preset for a medium, with nothing left out.
#[must_use]
pub fn settings(medium: &Medium, preset: Preset) -> Settings {
    let (phase, height) = (medium.phase.kind(), medium.thinning.is_some());
    Settings { preset, phase, height, bound: 0.0, ..Settings::default() }
}
