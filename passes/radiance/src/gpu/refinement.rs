//! Refinement on the device: rounds of oracle and samples, none of which the CPU waits for.

use airglow_gpu::{Binding, BindingDesc, BindingKind, Buffer, BufferSlice, ComputePipeline, Kernel};
use airglow_gpu::{Context, GpuError, Recorder};
use bytemuck::{Pod, Zeroable};

use super::{Batch, DeviceGlow, LightShape};
use crate::{Oracle, RadianceError, Settings};

/// What a kernel binds.
pub const REFINE_BINDINGS: [BindingDesc; 7] = {
    const fn storage(binding: u32) -> BindingDesc {
        BindingDesc::new(binding, BindingKind::StorageBuffer)
    }
    [storage(0), storage(1), storage(2), storage(3), storage(4), storage(5), storage(6)]
};

/// The module of `radiance/refine.comp`.
pub static REFINE: &[u8] = include_bytes!("../../../../shaders/spirv/radiance/refine.spv");

/// The bit of a sample's node in `places` that says that the node was split.
pub const SPLIT: u32 = 1 << 31;

/// How far refinement went; the kernel's own, and what a host may read back.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct RefineState {
    /// What is sampled next: the first argument of an indirect dispatch is the number of samples.
    pub batch: Batch,
    /// Samples, those of the batch among them.
    pub taken: u32,
    /// 1 when the limit kept a node from being split.
    pub limited: u32,
    /// Rounds of sampling.
    pub rounds: u32,
    /// The largest estimate of a node that was not split.
    pub estimate: f32,
    /// Samples that were taken in this frame; the others were kept.
    pub fresh: u32,
    /// Samples in closed form; the others are cube maps.
    pub exact: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Round {
    seed: u32,
    oracle: u32,
    stride: u32,
    limit: u32,
    bound: f32,
    hidden: f32,
    glows: u32,
    coefficients: u32,
    light_stride: u32,
}

/// Bytes of the push constants of the kernel.
pub const REFINE_CONSTANTS: u32 = size_of::<Round>() as u32;

/// The samples of a receiver on the device.
#[derive(Clone)]
pub struct SampleBuffers {
    /// A word for each node: the number of its sample.
    pub slots: Buffer,
    /// A word for each sample: its node.
    pub places: Buffer,
    /// A vec4 for each sample: where it is taken, metres.
    pub points: Buffer,
    /// [`LightShape::stride`] vec4 for each sample.
    pub lights: Buffer,
    /// [`LightShape::gradient_stride`] vec4 for each sample.
    pub gradients: Buffer,
    /// One [`RefineState`].
    pub state: Buffer,
}

/// The kernel of [`Refinement`].
pub(crate) fn kernel() -> Kernel {
    Kernel::compute("radiance refine", REFINE, &REFINE_BINDINGS, REFINE_CONSTANTS as usize)
}

/// The kernel that decides where to sample next.
#[derive(Clone)]
pub struct Refinement {
    pipeline: ComputePipeline,
    shape: LightShape,
}

impl Refinement {
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

    /// Records one round: with `seed` it asks for the first sample, of the root; else it looks at those of the last
    /// round. The barriers before and after are the caller's.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for buffers that do not fit.
    pub fn record(
        &self,
        recorder: &mut Recorder<'_>,
        nodes: &Buffer,
        samples: &SampleBuffers,
        glows: &BufferSlice,
        settings: &Settings,
        seed: bool,
    ) -> Result<(), GpuError> {
        let bound = [
            Binding::storage(0, nodes),
            Binding::storage(1, &samples.slots),
            Binding::storage(2, &samples.places),
            Binding::storage(3, &samples.points),
            Binding::storage(4, &samples.lights),
            Binding::storage(5, &samples.state),
            Binding::storage(6, glows.clone()),
        ];
        recorder.bind_compute(&self.pipeline, &bound)?;
        recorder.push_constants(&Round {
            seed: u32::from(seed),
            oracle: match settings.oracle {
                Oracle::Printed => 0,
                Oracle::Argued => 1,
                Oracle::Transfer => 2,
            },
            stride: settings.stride as u32,
            limit: settings.limit as u32,
            bound: settings.bound.min(f64::from(f32::MAX)) as f32,
            hidden: settings.hidden as f32,
            glows: (glows.size() / size_of::<DeviceGlow>() as u64) as u32,
            coefficients: self.shape.coefficients() as u32,
            light_stride: self.shape.stride() as u32,
        })?;
        recorder.dispatch([1, 1, 1])
    }
}

/// Rounds after which no node is left to split: one for each level of the tree.
#[must_use]
pub fn rounds(vertices: usize) -> u32 {
    vertices.max(1).next_power_of_two().trailing_zeros() + 1
}
