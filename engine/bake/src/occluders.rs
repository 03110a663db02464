//! The triangles that block light, in a compressed eight-wide bounding-volume hierarchy (Ylitie, Karras,
//! Laine 2017; crate obvhs).

use std::time::{Duration, Instant};

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::cwbvh::{CwBvh, bvh2_to_cwbvh::bvh2_to_cwbvh};
use obvhs::ploc::PlocBuilder;
use obvhs::ray::Ray;
use obvhs::{Boundable, BvhBuildParams};

use crate::mesh::{Mask, Occluder, Placement, check_triangles};
use crate::triangle::{Segment, Triangle};
use crate::{BakeError, scale::Scale};

/// Most triangles in one hierarchy; its builder counts in u32 with a factor of 14.
const MAX_TRIANGLES: usize = 1 << 27;
/// Entries of obvhs's traversal stack; a deeper hierarchy would drop nodes silently.
const MAX_DEPTH: usize = 31;
/// Boxes grow by this share of the largest coordinate, eight times f32's rounding error: the box test then
/// errs only towards testing a triangle, and cannot open gaps between boxes.
const BOX_MARGIN: f32 = 8.0 * f32::EPSILON / 2.0;

/// Occluders ready for rays. Built once, used for any number of receivers in the same space.
pub struct Occluders<'a> {
    hierarchy: CwBvh,
    /// In the order of the hierarchy's leaves.
    triangles: Vec<Triangle>,
    scale: Scale,
    /// Per entry of `triangles`: occluder and triangle of the host. Empty when no occluder is masked.
    sources: Vec<[u32; 2]>,
    masks: Vec<Option<Mask<'a>>>,
    zero_area: usize,
    build_time: Duration,
}

impl std::fmt::Debug for Occluders<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter
            .debug_struct("Occluders")
            .field("triangles", &self.triangles.len())
            .field("zero_area", &self.zero_area)
            .finish_non_exhaustive()
    }
}

