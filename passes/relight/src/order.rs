//! Orders of spherical harmonics that the kernels are made for: 1 to [`MAX_ORDER`].

/// The highest order with kernels.
pub const MAX_ORDER: usize = 6;
