//! Cube maps by one kernel: a texel of a tile an invocation, triangles in a buffer.

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{
    Binding, Buffer, BufferSlice, ComputePipeline, Context, GpuError, Kernel, Label, Location, Recorder,
    Requirements,
};
use airglow_graph::{Access, BufferDesc};
use airglow_math::sphere::cube::SolidAngles;

use super::LightShape;
use super::kernels::{
    self, ANALYTIC_BINDINGS, AnalyticConstants, MOST_ANALYTIC, TEXEL_BINDINGS, TexelConstants,
};
use crate::RadianceError;

/// How finely samples see.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TexelSettings {
    /// What samples hold.
    pub shape: LightShape,
    /// Texels along a side of a face: 1 to 512; multiples of 8 fill their tiles.
    pub size: u32,
    /// Rays along a side of a texel: 1, 2 or 4.
    pub rays: u32,
}

/// The buffers of one dispatch.
#[derive(Clone)]
pub struct TexelBuffers {
    /// A [`Batch`](super::Batch), of usage `INDIRECT_BUFFER`, too.
    pub batch: BufferSlice,
    /// Where samples are taken: a vec4 each, metres, the fourth component unused.
    pub points: BufferSlice,
    /// [`EmitterTriangle`](super::EmitterTriangle)s, those that stand for the spheres last.
    pub triangles: BufferSlice,
    /// How many of them.
    pub triangle_count: u32,
    /// [`EmitterSphere`](super::EmitterSphere)s: what closed forms take in the place of their triangles.
    pub spheres: BufferSlice,
    /// How many of them.
    pub sphere_count: u32,
    /// Triangles of uniform radiance that are no part of a sphere: the first ones.
    pub flat_count: u32,
    /// [`DeviceSurface`](super::DeviceSurface)s: what the next ones show.
    pub surfaces: BufferSlice,
    /// How many of them.
    pub shown_count: u32,
    /// Texels of the pictures, a vec4 each.
    pub pictures: BufferSlice,
    /// Extinction of the medium between, 1/m, RGB.
    pub extinction: [f32; 3],
    /// Whether samples whose records say that they were kept are left alone.
    pub kept: bool,
    /// Takes the light of each sample, as [`LightShape`] says.
    pub lights: BufferSlice,
    /// Takes the gradients; not touched where the shape has none.
    pub gradients: BufferSlice,
}

/// Samples emitters that hide one another, by cube maps that are never stored.
#[derive(Clone)]
pub struct Texels {
    settings: TexelSettings,
    pipeline: ComputePipeline,
    /// Closed forms that go first, where there are few triangles.
    analytic: Option<ComputePipeline>,
    solid_angles: Buffer,
}

impl Texels {
    /// What a device must offer.
    #[must_use]
    pub fn requirements() -> Requirements {
        Requirements::engine().with_descriptors(&TEXEL_BINDINGS).with_descriptors(&ANALYTIC_BINDINGS)
    }

    /// Makes kernel and table.
    ///
    /// # Errors
    /// [`RadianceError::Setting`] for settings without kernel; [`RadianceError::Gpu`] when the device refuses.
    pub fn new(context: &Context, settings: TexelSettings) -> Result<Self, RadianceError> {
        Self::with_kernel(context, settings, |kernel| kernel.compute_pipeline(context))
    }

    /// The same with a pipeline that `find` has for the kernel.
    pub(crate) fn with_kernel(
        context: &Context,
        settings: TexelSettings,
        find: impl Fn(&Kernel) -> Result<ComputePipeline, GpuError>,
    ) -> Result<Self, RadianceError> {
        let size = settings.size;
        if !(1..=512).contains(&size) {
            return Err(RadianceError::setting("face size", size, "1 to 512 texels"));
        }
        let pipeline = find(&kernels::texels(settings.shape, settings.rays)?)?;
        let solid_angles = solid_angles(context, size as usize)?;
        Ok(Self { settings, pipeline, analytic: None, solid_angles })
    }

