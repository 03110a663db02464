//! One frame at a time, submitted and waited for by a host: what `eval`, `stability` and tests run kernels with.

use airglow_gpu::ash::vk::{BufferUsageFlags, Format, ImageLayout, ImageUsageFlags};
use airglow_gpu::{Buffer, Context, GpuError, Image, Label, Location, Readback, Recorder};
use airglow_graph::{Access, BufferDesc, ImageDesc, ResourceDesc, State};
use bytemuck::Pod;
use glam::DQuat;

use crate::RelightError;
use crate::frame::{Environment, Frame, Instance, Light};
use crate::mesh::MeshId;
use crate::record::Bindings;
use crate::relight::Relight;
use crate::rotation::Orientation;
use crate::settings::Output;
use crate::stage::{Need, Resource};

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

/// An equirectangular image in memory.
#[derive(Clone, Copy, Debug)]
pub struct Texels<'a> {
    /// Texels of a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Linear RGB, row by row from the top.
    pub rgb: &'a [[f32; 3]],
}

/// The light of a [`Case`].
#[derive(Clone, Copy, Debug)]
pub enum CaseLight<'a> {
    /// An environment and its rotation.
    Environment(Texels<'a>, DQuat),
    /// SH RGB, order^2 values, and its rotation.
    Uniform(&'a [[f32; 3]], DQuat),
    /// SH RGB of each vertex, vertex-major.
    Vertices(&'a [[f32; 3]]),
}

/// A frame of one instance.
#[derive(Clone, Copy, Debug)]
pub struct Case<'a> {
    /// The light.
    pub light: CaseLight<'a>,
    /// The mesh.
    pub mesh: MeshId,
    /// Orientation of the instance.
    pub orientation: Orientation,
    /// Dynamic visibility, vertex-major.
    pub visibility: Option<&'a [f32]>,
    /// Normals of the vertices, of a mesh without vectors.
    pub normals: Option<&'a [[f32; 3]]>,
    /// A filter of the light, as [`Rotations::set_filter`](crate::Rotations::set_filter) takes it.
    pub filter: Option<&'a [[f64; 3]]>,
}

impl<'a> Case<'a> {
    /// A mesh in the orientation of its object space, without inputs of its own.
    #[must_use]
    pub fn new(light: CaseLight<'a>, mesh: MeshId) -> Self {
        Self {
            light,
            mesh,
            orientation: Orientation::IDENTITY,
            visibility: None,
            normals: None,
            filter: None,
        }
    }
}

const OWNER: &str = "bench";

impl Bench<'_> {
    /// A storage buffer that holds `values`.
    pub(crate) fn buffer<T: Pod>(&self, name: &str, values: &[T]) -> Result<Buffer, GpuError> {
        let desc = BufferDesc { size: size_of_val(values) as u64, usage: BufferUsageFlags::STORAGE_BUFFER };
        let buffer = self.context.create_buffer(Label::new(OWNER, name), &desc, Location::Upload)?;
        buffer.write(0, values)?;
        Ok(buffer)
    }

    /// A storage buffer of the device's, to be read back.
    pub(crate) fn scratch(&self, name: &str, desc: BufferDesc) -> Result<Buffer, GpuError> {
        let usage = desc.usage
            | BufferUsageFlags::STORAGE_BUFFER
            | BufferUsageFlags::UNIFORM_BUFFER
            | BufferUsageFlags::TRANSFER_SRC
            | BufferUsageFlags::TRANSFER_DST;
        self.context.create_buffer(Label::new(OWNER, name), &BufferDesc { usage, ..desc }, Location::Device)
    }

    /// Runs one frame and returns what it leaves to be read.
    pub(crate) fn run(
        &self,
        mut record: impl FnMut(&mut Recorder<'_>) -> Result<Readback, GpuError>,
    ) -> Result<Readback, GpuError> {
        let mut result = None;
        (self.run)(&mut |recorder| {
            result = Some(record(recorder)?);
            Ok(())
        })?;
        result.ok_or_else(|| GpuError::misuse("the bench", "its host did not record the frame"))
    }

    /// An image of the texels, in the layout of a sampled image.
    fn image(&self, texels: &Texels<'_>) -> Result<Image, RelightError> {
        let Texels { width, height, rgb } = *texels;
        crate::check_environment("the environment", width, height, rgb)?;
        let usage = ImageUsageFlags::SAMPLED | ImageUsageFlags::TRANSFER_DST;
        let desc = ImageDesc { usage, ..ImageDesc::new_2d(width, height, Format::R32G32B32A32_SFLOAT) };
        let image = self.context.create_image(Label::new(OWNER, "environment"), &desc)?;
        let rgba: Vec<[f32; 4]> = rgb.iter().map(|[r, g, b]| [*r, *g, *b, 1.0]).collect();
        let desc = BufferDesc { size: 16 * rgba.len() as u64, usage: BufferUsageFlags::TRANSFER_SRC };
        let label = Label::new(OWNER, "environment texels");
        let staging = self.context.create_buffer(label, &desc, Location::Upload)?;
        staging.write(0, &rgba)?;
        let view = image.full_view()?;
        (self.run)(&mut |recorder| {
            recorder.transition(&image, State::idle(ImageLayout::UNDEFINED), Access::TransferDestination)?;
            recorder.copy_buffer_to_image(&staging, &view)?;
            recorder.transition(&image, Access::TransferDestination, Access::ComputeSampled)
        })?;
        Ok(image)
    }

    /// Runs one frame of one instance by the road without a graph, and reads `wanted` back.
    fn frame(
        &self,
        relight: &mut Relight,
        case: &Case<'_>,
        wanted: Resource,
    ) -> Result<Vec<f32>, RelightError> {
        let mut bindings = Bindings::default();
        let mut instance = Instance { orientation: case.orientation, ..Instance::new(case.mesh) };
        let light = match case.light {
            CaseLight::Environment(texels, rotation) => {
                let view = self.image(&texels)?.full_view()?;
                bindings.images.insert(Resource::Environment, view);
                let Texels { width, height, .. } = texels;
                relight.forget_environment();
                Light::Environment(Environment { image: (), width, height, revision: 0, rotation })
            }
            CaseLight::Uniform(coefficients, rotation) => {
                let padded: Vec<[f32; 4]> = coefficients.iter().map(|[r, g, b]| [*r, *g, *b, 0.0]).collect();
                bindings.buffers.insert(Resource::UniformLight, (&self.buffer("light", &padded)?).into());
                Light::Uniform { coefficients: (), rotation }
            }
            CaseLight::Vertices(values) => {
                instance.light = Some(());
                bindings.buffers.insert(Resource::VertexLight(0), (&self.buffer("light", values)?).into());
                Light::Vertices
            }
        };
        if let Some(values) = case.visibility {
            instance.visibility = Some(());
            bindings.buffers.insert(Resource::Visibility(0), (&self.buffer("visibility", values)?).into());
        }
        if let Some(values) = case.normals {
            instance.normals = Some(());
            bindings.buffers.insert(Resource::Normals(0), (&self.buffer("normals", values)?).into());
        }
        let frame = Frame { light, instances: vec![instance], target: None };
        let prepared = relight.prepare(self.context, &frame)?;
        if let (Some(filter), Some(rotations)) = (case.filter, &prepared.rotations) {
            rotations.set_filter(filter)?;
        }
        for (resource, need) in &prepared.needs {
            match need {
                Need::Scratch(ResourceDesc::Buffer(desc)) => {
                    let buffer = self.scratch(&resource.to_string(), *desc)?;
                    bindings.buffers.insert(*resource, (&buffer).into());
                }
                Need::Scratch(ResourceDesc::Image(desc)) => {
                    let usage = ImageUsageFlags::COLOR_ATTACHMENT | ImageUsageFlags::TRANSFER_SRC;
                    let label = Label::new(OWNER, "rectangle");
                    let image = self.context.create_image(label, &ImageDesc { usage, ..*desc })?;
                    bindings.images.insert(*resource, image.full_view()?);
                }
                Need::Ours { buffer, .. } => {
                    bindings.buffers.insert(*resource, buffer.into());
                }
                Need::Host => {}
            }
        }
        let readback = self.run(|recorder| {
            prepared.record(recorder, &bindings)?;
            // Whatever wrote it last: a kernel, or the copy of the fragment method.
            recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
            recorder.memory_barrier(Access::TransferDestination, Access::TransferSource)?;
            recorder.read_back_buffer(bindings.buffer(wanted)?)
        })?;
        Ok(readback.read()?)
    }

    /// Runs one frame of one instance and returns its results: for each vertex `[r, g, b, 1]`, or `3 order^2` values
    /// of incident radiance.
    ///
    /// # Errors
    /// As [`Relight::prepare`].
    pub fn results(&self, relight: &mut Relight, case: &Case<'_>) -> Result<Vec<f32>, RelightError> {
        self.frame(relight, case, Resource::Results)
    }

    /// Projects an environment with the pass's own kernels: order^2 RGB coefficients.
    ///
    /// # Errors
    /// As [`Relight::new`] and [`Relight::prepare`]; [`RelightError::Values`] for texels that are refused.
    pub fn environment(&self, order: usize, texels: &Texels<'_>) -> Result<Vec<[f32; 3]>, RelightError> {
        let settings = crate::Settings { order, output: Output::Colour, ..Default::default() };
        let mut relight = Relight::new(self.context, settings)?;
        let mesh = relight.add_mesh(self.context, "one vertex", 1, Some(&vec![0.0; order * order]))?;
        let light = CaseLight::Environment(*texels, DQuat::IDENTITY);
        let values = self.frame(&mut relight, &Case::new(light, mesh), Resource::EnvironmentLight)?;
        Ok(values.chunks_exact(4).map(|rgbw| [rgbw[0], rgbw[1], rgbw[2]]).collect())
    }
}