impl<'a> Occluders<'a> {
    /// Transforms the triangles to the space baked in and builds the hierarchy, on the calling thread.
    /// Triangles of zero area block nothing; they are left out and counted.
    ///
    /// # Errors
    /// Faulty indices, positions or transforms, named; more than 2²⁷ triangles; a hierarchy deeper than its
    /// traversal stack, which takes geometry nested over more than the range of f32.
    pub fn build(occluders: &[Occluder<'a>]) -> Result<Self, BakeError> {
        let start = Instant::now();
        let soup = Soup::gather(occluders)?;
        let scale = Scale::to_working_size(soup.largest);
        let corners: Vec<obvhs::triangle::Triangle> = (soup.corners.iter())
            .map(|points| {
                let [v0, v1, v2] = points.map(|p| scale.apply(p));
                obvhs::triangle::Triangle { v0, v1, v2 }
            })
            .collect();
        let hierarchy = build_hierarchy(&corners, scale.apply([soup.largest, 0.0, 0.0]).x * BOX_MARGIN);
        let depth = depth(&hierarchy);
        if depth > MAX_DEPTH {
            return Err(BakeError::TooDeep { depth, limit: MAX_DEPTH });
        }
        let leaves = || hierarchy.primitive_indices.iter().map(|&index| index as usize);
        let triangles =
            leaves().map(|i| Triangle::new([corners[i].v0, corners[i].v1, corners[i].v2])).collect();
        let masked = occluders.iter().any(|occluder| occluder.mask.is_some());
        let sources = if masked { leaves().map(|i| soup.sources[i]).collect() } else { Vec::new() };
        Ok(Self {
            hierarchy,
            triangles,
            scale,
            sources,
            masks: occluders.iter().map(|occluder| occluder.mask).collect(),
            zero_area: soup.zero_area,
            build_time: start.elapsed(),
        })
    }

    /// Triangles of zero area that were left out.
    #[must_use]
    pub fn zero_area_triangles(&self) -> usize {
        self.zero_area
    }

    /// Time that gathering and building took.
    #[must_use]
    pub fn build_time(&self) -> Duration {
        self.build_time
    }

    pub(crate) fn scale(&self) -> Scale {
        self.scale
    }

    /// Whether something blocks the segment, given in working coordinates.
    #[inline]
    pub(crate) fn blocks(&self, segment: &Segment) -> bool {
        if self.hierarchy.nodes.is_empty() {
            return false;
        }
        let ray = Ray::new(segment.origin, segment.direction, 0.0, segment.reach);
        let distance = |id| if self.blocked_by(id, segment) { 0.0 } else { f32::INFINITY };
        !self.hierarchy.ray_traverse_miss(ray, |_, id| distance(id))
    }

    #[inline(always)]
    fn blocked_by(&self, id: usize, segment: &Segment) -> bool {
        let met = self.triangles[id].meet(segment);
        met.is_some_and(|weights| self.sources.is_empty() || self.solid(id, weights))
    }

    #[cold]
    fn solid(&self, id: usize, weights: [f32; 2]) -> bool {
        let [occluder, triangle] = self.sources[id];
        self.masks[occluder as usize].is_none_or(|mask| (mask.solid)(triangle as usize, weights))
    }
}

/// The triangles of all occluders in the space baked in.
struct Soup {
    corners: Vec<[[f32; 3]; 3]>,
    sources: Vec<[u32; 2]>,
    largest: f32,
    zero_area: usize,
}

impl Soup {
    fn gather(occluders: &[Occluder<'_>]) -> Result<Self, BakeError> {
        let count =
            occluders.iter().map(|occluder| occluder.indices.len() / 3).fold(0, usize::saturating_add);
        if count > MAX_TRIANGLES {
            return Err(BakeError::TooMany { what: "occluding triangles", count, limit: MAX_TRIANGLES });
        }
        let mut soup = Self {
            corners: Vec::with_capacity(count),
            sources: Vec::with_capacity(count),
            largest: 0.0,
            zero_area: 0,
        };
        for (number, occluder) in occluders.iter().enumerate() {
            check_triangles(occluder.name, occluder.positions, occluder.indices)?;
            soup.add(number as u32, occluder)?;
        }
        Ok(soup)
    }

    fn add(&mut self, number: u32, occluder: &Occluder<'_>) -> Result<(), BakeError> {
        let placement = Placement::new(occluder.name, occluder.transform)?;
        for (triangle, indices) in occluder.indices.chunks_exact(3).enumerate() {
            let points = [indices[0], indices[1], indices[2]]
                .map(|i| placement.position(occluder.positions[i as usize]));
            if let Some(corner) = points.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
                return Err(BakeError::NotFinite {
                    mesh: occluder.name.to_owned(),
                    what: "world position",
                    vertex: indices[corner] as usize,
                });
            }
            if has_no_area(points) {
                self.zero_area += 1;
                continue;
            }
            self.largest = points.iter().flatten().fold(self.largest, |largest, x| largest.max(x.abs()));
            self.corners.push(points);
            self.sources.push([number, triangle as u32]);
        }
        Ok(())
    }
}

fn has_no_area(points: [[f32; 3]; 3]) -> bool {
    let [a, b, c] = points.map(|p| glam::DVec3::from(p.map(f64::from)));
    (b - a).cross(c - a) == glam::DVec3::ZERO
}

/// Bounds with a margin.
struct Padded(Aabb, f32);

impl Boundable for Padded {
    fn aabb(&self) -> Aabb {
        let margin = Vec3A::splat(self.1);
        Aabb::new(self.0.min - margin, self.0.max + margin)
    }
}

/// obvhs's slow build (splits of large triangles, wide search, reinsertion), with padded boxes.
fn build_hierarchy(triangles: &[obvhs::triangle::Triangle], margin: f32) -> CwBvh {
    if triangles.is_empty() {
        return CwBvh::default();
    }
    let settings = BvhBuildParams::slow_build();
    let mut boxes: Vec<Aabb> = triangles.iter().map(obvhs::triangle::Triangle::aabb).collect();
    let mut indices: Vec<u32> = (0..triangles.len() as u32).collect();
    let areas = || boxes.iter().map(Aabb::half_area);
    let average = areas().sum::<f32>() / triangles.len() as f32;
    let largest = areas().fold(0.0, f32::max);
    obvhs::splits::split_aabbs_preset(&mut boxes, &mut indices, triangles, average, largest);
    let padded: Vec<Padded> = boxes.into_iter().map(|bounds| Padded(bounds, margin)).collect();
    let mut binary = PlocBuilder::with_capacity(padded.len()).build(
        settings.ploc_search_distance,
        &padded,
        indices,
        settings.sort_precision,
        settings.search_depth_threshold,
    );
    binary.uses_spatial_splits = true;
    ReinsertionOptimizer::default().run(&mut binary, settings.reinsertion_batch_ratio, None);
    bvh2_to_cwbvh(&binary, settings.max_prims_per_leaf.clamp(1, 3), true, false)
}

/// Levels of the hierarchy.
fn depth(hierarchy: &CwBvh) -> usize {
    let mut level = if hierarchy.nodes.is_empty() { vec![] } else { vec![0] };
    let mut depth = 0;
    while !level.is_empty() {
        depth += 1;
        let nodes = level.iter().map(|&index: &usize| &hierarchy.nodes[index]);
        level = nodes
            .flat_map(|node| {
                let inner = (0..8).filter(|&child| !node.is_child_empty(child) && !node.is_leaf(child));
                inner.map(|child| node.child_node_index(child) as usize)
            })
            .collect();
    }
    depth
}
