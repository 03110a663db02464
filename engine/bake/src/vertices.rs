//! Vertices and their rays, summed on the spherical-harmonic basis.
//!
//! Sloan, Kautz, Snyder 2002, section 4 (shadow pass), as in thesis eq. 5.14 with visibility:
//! t = 1/π ∫ V(s) max(s·N, 0) y(s) ds, and the visibility vector v = ∫ V(s) y(s) ds from the same rays. Both are
//! summed in the frame of the normal, S = Σ w_i V_i y(s_i), completed by the open hemisphere's exact integral I
//! as a control variate, t = S + a (I - Σ w_i y(s_i)) with a the free share of the rays, and then rotated: an
//! open vertex gets the closed form and a closed one gets zero, both exactly.

#[cfg(test)]
mod study;

use std::f64::consts::TAU;

use glam::{DVec3, Mat3A, Mat4};

use crate::analytic::unit;
use crate::directions::{Directions, LANES, MAX_WIDTH, hemisphere};
use crate::frame::{Frame, FrameRotation};
use crate::mesh::{Mesh, Placement};
use crate::origin::{Surroundings, surroundings};
use crate::triangle::Segment;
use crate::{BakeError, BelowHorizon, Occluders, Settings, Stats};

/// Rays summed in f32 before the sum joins the f64 total: rounding stays below 1e-6 of the result.
const BATCH: usize = 256;

/// A mesh in the space baked in, ready for rays.
pub(crate) struct Vertices<'a> {
    positions: Vec<[f32; 3]>,
    normals: Vec<DVec3>,
    surroundings: Vec<Surroundings>,
    occluders: &'a Occluders<'a>,
    directions: Directions,
    rotation: FrameRotation,
    settings: Settings,
    /// The constant 1 over the lower hemisphere.
    lower: Vec<f64>,
}

