//! Steps of a build: what each uses, for whoever makes the barriers, and how it is recorded.

use airglow_gpu::ash::vk::{ImageLayout, ImageViewType};
use airglow_gpu::{
    Binding, Buffer, BufferSlice, ComputePipeline, GpuError, Image, Look, Recorder, Tally, ViewDesc,
};
use airglow_graph::{Access, State};

use crate::kernels::{AlignConstants, FitConstants, PackConstants};

/// Invocations of a workgroup of every kernel.
pub(crate) const GROUP: usize = 64;

/// What a build works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Resource {
    /// The map's normals.
    Normals,
    /// Lobes of a level, in f32.
    Lobes(usize),
    /// The same as the texture holds them.
    Packed(usize),
    /// The texture.
    Texture,
    /// The counters of a host that has lobes counted.
    Health,
}

/// A step of a build. All it works on is the build's own.
#[derive(Clone)]
pub struct Stage {
    pub(crate) name: &'static str,
    pub(crate) accesses: Vec<(Resource, Access)>,
    pub(crate) texels: u64,
    pub(crate) work: Work,
}

#[derive(Clone)]
pub(crate) enum Work {
    /// A band of a level, fitted.
    Fit { pipeline: ComputePipeline, samples: Buffer, lobes: Buffer, constants: FitConstants, count: usize },
    /// A level put into the order of the coarser one.
    Align { pipeline: ComputePipeline, coarse: Buffer, lobes: Buffer, constants: AlignConstants },
    /// A level in few bits.
    Pack { pipeline: ComputePipeline, lobes: Buffer, packed: Buffer, constants: PackConstants },
    /// Lobes of all levels counted.
    Count { tally: Tally, looks: Vec<Look<BufferSlice>> },
    /// All levels into the texture.
    Copy { packed: Vec<Buffer>, texture: Image },
}

impl Stage {
    /// What the plan calls it.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// What it does with the resources of the build: a host without our graph makes the barriers before it.
    #[must_use]
    pub fn accesses(&self) -> &[(Resource, Access)] {
        &self.accesses
    }

    /// Texels that it works on, for a measure of progress.
    #[must_use]
    pub fn texels(&self) -> u64 {
        self.texels
    }

    /// Records it between barriers for all that the build works on, for a host that makes none: what steps before it wrote,
    /// in this command buffer or in one that was submitted to the queue, is waited for, and the texture is left to be
    /// sampled by fragment shaders ([`Access::FragmentSampled`]).
    ///
    /// # Errors
    /// As [`Stage::record`].
    pub fn record_with_barriers(&self, recorder: &mut Recorder<'_>) -> Result<(), GpuError> {
        let written = Access::ComputeStorageReadWrite;
        let Work::Copy { texture, .. } = &self.work else {
            recorder.memory_barrier(written, written)?;
            return self.record(recorder);
        };
        recorder.memory_barrier(written, Access::TransferSource)?;
        let fresh = State::idle(ImageLayout::UNDEFINED);
        recorder.transition(texture, fresh, Access::TransferDestination)?;
        self.record(recorder)?;
        recorder.transition(texture, Access::TransferDestination, Access::FragmentSampled)
    }

    /// Records it, without barriers. Command-buffer state changed: as [`Recorder`] says.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for a recorder of another context.
    pub fn record(&self, recorder: &mut Recorder<'_>) -> Result<(), GpuError> {
        match &self.work {
            Work::Fit { pipeline, samples, lobes, constants, count } => {
                dispatch(recorder, pipeline, [samples, lobes], constants, *count)
            }
            Work::Align { pipeline, coarse, lobes, constants } => {
                let count = constants.size.iter().map(|&size| size as usize).product();
                dispatch(recorder, pipeline, [coarse, lobes], constants, count)
            }
            Work::Pack { pipeline, lobes, packed, constants } => {
                let count = constants.texels as usize * constants.lobes as usize;
                dispatch(recorder, pipeline, [lobes, packed], constants, count)
            }
            Work::Count { tally, looks } => tally.record(recorder, looks),
            Work::Copy { packed, texture } => {
                let layers = texture.desc().layers;
                (0..).zip(packed).try_for_each(|(base_mip, packed)| {
                    let dimension = ImageViewType::TYPE_2D_ARRAY;
                    let desc = ViewDesc { dimension, base_mip, mips: 1, base_layer: 0, layers };
                    recorder.copy_buffer_to_image(packed, &texture.view(desc)?)
                })
            }
        }
    }
}

/// One dispatch of at least `count` invocations.
pub(crate) fn dispatch<C: bytemuck::Pod>(
    recorder: &mut Recorder<'_>,
    pipeline: &ComputePipeline,
    [input, output]: [&Buffer; 2],
    constants: &C,
    count: usize,
) -> Result<(), GpuError> {
    recorder.bind_compute(pipeline, &[Binding::storage(0, input), Binding::storage(1, output)])?;
    recorder.push_constants(constants)?;
    recorder.dispatch([count.div_ceil(GROUP) as u32, 1, 1])
}
