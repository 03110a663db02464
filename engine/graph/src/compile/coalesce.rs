//! Joins equal barriers on neighbouring subresources into barriers on rectangles of mips and layers.

use crate::plan::ImageBarrier;

/// Expects barriers on single subresources, mip by mip within each resource; leaves rectangles in that order.
pub(super) fn coalesce(barriers: &mut Vec<ImageBarrier>) {
    let mut rows: Vec<ImageBarrier> = Vec::new();
    for barrier in barriers.drain(..) {
        match rows.last_mut() {
            Some(row) if follows_in_layers(row, &barrier) => row.range.layers += barrier.range.layers,
            _ => rows.push(barrier),
        }
    }
    for row in rows {
        match barriers.iter_mut().find(|rectangle| follows_in_mips(rectangle, &row)) {
            Some(rectangle) => rectangle.range.mips += row.range.mips,
            None => barriers.push(row),
        }
    }
}

/// Equal but for their ranges.
fn alike(a: &ImageBarrier, b: &ImageBarrier) -> bool {
    ImageBarrier { range: a.range, ..*b } == *a
}

fn follows_in_layers(row: &ImageBarrier, next: &ImageBarrier) -> bool {
    let (a, b) = (row.range, next.range);
    alike(row, next)
        && (a.base_mip, a.mips) == (b.base_mip, b.mips)
        && a.base_layer + a.layers == b.base_layer
}

fn follows_in_mips(rectangle: &ImageBarrier, next: &ImageBarrier) -> bool {
    let (a, b) = (rectangle.range, next.range);
    alike(rectangle, next)
        && (a.base_layer, a.layers) == (b.base_layer, b.layers)
        && a.base_mip + a.mips == b.base_mip
}
