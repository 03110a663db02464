//! Kernels run one frame at a time, submitted and waited for by a host: what tests, evaluation and examples use.

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{Buffer, Context, GpuError, Label, Location, Recorder};
use airglow_graph::{Access, BufferDesc};
use bytemuck::Pod;
use glam::DVec3;

use super::{Batch, EmitterSphere, EmitterTriangle, LightShape, Surfaces, TexelBuffers, Texels};
use crate::{Incident, Lights, RadianceError, Triangle};

const OWNER: &str = "radiance";

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

/// A sample that a device took.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled {
    /// What arrives.
    pub light: Incident,
    /// Whether it is a closed form, and not a cube map.
    pub exact: bool,
}

impl Bench<'_> {
    /// A storage buffer that holds `values`; one byte at least is made for none.
    ///
    /// # Errors
    /// [`RadianceError::Gpu`] when the device has no room.
    pub fn upload<T: Pod>(&self, name: &str, values: &[T]) -> Result<Buffer, RadianceError> {
        let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::INDIRECT_BUFFER;
        let desc = BufferDesc { size: size_of_val(values).max(size_of::<T>()) as u64, usage };
        let buffer = self.context.create_buffer(Label::new(OWNER, name), &desc, Location::Upload)?;
        match values {
            [] => buffer.write(0, &[T::zeroed()])?,
            values => buffer.write(0, values)?,
        }
        Ok(buffer)
    }

    /// A storage buffer of the device, which may be read back, filled and dispatched from.
    ///
    /// # Errors
    /// [`RadianceError::Gpu`] when the device has no room.
    pub fn scratch(&self, name: &str, bytes: u64) -> Result<Buffer, RadianceError> {
        let usage = BufferUsageFlags::STORAGE_BUFFER
            | BufferUsageFlags::INDIRECT_BUFFER
            | BufferUsageFlags::TRANSFER_SRC
            | BufferUsageFlags::TRANSFER_DST;
        let desc = BufferDesc { size: bytes.max(16), usage };
        Ok(self.context.create_buffer(Label::new(OWNER, name), &desc, Location::Device)?)
    }

    /// What a buffer holds, once kernels have written it.
    ///
    /// # Errors
    /// [`RadianceError::Gpu`] when the device fails, or the buffer is no whole number of values.
    pub fn read<T: Pod>(&self, buffer: &Buffer) -> Result<Vec<T>, RadianceError> {
        let mut copy = None;
        (self.run)(&mut |recorder| {
            recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
            copy = Some(recorder.read_back_buffer(buffer)?);
            Ok(())
        })?;
        let copy = copy.ok_or_else(|| GpuError::misuse("the bench", "its host did not record the frame"))?;
        Ok(copy.read()?)
    }

    /// The light of `triangles` at each point.
    ///
    /// # Errors
    /// As [`sampled`](Self::sampled).
    pub fn texels(
        &self,
        texels: &Texels,
        triangles: &[Triangle],
        points: &[DVec3],
    ) -> Result<Vec<Incident>, RadianceError> {
        Ok(self.sampled(texels, triangles, points)?.into_iter().map(|sample| sample.light).collect())
    }

    /// The same, and how it was found.
    ///
    /// # Errors
    /// [`RadianceError::Value`] for a faulty triangle; [`RadianceError::Gpu`] when the device fails.
    pub fn sampled(
        &self,
        texels: &Texels,
        triangles: &[Triangle],
        points: &[DVec3],
    ) -> Result<Vec<Sampled>, RadianceError> {
        self.sampled_of(texels, &Lights { emitters: triangles, ..Lights::default() }, points)
    }

    /// The same of triangles and spheres.
    ///
    /// # Errors
    /// As [`sampled`](Self::sampled).
    pub fn sampled_of(
        &self,
        texels: &Texels,
        lights: &Lights<'_>,
        points: &[DVec3],
    ) -> Result<Vec<Sampled>, RadianceError> {
        lights.check()?;
        let shape = texels.settings().shape;
        let buffers = self.buffers_of(shape, lights, points)?;
        (self.run)(&mut |recorder| texels.record(recorder, &buffers))?;
        let (lights, gradients) = (buffers.lights.buffer(), buffers.gradients.buffer());
        let found = self.incidents(shape, points.len(), lights, gradients)?;
        let records: Vec<[f32; 4]> = self.read(lights)?;
        let exact = |i: usize| records[i * shape.stride() + shape.coefficients()][2] == 1.0;
        let sample = |(i, light)| Sampled { light, exact: exact(i) };
        Ok(found.into_iter().enumerate().map(sample).collect())
    }

    /// Buffers for one dispatch over all points.
    ///
    /// # Errors
    /// [`RadianceError::Gpu`] when the device has no room.
    pub fn buffers(
        &self,
        shape: LightShape,
        triangles: &[Triangle],
        points: &[DVec3],
    ) -> Result<TexelBuffers, RadianceError> {
        self.buffers_of(shape, &Lights { emitters: triangles, ..Lights::default() }, points)
    }

    /// The same for triangles and spheres.
    ///
    /// # Errors
    /// As [`buffers`](Self::buffers).
    pub fn buffers_of(
        &self,
        shape: LightShape,
        lights: &Lights<'_>,
        points: &[DVec3],
    ) -> Result<TexelBuffers, RadianceError> {
        let packed: Vec<EmitterTriangle> = lights.triangles().iter().map(EmitterTriangle::from).collect();
        let spheres: Vec<EmitterSphere> = lights.spheres.iter().map(EmitterSphere::from).collect();
        let surfaces = Surfaces::new(lights)?;
        let positions: Vec<[f32; 4]> = points.iter().map(|p| p.extend(0.0).as_vec4().to_array()).collect();
        Ok(TexelBuffers {
            batch: (&self.upload("batch", &[Batch::new(0, points.len() as u32)])?).into(),
            points: (&self.upload("points", &positions)?).into(),
            triangles: (&self.upload("triangles", &packed)?).into(),
            triangle_count: packed.len() as u32,
            spheres: (&self.upload("spheres", &spheres)?).into(),
            sphere_count: spheres.len() as u32,
            flat_count: lights.emitters.len() as u32,
            surfaces: (&self.upload("surfaces", &surfaces.shown)?).into(),
            shown_count: surfaces.count,
            pictures: (&self.upload("pictures", &surfaces.texels)?).into(),
            extinction: surfaces.extinction,
            kept: false,
            lights: (&self.scratch("lights", shape.light_bytes(points.len()))?).into(),
            gradients: (&self.scratch("gradients", shape.gradient_bytes(points.len()))?).into(),
        })
    }

    /// What so many samples hold, once kernels have written them.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn incidents(
        &self,
        shape: LightShape,
        samples: usize,
        lights: &Buffer,
        gradients: &Buffer,
    ) -> Result<Vec<Incident>, RadianceError> {
        let lights: Vec<[f32; 4]> = self.read(lights)?;
        let gradients: Vec<[f32; 4]> = self.read(gradients)?;
        let (stride, gradient_stride) = (shape.stride(), shape.gradient_stride());
        let sample = |i: usize| {
            let gradients = &gradients[i * gradient_stride..(i + 1) * gradient_stride];
            shape.incident(&lights[i * stride..(i + 1) * stride], gradients)
        };
        (0..samples).map(sample).collect()
    }
}
