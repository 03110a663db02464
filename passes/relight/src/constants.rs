//! Push constants that kernels share.

/// The push constants of `chunk.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct ChunkConstants {
    pub vertex_count: u32,
    pub stride: u32,
    pub first_row: u32,
}

/// Two `uint` push constants: a size or a pair of strides.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct Pair {
    pub first: u32,
    pub second: u32,
}

impl Pair {
    pub(crate) fn new(first: u32, second: u32) -> Self {
        Self { first, second }
    }
}
