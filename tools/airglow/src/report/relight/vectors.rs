//! Transfer vectors of the highest order: cut down to others, and repeated.

/// The highest order with kernels: what is measured is truncated from it.
pub const FULL_ORDER: usize = 6;

/// The first `order`^2 coefficients of vectors of [`FULL_ORDER`].
pub fn truncate(vectors: &[f32], order: usize) -> Vec<f32> {
    let rows = vectors.chunks_exact(FULL_ORDER * FULL_ORDER);
    rows.flat_map(|row| row[..order * order].iter().copied()).collect()
}

/// The vectors repeated until there are `vertices` of them.
pub fn tile(vectors: &[f32], order: usize, vertices: usize) -> Vec<f32> {
    vectors.iter().copied().cycle().take(vertices * order * order).collect()
}
