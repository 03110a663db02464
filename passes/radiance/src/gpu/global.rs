//! The rival's interpolation on the device: all samples at each vertex.

use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Buffer, BufferSlice, ComputePipeline, ComputePipelineDesc, Context,
    GpuError, Recorder,
};
use bytemuck::{Pod, Zeroable};

use super::LightShape;
use crate::RadianceError;

/// By order - 3.
static GLOBAL: [&[u8]; 4] = [
    include_bytes!("../../../../shaders/spirv/radiance/global.ORDER3.spv").as_slice(),
    include_bytes!("../../../../shaders/spirv/radiance/global.ORDER4.spv").as_slice(),
    include_bytes!("../../../../shaders/spirv/radiance/global.ORDER5.spv").as_slice(),
    include_bytes!("../../../../shaders/spirv/radiance/global.ORDER6.spv").as_slice(),
];

/// What the kernel binds: points and lights of samples, positions of vertices, their light.
pub const GLOBAL_BINDINGS: [BindingDesc; 4] = {
    const fn storage(binding: u32) -> BindingDesc {
        BindingDesc::new(binding, BindingKind::StorageBuffer)
    }
    [storage(0), storage(1), storage(2), storage(3)]
};

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Constants {
    vertices: u32,
    samples: u32,
    power: u32,
}

/// Interpolates all samples at each vertex, weighed with `1 / d^power`: what [`crate::rivals::interpolate`] does.
#[derive(Clone)]
pub struct Global {
    pipeline: ComputePipeline,
}

/// Where it reads and writes.
#[derive(Clone)]
pub struct GlobalWork {
    /// A vec4 for each sample: where it was taken.
    pub points: BufferSlice,
    /// [`LightShape::stride`] vec4 for each sample.
    pub lights: BufferSlice,
    /// Samples.
    pub samples: u32,
    /// A vec4 for each vertex: its position.
    pub positions: Buffer,
    /// Vertices.
    pub vertices: u32,
    /// Their light: `[[f32; 3]; order^2]` each.
    pub light: Buffer,
    /// The power of the distance: 1, 2 or 4.
    pub power: u32,
}

impl Global {
    /// Makes the kernel.
    ///
    /// # Errors
    /// [`RadianceError::Setting`] for an order but 3 to 6; [`RadianceError::Gpu`] when the device refuses.
    pub fn new(context: &Context, shape: LightShape) -> Result<Self, RadianceError> {
        let module = shape.order.checked_sub(3).and_then(|place| GLOBAL.get(place));
        let module = module.ok_or_else(|| RadianceError::setting("order", shape.order, "3 to 6 bands"))?;
        let pipeline = context.create_compute_pipeline(&ComputePipelineDesc {
            name: "radiance global",
            spirv: &airglow_gpu::words(module),
            bindings: &GLOBAL_BINDINGS,
            push_constant_size: size_of::<Constants>() as u32,
        })?;
        Ok(Self { pipeline })
    }

    /// Records the light of all vertices, without barriers around it.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for buffers that do not fit.
    pub fn record(&self, recorder: &mut Recorder<'_>, work: &GlobalWork) -> Result<(), GpuError> {
        let bound = [
            Binding::storage(0, work.points.clone()),
            Binding::storage(1, work.lights.clone()),
            Binding::storage(2, &work.positions),
            Binding::storage(3, &work.light),
        ];
        recorder.bind_compute(&self.pipeline, &bound)?;
        let GlobalWork { vertices, samples, power, .. } = *work;
        recorder.push_constants(&Constants { vertices, samples, power })?;
        recorder.dispatch([vertices.div_ceil(64), 1, 1])
    }
}
