//! Samples of the frame before, kept where emitters have moved too little to matter.

use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Buffer, BufferSlice, ComputePipeline, Context, GpuError, Kernel,
    Recorder,
};
use airglow_graph::Access;
use bytemuck::{Pod, Zeroable};

use super::glow::DeviceGlow;
use super::{LightShape, SampleBuffers};
use crate::RadianceError;

/// What the kernel binds.
pub const KEEP_BINDINGS: [BindingDesc; 11] = {
    const fn storage(binding: u32) -> BindingDesc {
        BindingDesc::new(binding, BindingKind::StorageBuffer)
    }
    [
        storage(0),
        storage(1),
        storage(2),
        storage(3),
        storage(4),
        storage(5),
        storage(6),
        storage(7),
        storage(8),
        storage(9),
        storage(10),
    ]
};

/// The module of `radiance/keep.comp`.
pub static KEEP: &[u8] = include_bytes!("../../../../shaders/spirv/radiance/keep.spv");

/// `Settings` of `keep.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct KeepConstants {
    /// Change of colours that samples may be stale by.
    pub allowed: f32,
    /// Glows.
    pub glows: u32,
    /// Coefficients of a sample.
    pub coefficients: u32,
    /// vec4 of a sample's light.
    pub light_stride: u32,
    /// vec4 of its gradients.
    pub gradient_stride: u32,
}

/// The samples of the frame before.
#[derive(Clone)]
pub struct OldSamples {
    /// As [`SampleBuffers::places`].
    pub places: Buffer,
    /// As [`SampleBuffers::lights`].
    pub lights: Buffer,
    /// As [`SampleBuffers::gradients`].
    pub gradients: Buffer,
    /// As [`SampleBuffers::state`].
    pub state: Buffer,
}

impl OldSamples {
    /// Bytes that it holds.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        [&self.places, &self.lights, &self.gradients, &self.state].into_iter().map(Buffer::size).sum()
    }

    /// Records the copy of the samples there are, with the barriers that it needs.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for buffers that do not fit.
    pub fn record_copy(&self, recorder: &mut Recorder<'_>, samples: &SampleBuffers) -> Result<(), GpuError> {
        recorder.memory_barrier(Access::ComputeStorageReadWrite, Access::TransferSource)?;
        recorder.memory_barrier(Access::ComputeStorageRead, Access::TransferDestination)?;
        recorder.copy_buffer(&samples.places, &self.places)?;
        recorder.copy_buffer(&samples.lights, &self.lights)?;
        recorder.copy_buffer(&samples.gradients, &self.gradients)?;
        recorder.copy_buffer(&samples.state, &self.state)?;
        recorder.memory_barrier(Access::TransferSource, Access::ComputeStorageReadWrite)?;
        recorder.memory_barrier(Access::TransferDestination, Access::ComputeStorageRead)
    }
}

/// The kernel of [`Keep`].
pub(crate) fn kernel() -> Kernel {
    Kernel::compute("radiance keep", KEEP, &KEEP_BINDINGS, size_of::<KeepConstants>())
}

/// The kernel that keeps samples.
#[derive(Clone)]
pub struct Keep {
    pipeline: ComputePipeline,
    shape: LightShape,
}

impl Keep {
    /// Makes the kernel.
    ///
    /// # Errors
    /// [`RadianceError::Gpu`] when the device refuses.
    pub fn new(context: &Context, shape: LightShape) -> Result<Self, RadianceError> {
        Ok(Self::with_pipeline(kernel().compute_pipeline(context)?, shape))
    }

    /// With the pipeline of [`kernel`].
    pub(crate) fn with_pipeline(pipeline: ComputePipeline, shape: LightShape) -> Self {
        Self { pipeline, shape }
    }

    /// Records a look at the batch: samples whose light may have changed, weighed by their node, by no more than `allowed` in
    /// colour are copied from the old ones, and their records say so. `glows` are those of the step from the frame before.
    /// The barriers before and after are the caller's.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for buffers that do not fit.
    pub fn record(
        &self,
        recorder: &mut Recorder<'_>,
        nodes: &Buffer,
        samples: &SampleBuffers,
        old: &OldSamples,
        glows: &BufferSlice,
        allowed: f64,
    ) -> Result<(), GpuError> {
        let bound = [
            Binding::storage(0, nodes),
            Binding::storage(1, &samples.state),
            Binding::storage(2, &samples.points),
            Binding::storage(3, &samples.places),
            Binding::storage(4, &samples.lights),
            Binding::storage(5, &samples.gradients),
            Binding::storage(6, glows.clone()),
            Binding::storage(7, &old.state),
            Binding::storage(8, &old.places),
            Binding::storage(9, &old.lights),
            Binding::storage(10, &old.gradients),
        ];
        recorder.bind_compute(&self.pipeline, &bound)?;
        recorder.push_constants(&KeepConstants {
            allowed: allowed.min(f64::from(f32::MAX)) as f32,
            glows: (glows.size() / size_of::<DeviceGlow>() as u64) as u32,
            coefficients: self.shape.coefficients() as u32,
            light_stride: self.shape.stride() as u32,
            gradient_stride: self.shape.gradient_stride() as u32,
        })?;
        recorder.dispatch_indirect(samples.state.slice(0, size_of::<super::Batch>() as u64)?)
    }
}