impl<'a> Vertices<'a> {
    /// Carries the mesh to the occluders' space. Mesh and settings have been checked.
    pub(crate) fn new(
        mesh: &Mesh<'_>,
        transform: Mat4,
        occluders: &'a Occluders<'a>,
        settings: &Settings,
    ) -> Result<Self, BakeError> {
        let placement = Placement::new(mesh.name, transform)?;
        let positions: Vec<[f32; 3]> = mesh.positions.iter().map(|p| placement.position(*p)).collect();
        if let Some(vertex) = positions.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
            let what = "world position";
            return Err(BakeError::NotFinite { mesh: mesh.name.to_owned(), what, vertex });
        }
        let normals: Vec<DVec3> = mesh.normals.iter().map(|normal| placement.normal(*normal)).collect();
        Ok(Self {
            surroundings: surroundings(&positions, &normals, mesh.indices),
            positions,
            normals,
            occluders,
            directions: Directions::new(settings)?,
            rotation: FrameRotation::new(settings.order)?,
            settings: *settings,
            lower: hemisphere(settings.order, DVec3::NEG_Z)?,
        })
    }

    pub(crate) fn len(&self) -> usize {
        self.positions.len()
    }

    pub(crate) fn coefficient_count(&self) -> usize {
        self.settings.coefficient_count()
    }

    /// Unit normal of a vertex, if it has one.
    pub(crate) fn normal(&self, vertex: usize) -> Option<DVec3> {
        unit(*self.normals.get(vertex)?)
    }

    /// Whether the ray of a vertex along `direction` is free.
    pub(crate) fn sees(&self, vertex: usize, normal: DVec3, direction: DVec3) -> bool {
        let scale = self.occluders.scale();
        let origin = self.surroundings[vertex].ray_origin(self.positions[vertex], normal.as_vec3());
        let reach = scale.length(self.settings.reach);
        let segment = Segment { origin: scale.apply(origin), direction: direction.as_vec3a(), reach };
        !self.occluders.blocks(&segment)
    }

    /// Bakes consecutive vertices from `first`, as many as `transfer` holds vectors of; `visibility` is empty or
    /// as long.
    pub(crate) fn bake(
        &self,
        first: usize,
        transfer: &mut [f32],
        visibility: &mut [f32],
    ) -> Result<Stats, BakeError> {
        let count = self.coefficient_count();
        let mut stats = Stats::default();
        let mut visibility = visibility.chunks_exact_mut(count);
        for (vertex, transfer) in (first..).zip(transfer.chunks_exact_mut(count)) {
            let visibility = visibility.next().unwrap_or_default();
            let Some(normal) = unit(self.normals[vertex]) else {
                stats.zero_normals += 1;
                continue;
            };
            let frame = Frame::new(normal, self.twist(vertex));
            let (mut sums, free) = self.trace(vertex, normal, &frame);
            let rays = self.directions.local.len();
            stats.rays += rays as u64;
            stats.blocked += (rays - free) as u64;
            let share = free as f64 / rays as f64;
            for (sum, residual) in sums.iter_mut().zip(&self.directions.residual) {
                *sum += share * residual;
            }
            let (transfer_sums, visibility_sums) = sums.split_at_mut(count);
            // Y_00 is 1 / sqrt(4π) everywhere.
            let free_share = transfer_sums[0] * (2.0 * TAU).sqrt();
            self.write(&frame, transfer_sums, transfer)?;
            if let Some(below) = self.settings.visibility {
                self.extend_below(below, free_share, &mut visibility_sums[..count]);
                self.write(&frame, &mut visibility_sums[..count], visibility)?;
            }
        }
        Ok(stats)
    }

    /// Sums the rows of the vertex's free rays, and counts these.
    fn trace(&self, vertex: usize, normal: DVec3, frame: &Frame) -> ([f64; MAX_WIDTH], usize) {
        let scale = self.occluders.scale();
        let origin = self.surroundings[vertex].ray_origin(self.positions[vertex], normal.as_vec3());
        let origin = scale.apply(origin);
        let reach = scale.length(self.settings.reach);
        let frame = Mat3A::from(frame.matrix().as_mat3());
        let width = self.directions.width;
        let (mut totals, mut free) = ([0.0; MAX_WIDTH], 0);
        let batches = self.directions.local.chunks(BATCH).zip(self.directions.rows.chunks(BATCH * width));
        for (directions, rows) in batches {
            let mut sums = [0.0_f32; MAX_WIDTH];
            for (direction, row) in directions.iter().zip(rows.chunks_exact(width)) {
                let segment = Segment { origin, direction: frame * *direction, reach };
                if !self.occluders.blocks(&segment) {
                    free += 1;
                    add(&mut sums[..width], row);
                }
            }
            totals.iter_mut().zip(sums).for_each(|(total, sum)| *total += f64::from(sum));
        }
        (totals, free)
    }

    /// The angle a vertex turns the direction set by, from a hash of its index (the finaliser of SplitMix64,
    /// Steele, Lea, Flood 2014), so that neighbours do not share their error.
    fn twist(&self, vertex: usize) -> f64 {
        let mut hash =
            (vertex as u64 | u64::from(self.settings.seed) << 32).wrapping_add(0x9e37_79b9_7f4a_7c15);
        hash = (hash ^ hash >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        hash = (hash ^ hash >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        hash ^= hash >> 31;
        TAU * (hash >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Rotates a vector into the space baked in and rounds it to f32.
    fn write(&self, frame: &Frame, vector: &mut [f64], out: &mut [f32]) -> Result<(), BakeError> {
        self.rotation.apply(frame, vector)?;
        out.iter_mut().zip(vector).for_each(|(out, value)| *out = *value as f32);
        Ok(())
    }

    /// Completes the visibility of the upper hemisphere by what counts below the horizon, in the normal's frame;
    /// `free` is the free share of the cosine-weighted upper hemisphere.
    fn extend_below(&self, below: BelowHorizon, free: f64, upper: &mut [f64]) {
        let value = match below {
            BelowHorizon::Mean => free,
            BelowHorizon::Visible => 1.0,
            BelowHorizon::Blocked => 0.0,
        };
        upper.iter_mut().zip(&self.lower).for_each(|(sum, lower)| *sum += value * lower);
    }
}

/// Adds a row, in whole vectors.
#[inline(always)]
fn add(sums: &mut [f32], row: &[f32]) {
    for (sums, row) in sums.chunks_exact_mut(LANES).zip(row.chunks_exact(LANES)) {
        for lane in 0..LANES {
            sums[lane] += row[lane];
        }
    }
}
