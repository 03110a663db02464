//! A sculpture on a plinth: a trefoil knot, whose strands shadow one another.

use std::f32::consts::TAU;

use glam::Vec3;

use crate::mesh::Mesh;

/// Vertices along the knot and around its strand.
const ALONG: u32 = 192;
const AROUND: u32 = 18;
/// Metres: half the knot's width, radius of the strand.
const SIZE: f32 = 0.2;
const STRAND: f32 = 0.155;
/// Steps of the plinth: half width, low and high end, metres.
const STEPS: [[f32; 3]; 4] = [[0.62, 0.0, 0.14], [0.5, 0.14, 0.24], [0.4, 0.24, 0.92], [0.47, 0.92, 1.02]];

/// The sculpture upright on a plinth at `foot`.
pub fn with_plinth(foot: Vec3) -> Mesh {
    let mut mesh = knot(foot + 1.72 * Vec3::Y);
    for [half, low, high] in STEPS {
        let half = Vec3::new(half, 0.0, half);
        mesh.append(
            &Mesh::block(foot - half + low * Vec3::Y, foot + half + high * Vec3::Y).refined(|_| 0.13),
        );
    }
    mesh
}

/// Where the strand's axis is at an angle, 0 to 2 pi.
fn axis(t: f32) -> Vec3 {
    let flat =
        Vec3::new(t.sin() + 2.0 * (2.0 * t).sin(), t.cos() - 2.0 * (2.0 * t).cos(), -1.2 * (3.0 * t).sin());
    SIZE * flat
}

fn knot(middle: Vec3) -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..ALONG {
        let t = TAU * i as f32 / ALONG as f32;
        let forwards = (axis(t + 1e-3) - axis(t - 1e-3)).normalize();
        let side = forwards.cross(Vec3::Z).normalize();
        let up = side.cross(forwards);
        for j in 0..AROUND {
            let (sine, cosine) = (TAU * j as f32 / AROUND as f32).sin_cos();
            let normal = cosine * side + sine * up;
            mesh.positions.push(middle + axis(t) + STRAND * normal);
            mesh.normals.push(normal);
        }
    }
    for i in 0..ALONG {
        for j in 0..AROUND {
            let (k, l) = ((i + 1) % ALONG, (j + 1) % AROUND);
            let at = |i: u32, j: u32| i * AROUND + j;
            mesh.indices.extend([at(i, j), at(k, j), at(k, l), at(i, j), at(k, l), at(i, l)]);
        }
    }
    mesh
}
