//! A row of columns with round arches and the wall that they carry.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use crate::mesh::Mesh;

/// Metres: the top of the wall, where arches spring from, and half the thickness of the wall.
pub const HEIGHT: f32 = 4.5;
const SPRINGING: f32 = 2.45;
const HALF: f32 = 0.2;
/// How far an arch stops short of the axis of a column.
const PIER: f32 = 0.24;
/// Faces of an arch's curve and around a column.
const CURVE: u32 = 12;
const AROUND: u32 = 14;

/// Half width and height of a column, from its foot to the springing of the arches, metres: a base on a square block, a
/// shaft that swells a little, and a capital.
const PROFILE: [[f32; 2]; 14] = [
    [0.250, 0.16],
    [0.262, 0.23],
    [0.245, 0.26],
    [0.205, 0.28],
    [0.200, 0.31],
    [0.175, 0.34],
    [0.176, 0.85],
    [0.168, 1.50],
    [0.160, 1.85],
    [0.152, 2.02],
    [0.172, 2.04],
    [0.158, 2.10],
    [0.190, 2.20],
    [0.250, 2.29],
];

/// From axis to axis of its first and last column.
pub struct Arcade {
    pub from: Vec3,
    pub to: Vec3,
    pub bays: u32,
}

impl Arcade {
    fn along(&self) -> Vec3 {
        (self.to - self.from).normalize()
    }

    fn bay(&self) -> f32 {
        self.from.distance(self.to) / self.bays as f32
    }

    /// The wall over the arches: the face on one side, 1 or -1; and the other one, the undersides of the arches and the top.
    pub fn wall(&self, front: f32) -> [Mesh; 2] {
        let (along, bay) = (self.along(), self.bay());
        let across = along.cross(Vec3::Y);
        let [mut face, mut mesh] = [Mesh::default(), Mesh::default()];
        let radius = 0.5 * bay - PIER;
        for number in 0..self.bays {
            let middle = self.from + (number as f32 + 0.5) * bay * along;
            // Places along the bay and heights of the lower edge: pier, arch, pier.
            let curve = |step: u32| {
                let angle = PI * step as f32 / CURVE as f32;
                [-radius * angle.cos(), SPRINGING + radius * angle.sin()]
            };
            let mut edge = vec![[-0.5 * bay, SPRINGING]];
            edge.extend((0..=CURVE).map(curve));
            edge.push([0.5 * bay, SPRINGING]);
            for pair in edge.windows(2) {
                let [[a, low], [b, high]] = [pair[0], pair[1]];
                let at = |t: f32, y: f32, side: f32| middle + t * along + y * Vec3::Y + side * HALF * across;
                for side in [1.0, -1.0] {
                    let corners =
                        [at(a, low, side), at(b, high, side), at(b, HEIGHT, side), at(a, HEIGHT, side)];
                    let mesh = if side == front { &mut face } else { &mut mesh };
                    mesh.push_quad(corners, [side * across; 4]);
                }
                let inward = |t: f32, y: f32| match y > SPRINGING || t.abs() <= radius {
                    true => -(t * along + (y - SPRINGING) * Vec3::Y).normalize_or(Vec3::Y),
                    false => Vec3::NEG_Y,
                };
                let flat = a.abs() > radius + 1e-4 || b.abs() > radius + 1e-4;
                let [n, m] = if flat { [Vec3::NEG_Y; 2] } else { [inward(a, low), inward(b, high)] };
                mesh.push_quad(
                    [at(a, low, -1.0), at(b, high, -1.0), at(b, high, 1.0), at(a, low, 1.0)],
                    [n, m, m, n],
                );
            }
        }
        let [from, to] = [self.from, self.to].map(|p| p + HEIGHT * Vec3::Y);
        let side = HALF * across;
        mesh.push_quad([from - side, to - side, to + side, from + side], [Vec3::Y; 4]);
        [face, mesh]
    }

    /// The columns, each on a square block and below another, a step that they all stand on, and a cornice.
    pub fn columns(&self) -> Mesh {
        let (along, bay) = (self.along(), self.bay());
        let mut mesh = Mesh::default();
        for number in 0..=self.bays {
            let foot = self.from + number as f32 * bay * along;
            mesh.append(&column(foot));
            let block = |low: f32, high: f32, half: f32| {
                let half = Vec3::new(half, 0.0, half);
                Mesh::block(foot - half + low * Vec3::Y, foot + half + high * Vec3::Y).refined(|_| 0.32)
            };
            mesh.append(&block(0.08, 0.16, 0.28));
            mesh.append(&block(2.29, SPRINGING, 0.27));
        }
        let strip = |low: f32, high: f32, half: f32| {
            let half = half * (along.abs() + along.cross(Vec3::Y).abs());
            let (a, b) = (self.from.min(self.to) - half, self.from.max(self.to) + half);
            Mesh::block(a + low * Vec3::Y, b + high * Vec3::Y).refined(|p| 0.4 + 0.03 * (5.0 - p.z).max(0.0))
        };
        mesh.append(&strip(0.0, 0.08, 0.36));
        mesh.append(&strip(HEIGHT - 0.22, HEIGHT - 0.1, HALF + 0.06));
        mesh.append(&strip(HEIGHT - 0.1, HEIGHT + 0.02, HALF + 0.13));
        mesh
    }
}

/// The profile turned about the axis.
fn column(foot: Vec3) -> Mesh {
    let mut mesh = Mesh::default();
    let slope = |from: usize, to: usize| {
        let [a, b] = [PROFILE[from], PROFILE[to]];
        glam::Vec2::new(b[1] - a[1], a[0] - b[0]).normalize()
    };
    for (ring, [radius, height]) in PROFILE.into_iter().enumerate() {
        let before = slope(ring.saturating_sub(1), ring.max(1));
        let after = slope(ring.min(PROFILE.len() - 2), (ring + 1).min(PROFILE.len() - 1));
        let normal = (before + after).normalize();
        for step in 0..AROUND {
            let (sine, cosine) = (TAU * step as f32 / AROUND as f32).sin_cos();
            let out = Vec3::new(cosine, 0.0, -sine);
            mesh.positions.push(foot + radius * out + height * Vec3::Y);
            mesh.normals.push(normal.x * out + normal.y * Vec3::Y);
        }
    }
    for ring in 0..PROFILE.len() as u32 - 1 {
        for step in 0..AROUND {
            let next = (step + 1) % AROUND;
            let [a, b] = [ring * AROUND + step, ring * AROUND + next];
            mesh.indices.extend([a, b, b + AROUND, a, b + AROUND, a + AROUND]);
        }
    }
    mesh
}
