//! The room on a device: light sampled by kernels, and where they leave it.

mod atlas;
pub mod bench;
mod global;
pub mod glow;
pub mod keep;
pub mod kernels;
mod layout;
pub mod refinement;
mod surfaces;
mod texels;
pub mod tree;
pub mod vertices;

pub use atlas::Atlas;
pub use global::{GLOBAL_BINDINGS, Global, GlobalWork};
pub use glow::DeviceGlow;
pub use keep::{Keep, OldSamples};
pub use layout::{Batch, EmitterSphere, EmitterTriangle, LightShape};
pub use refinement::{RefineState, Refinement, SampleBuffers};
pub use surfaces::{DeviceSurface, Surfaces};
pub use texels::{TexelBuffers, TexelSettings, Texels};
pub use tree::DeviceNode;
pub use vertices::VertexKernels;
