//! The kernel: its pipeline, what it binds, its dispatch.

use airglow_gpu::{
    Binding, BindingDesc, BindingKind, BufferSlice, ComputePipeline, ComputePipelineDesc, Context, GpuError, Recorder,
    Requirements,
};
use bytemuck::{Pod, Zeroable};

use crate::{Settings, __Room__Error};

/// Bytes of an RGBA32F colour.
pub(crate) const COLOUR_BYTES: u64 = 16;

/// Invocations of a workgroup, as the shader states them.
const WORKGROUP: u32 = 64;

/// What the kernel binds in descriptor set 0: the colours, and where they go.
pub const BINDINGS: [BindingDesc; 2] =
    [BindingDesc::new(0, BindingKind::StorageBuffer), BindingDesc::new(1, BindingKind::StorageBuffer)];

/// What the kernel is told with each dispatch.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct PushConstants {
    /// Colours.
    pub count: u32,
    /// What they are multiplied by.
    pub factor: f32,
}

/// The buffers of one recording, RGBA32F each.
pub struct Bindings {
    /// Read.
    pub colours: BufferSlice,
    /// Written.
    pub exposed: BufferSlice,
}

/// The pass, ready for a device. Clones share the pipeline.
#[derive(Clone)]
pub struct __Room__ {
    pipeline: ComputePipeline,
    settings: Settings,
}

impl __Room__ {
    /// What the device must offer.
    pub fn requirements() -> Requirements {
        Requirements::engine()
    }

    /// Makes the pipeline.
    ///
    /// # Errors
    /// [`__Room__Error::Stops`]; [`__Room__Error::Gpu`] when the driver refuses.
    pub fn new(context: &Context, settings: Settings) -> Result<Self, __Room__Error> {
        settings.check()?;
        let bytes = include_bytes!("../../../shaders/spirv/__room__/expose.spv");
        let spirv: Vec<u32> =
            bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect();
        let desc = ComputePipelineDesc {
            name: "__room__",
            spirv: &spirv,
            bindings: &BINDINGS,
            push_constant_size: size_of::<PushConstants>() as u32,
        };
        Ok(Self { pipeline: context.create_compute_pipeline(&desc)?, settings })
    }

    /// What it was made for.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Records the pass over the first `count` colours. The host has made the colours visible to
    /// [`ACCESSES`](crate::ACCESSES); no barrier is recorded.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for buffers too short for `count`, and those of [`Recorder::dispatch`].
    pub fn record(&self, recorder: &mut Recorder<'_>, bindings: &Bindings, count: u32) -> Result<(), GpuError> {
        let bytes = COLOUR_BYTES * u64::from(count);
        for buffer in [&bindings.colours, &bindings.exposed] {
            if buffer.size() < bytes {
                let problem = format!("{count} colours need {bytes} bytes; it has {}", buffer.size());
                return Err(GpuError::misuse(buffer.buffer().name(), problem));
            }
        }
        let bound = [Binding::storage(0, &bindings.colours), Binding::storage(1, &bindings.exposed)];
        recorder.bind_compute(&self.pipeline, &bound)?;
        recorder.push_constants(&PushConstants { count, factor: self.settings.factor() })?;
        recorder.dispatch([count.div_ceil(WORKGROUP), 1, 1])
    }
}
