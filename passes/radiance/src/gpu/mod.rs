//! The room on a device: light sampled by kernels, and where they leave it.

pub mod bench;
mod layout;

pub use layout::{Batch, EmitterTriangle, LightShape};
