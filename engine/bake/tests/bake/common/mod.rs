//! Shapes and comparisons that the tests share.
#![allow(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

use airglow_bake::{Baked, Mesh, Occluder, Occluders, Settings, Silent, Threads, bake};
use glam::{Mat4, Vec3};

/// A mesh that owns its arrays.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub indices: Vec<u32>,
}

impl Shape {
    pub fn mesh(&self) -> Mesh<'_> {
        Mesh { name: "shape", positions: &self.positions, normals: &self.normals, indices: &self.indices }
    }

    /// One vertex and no triangle.
    pub fn vertex(position: Vec3, normal: Vec3) -> Self {
        Self { positions: vec![position.to_array()], normals: vec![normal.to_array()], indices: vec![] }
    }

    /// A grid of `side`² quads over four corners, normals along `normal`.
    pub fn grid(corner: Vec3, across: Vec3, along: Vec3, side: u32, normal: Vec3) -> Self {
        let mut shape = Self::default();
        for row in 0..=side {
            for column in 0..=side {
                let (u, v) = (column as f32 / side as f32, row as f32 / side as f32);
                shape.positions.push((corner + across * u + along * v).to_array());
                shape.normals.push(normal.to_array());
            }
        }
        shape.connect(side, side);
        shape
    }

    /// A closed box of half edge 1 with flat normals pointing inward, `side`² quads a face.
    pub fn room(side: u32) -> Self {
        let mut room = Self::default();
        for axis in 0..3 {
            for sign in [-1.0, 1.0] {
                let out = Vec3::AXES[axis] * sign;
                let (across, along) = (Vec3::AXES[(axis + 1) % 3], Vec3::AXES[(axis + 2) % 3]);
                room.join(&Self::grid(out - across - along, across * 2.0, along * 2.0, side, -out));
            }
        }
        room
    }

    /// A sphere about the origin whose radius depends on the direction; normals by differences.
    pub fn sphere(columns: u32, rows: u32, radius: impl Fn(Vec3) -> f32) -> Self {
        use std::f32::consts::{PI, TAU};
        let point = |u: f32, v: f32| {
            let (sin, cos) = (TAU * u).sin_cos();
            let direction = Vec3::new((PI * v).sin() * cos, (PI * v).cos(), (PI * v).sin() * sin);
            direction * radius(direction)
        };
        let mut shape = Self::default();
        for row in 0..=rows {
            for column in 0..=columns {
                // The seam and the poles meet themselves exactly.
                let (u, v) = ((column % columns) as f32 / columns as f32, row as f32 / rows as f32);
                let here = match row {
                    0 => Vec3::Y * radius(Vec3::Y),
                    _ if row == rows => Vec3::NEG_Y * radius(Vec3::NEG_Y),
                    _ => point(u, v),
                };
                let step = 1e-3;
                let across = point(u + step, v) - point(u - step, v);
                let along = point(u, v + step) - point(u, v - step);
                // Across vanishes at the poles.
                let pole = row == 0 || row == rows;
                let normal = if pole { here } else { along.cross(across).normalize_or(here) };
                shape.positions.push(here.to_array());
                shape.normals.push((normal * normal.dot(here).signum()).to_array());
            }
        }
        shape.connect(columns, rows);
        shape
    }

    pub fn bumpy_sphere(columns: u32, rows: u32) -> Self {
        Self::sphere(columns, rows, |d| {
            1.0 + 0.3 * (d.x * 9.0).sin() * (d.y * 11.0).sin() * (d.z * 10.0).sin()
        })
    }

    pub fn join(&mut self, other: &Self) {
        let first = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        self.normals.extend(&other.normals);
        self.indices.extend(other.indices.iter().map(|index| index + first));
    }

    fn connect(&mut self, columns: u32, rows: u32) {
        for row in 0..rows {
            for column in 0..columns {
                let here = row * (columns + 1) + column;
                let below = here + columns + 1;
                self.indices.extend([here, below, here + 1, here + 1, below, below + 1]);
            }
        }
    }
}

/// Bakes on one thread, the mesh and the occluders under one matrix.
pub fn bake_at(mesh: &Mesh<'_>, transform: Mat4, occluders: &[Occluder<'_>], settings: &Settings) -> Baked {
    let placed: Vec<_> =
        occluders.iter().map(|o| Occluder { transform: transform * o.transform, ..*o }).collect();
    let occluders = Occluders::build(&placed).unwrap();
    bake(mesh, transform, &occluders, settings, &Threads::ONE, &mut Silent).unwrap()
}

/// |a - b| / |b|.
pub fn relative(a: &[f32], b: &[f64]) -> f64 {
    let difference: f64 = a.iter().zip(b).map(|(a, b)| (f64::from(*a) - b).powi(2)).sum();
    (difference / b.iter().map(|b| b * b).sum::<f64>()).sqrt()
}

pub fn widen(values: &[f32]) -> Vec<f64> {
    values.iter().map(|value| f64::from(*value)).collect()
}

/// Placements that strain rounding: far from the origin, tiny, huge, turned.
pub fn placements() -> Vec<Mat4> {
    let turn = glam::Quat::from_euler(glam::EulerRot::XYZ, 0.4, 1.1, -2.0);
    vec![
        Mat4::IDENTITY,
        Mat4::from_quat(turn),
        Mat4::from_rotation_translation(turn, Vec3::new(100.0, -3.0, 57.0)),
        Mat4::from_scale_rotation_translation(Vec3::splat(0.01), turn, Vec3::new(0.3, 0.2, 0.1)),
        Mat4::from_scale_rotation_translation(Vec3::splat(1e-12), turn, Vec3::ZERO),
        Mat4::from_scale_rotation_translation(Vec3::splat(1e12), turn, Vec3::splat(1e12)),
        Mat4::from_scale_rotation_translation(Vec3::new(-2.0, 2.0, 2.0), turn, Vec3::ONE),
        Mat4::from_scale_rotation_translation(Vec3::new(1.0, 3.0, 0.5), turn, Vec3::ONE),
    ]
}
