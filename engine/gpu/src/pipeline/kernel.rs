//! Kernels as data: what a room's pipelines are made of, stated before any is made.

use super::compute::{ComputePipeline, ComputePipelineDesc};
use super::graphics::{Blend, GraphicsPipeline, GraphicsPipelineDesc, VertexBufferLayout};
use super::layout::BindingDesc;
use crate::context::Context;
use crate::error::GpuError;
use ash::vk;

/// A kernel that a room carries. Two of the same [`Stages`] are one pipeline.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// Name of the pipeline, shown by captures.
    pub name: &'static str,
    /// Its modules.
    pub stages: Stages,
    /// Every binding of descriptor set 0 that they use.
    pub bindings: Vec<BindingDesc>,
    /// Bytes of push constants; a multiple of 4.
    pub push_constant_size: u32,
}

/// Modules of a kernel: SPIR-V as little-endian words in bytes.
#[derive(Clone, Copy, Debug)]
pub enum Stages {
    /// A compute shader.
    Compute(&'static [u8]),
    /// Triangles of whichever winding into one colour attachment, which they replace; no depth.
    Rectangles {
        /// The vertex stage.
        vertex: &'static [u8],
        /// The fragment stage.
        fragment: &'static [u8],
        /// Vertex buffers by slot.
        vertex_buffers: &'static [VertexBufferLayout<'static>],
        /// Format of the attachment.
        format: vk::Format,
    },
}

/// What tells kernels apart: modules, and format of the attachment.
pub(crate) type Key = (&'static [u8], &'static [u8], vk::Format);

/// The pipeline of a kernel.
#[derive(Clone)]
pub(crate) enum Pipeline {
    Compute(ComputePipeline),
    Graphics(GraphicsPipeline),
}

impl Kernel {
    /// A compute kernel.
    #[must_use]
    pub fn compute(
        name: &'static str,
        spirv: &'static [u8],
        bindings: &[BindingDesc],
        push_constant_size: usize,
    ) -> Self {
        let (stages, bindings) = (Stages::Compute(spirv), bindings.to_vec());
        Self { name, stages, bindings, push_constant_size: push_constant_size as u32 }
    }

    /// Makes the pipeline of a compute kernel by itself.
    ///
    /// # Errors
    /// As [`Context::create_compute_pipeline`]; [`GpuError::Misuse`] for a kernel of vertices and fragments.
    pub fn compute_pipeline(&self, context: &Context) -> Result<ComputePipeline, GpuError> {
        match self.make(context)? {
            Pipeline::Compute(pipeline) => Ok(pipeline),
            Pipeline::Graphics(_) => Err(GpuError::misuse(self.name, "it is no compute kernel")),
        }
    }

    pub(crate) fn key(&self) -> Key {
        match self.stages {
            Stages::Compute(spirv) => (spirv, &[], vk::Format::UNDEFINED),
            Stages::Rectangles { vertex, fragment, format, .. } => (vertex, fragment, format),
        }
    }

    pub(crate) fn make(&self, context: &Context) -> Result<Pipeline, GpuError> {
        let Self { name, stages, bindings, push_constant_size } = self;
        let (name, push_constant_size) = (*name, *push_constant_size);
        match *stages {
            Stages::Compute(spirv) => {
                let desc = ComputePipelineDesc { name, spirv: &words(spirv), bindings, push_constant_size };
                context.create_compute_pipeline(&desc).map(Pipeline::Compute)
            }
            Stages::Rectangles { vertex, fragment, vertex_buffers, format } => {
                let desc = GraphicsPipelineDesc {
                    name,
                    vertex: &words(vertex),
                    fragment: Some(&words(fragment)),
                    bindings,
                    push_constant_size,
                    vertex_buffers,
                    topology: vk::PrimitiveTopology::TRIANGLE_LIST,
                    cull: vk::CullModeFlags::NONE,
                    front_face: vk::FrontFace::COUNTER_CLOCKWISE,
                    depth: None,
                    colors: &[format],
                    blend: Blend::None,
                };
                context.create_graphics_pipeline(&desc).map(Pipeline::Graphics)
            }
        }
    }
}

/// Little-endian words of a module's bytes.
#[must_use]
pub fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
}
