//! Pipelines from SPIR-V and a description of its interface, stated in Rust.
//!
//! SPIR-V is taken as words. What can be checked cheaply is (header, instruction lengths, entry point `main` of the
//! right stage); that the module is otherwise valid and matches the stated bindings and push constants is up to the
//! tests that reflect it, since a driver may do anything with an invalid one.

mod compute;
mod graphics;
mod kernel;
mod layout;
mod prepared;
mod spirv;

pub use compute::{ComputePipeline, ComputePipelineDesc};
pub use graphics::{
    Blend, DepthState, GraphicsPipeline, GraphicsPipelineDesc, VertexAttribute, VertexBufferLayout,
};
pub(crate) use graphics::{MAX_COLORS, MAX_VERTEX_BUFFERS};
pub use kernel::{Kernel, Stages, words};
pub(crate) use layout::PipelineCore;
pub use layout::{BindingDesc, BindingKind, MAX_BINDINGS};
pub use prepared::{Outside, Permutations, Pipelines};
