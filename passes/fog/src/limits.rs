//! What the kernels hold, at most.

/// Lights of a frame, at most.
pub const MAX_LIGHTS: usize = 64;
