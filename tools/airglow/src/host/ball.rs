//! Spheres that only cast shadows, as triangles for rays.

use std::f32::consts::{PI, TAU};

use airglow_bake::Occluder;
use airglow_scene::Blocker;
use glam::{Mat4, Vec3};

/// Rows of triangles from pole to pole, and triangles of half a row.
const ROWS: u32 = 24;
const COLUMNS: u32 = 48;

/// A blocker as a mesh whose corners lie as far outside of the sphere as its faces lie inside.
pub struct Ball {
    /// The blocker's.
    pub name: String,
    /// Corners in the world.
    pub positions: Vec<[f32; 3]>,
    /// Three for each triangle, counter-clockwise from without.
    pub indices: Vec<u32>,
}

impl Ball {
    /// Of a blocker.
    pub fn new(blocker: &Blocker) -> Self {
        let middle = Vec3::from(blocker.center);
        // A face between corners on the sphere lies inside by the cosine of half a step along both angles.
        let inside = (PI / ROWS as f32 / 2.0).cos() * (PI / COLUMNS as f32).cos();
        let radius = blocker.radius * 2.0 / (1.0 + inside);
        let corner = |at: u32| {
            let (theta, phi) =
                (PI * (at / COLUMNS) as f32 / ROWS as f32, TAU * (at % COLUMNS) as f32 / COLUMNS as f32);
            let direction = Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
            (middle + radius * direction).to_array()
        };
        let square = |at: u32| {
            let (row, column) = (COLUMNS * (at / COLUMNS), at % COLUMNS);
            let (a, b) = (row + column, row + (column + 1) % COLUMNS);
            [a, b, b + COLUMNS, a, b + COLUMNS, a + COLUMNS]
        };
        Self {
            name: blocker.name.clone(),
            positions: (0..COLUMNS * (ROWS + 1)).map(corner).collect(),
            indices: (0..COLUMNS * ROWS).flat_map(square).collect(),
        }
    }

    /// As rays meet it.
    pub fn occluder(&self) -> Occluder<'_> {
        let Self { name, positions, indices } = self;
        Occluder { name, positions, indices, transform: Mat4::IDENTITY, mask: None }
    }
}