    /// The same, that samples up to [`MOST_ANALYTIC`] triangles and spheres in closed form from where none that emits
    /// overlaps another: the device decides for each sample, whose record says so, and only the others are cube maps.
    ///
    /// # Errors
    /// [`RadianceError::Gpu`] when the device refuses.
    pub fn with_closed_forms(self, context: &Context) -> Result<Self, RadianceError> {
        let analytic = kernels::analytic(self.settings.shape)?.compute_pipeline(context)?;
        Ok(self.with_analytic(analytic))
    }

    /// The same with the pipeline of [`kernels::analytic`].
    pub(crate) fn with_analytic(self, analytic: ComputePipeline) -> Self {
        Self { analytic: Some(analytic), ..self }
    }

    /// The same, that samples by cube maps alone.
    #[must_use]
    pub fn without_closed_forms(self) -> Self {
        Self { analytic: None, ..self }
    }

    /// The settings it was made for.
    #[must_use]
    pub fn settings(&self) -> &TexelSettings {
        &self.settings
    }

    /// Records dispatches as large as the batch says, without barriers around them: what the buffers hold must be visible to
    /// compute shaders, and the batch to indirect commands.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for buffers that do not fit.
    pub fn record(&self, recorder: &mut Recorder<'_>, buffers: &TexelBuffers) -> Result<(), GpuError> {
        let TexelBuffers { triangle_count, flat_count, sphere_count, kept, shown_count, extinction, .. } =
            *buffers;
        let bodies = flat_count.saturating_add(sphere_count);
        let plain = shown_count == 0 && extinction == [0.0; 3];
        let analytic = self.analytic.as_ref().filter(|_| bodies <= MOST_ANALYTIC && plain);
        if let Some(pipeline) = analytic {
            let slices = [
                &buffers.batch,
                &buffers.points,
                &buffers.triangles,
                &buffers.lights,
                &buffers.spheres,
                &buffers.gradients,
            ];
            self.bind(recorder, pipeline, &slices)?;
            let keep = u32::from(kept);
            recorder.push_constants(&AnalyticConstants { triangle_count: flat_count, sphere_count, keep })?;
            recorder.dispatch_indirect(buffers.batch.clone())?;
            recorder.memory_barrier(Access::ComputeStorageWrite, Access::ComputeStorageReadWrite)?;
        }
        let slices = [
            &buffers.batch,
            &buffers.points,
            &buffers.triangles,
            &(&self.solid_angles).into(),
            &buffers.lights,
            &buffers.surfaces,
            &buffers.pictures,
            &buffers.gradients,
        ];
        self.bind(recorder, &self.pipeline, &slices)?;
        recorder.push_constants(&TexelConstants {
            triangle_count,
            size: self.settings.size,
            keep_exact: (analytic.is_some() || kept).into(),
            shown_first: flat_count,
            shown_count,
            red: extinction[0],
            green: extinction[1],
            blue: extinction[2],
            columns: 0,
        })?;
        recorder.dispatch_indirect(buffers.batch.clone())
    }

    /// Binds slices in order, without the last, gradients, where the shape has none.
    fn bind<const N: usize>(
        &self,
        recorder: &mut Recorder<'_>,
        pipeline: &ComputePipeline,
        slices: &[&BufferSlice; N],
    ) -> Result<(), GpuError> {
        let bound: [Binding; N] = std::array::from_fn(|i| Binding::storage(i as u32, slices[i].clone()));
        let count = N - usize::from(!self.settings.shape.gradients);
        recorder.bind_compute(pipeline, &bound[..count])
    }
}

/// Exact solid angles of a face's texels, row by row.
pub(super) fn solid_angles(context: &Context, size: usize) -> Result<Buffer, RadianceError> {
    let exact = SolidAngles::new(size)?;
    let texel = |i: usize| Ok(exact.get(i % size, i / size)? as f32);
    let values: Vec<f32> = (0..size * size).map(texel).collect::<Result<_, RadianceError>>()?;
    let desc = BufferDesc { size: size_of_val(&values[..]) as u64, usage: BufferUsageFlags::STORAGE_BUFFER };
    let buffer = context.create_buffer(Label::new("radiance", "solid angles"), &desc, Location::Upload)?;
    buffer.write(0, &values)?;
    Ok(buffer)
}
