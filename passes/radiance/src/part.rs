//! The vertices of a receiver as kernels take them: part by part, those of a workgroup near one another.

use std::ops::Range;

use glam::{DMat3, Vec3};

use crate::Hierarchy;
use crate::gpu::vertices::{DeviceVertex, GROUP};

/// Consecutive vertices of a receiver whose light lies in a buffer of its own: an instance.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its vertices.
    pub vertices: Range<u32>,
    /// Turns directions from the space of positions and emitters into that of its light, orthogonal: the inverse of an
    /// instance's rotation, mirrored or not. `None` where both are one space.
    pub turn: Option<DMat3>,
}

/// Vertices of a part whose light fits into one binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Chunk {
    pub part: usize,
    /// Its first vertex, counted within the part.
    pub vertex: u32,
    /// Its first place in [`Layout::vertices`] and in [`Layout::groups`].
    pub first: u32,
    pub first_group: u32,
    pub count: u32,
}

/// All parts, one chunk after another, the vertices of each in the order of the tree.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Layout {
    pub vertices: Vec<DeviceVertex>,
    /// Centre and radius of a ball that holds the vertices of a workgroup.
    pub groups: Vec<[f32; 4]>,
    pub chunks: Vec<Chunk>,
}

impl Layout {
    /// Chunks of at most `most` vertices.
    pub(crate) fn new(hierarchy: &Hierarchy, positions: &[[f32; 3]], parts: &[Part], most: u32) -> Self {
        let mut rank = vec![0; positions.len()];
        (0..).zip(hierarchy.vertices()).for_each(|(place, vertex)| rank[*vertex as usize] = place);
        let mut layout = Self::default();
        for (index, part) in parts.iter().enumerate() {
            for begin in part.vertices.clone().step_by(most as usize) {
                let end = part.vertices.end.min(begin.saturating_add(most));
                let mut chunk: Vec<u32> = (begin..end).collect();
                chunk.sort_unstable_by_key(|vertex| rank[*vertex as usize]);
                layout.chunks.push(Chunk {
                    part: index,
                    vertex: begin - part.vertices.start,
                    first: layout.vertices.len() as u32,
                    first_group: layout.groups.len() as u32,
                    count: end - begin,
                });
                let vertex = |v: &u32| DeviceVertex { position: positions[*v as usize], place: v - begin };
                layout.vertices.extend(chunk.iter().map(vertex));
                layout.groups.extend(chunk.chunks(GROUP).map(|group| ball(group, positions)));
            }
        }
        layout
    }
}

/// A ball about the middle of the vertices' box.
fn ball(vertices: &[u32], positions: &[[f32; 3]]) -> [f32; 4] {
    let points = || vertices.iter().map(|vertex| Vec3::from(positions[*vertex as usize]));
    let low = points().fold(Vec3::INFINITY, Vec3::min);
    let centre = low.midpoint(points().fold(Vec3::NEG_INFINITY, Vec3::max));
    let radius = points().map(|point| point.distance(centre)).fold(0.0, f32::max);
    // More by what rounding here and in the kernel may take away.
    centre.extend(radius + 1e-6 * (radius + centre.length())).to_array()
}
