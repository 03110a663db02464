//! The room on a device: light sampled by kernels, and where they leave it.

pub mod bench;
mod global;
pub mod glow;
pub mod keep;
pub mod kernels;
mod layout;
mod read;
pub mod refinement;
mod texels;
pub mod tree;
pub mod vertices;

pub use global::{GLOBAL_BINDINGS, Global, GlobalWork};
pub use glow::DeviceGlow;
pub use keep::{Keep, OldSamples};
pub use layout::{Batch, EmitterSphere, EmitterTriangle, LightShape};
pub use refinement::{RefineState, Refinement, SampleBuffers};
pub use texels::{TexelBuffers, TexelSettings, Texels};
pub use tree::DeviceNode;
pub use vertices::VertexKernels;

/// Little-endian words of a module's bytes.
pub(crate) fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
}
