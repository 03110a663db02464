//! What a camera sees: the ground and the figure, one receiver a pixel.

use airglow_scene::FloatImage;
use glam::{DVec3, Vec3};

/// Pixels of a side of a panel.
pub const SIDE: usize = 192;
const EYE: Vec3 = Vec3::new(2.3, 2.0, 3.1);
const TARGET: Vec3 = Vec3::new(0.1, 0.55, -0.1);
/// Half of the height of what is seen at the distance 1.
const SLOPE: f32 = 0.36;

/// Receivers of the pixels, row by row.
pub struct Picture {
    /// Where the ray of the pixel ends.
    pub places: Vec<[f32; 3]>,
    /// The surface there.
    pub normals: Vec<[f32; 3]>,
    /// Whether it is the ground.
    pub ground: Vec<bool>,
}

/// Follows a ray through each pixel to the figure or the ground at height 0.
pub fn trace(positions: &[[f32; 3]], indices: &[u32]) -> Picture {
    let forward = (TARGET - EYE).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let triangles: Vec<[Vec3; 3]> =
        indices.chunks_exact(3).map(|t| [0, 1, 2].map(|i| Vec3::from(positions[t[i] as usize]))).collect();
    let (mut places, mut normals, mut ground) = (Vec::new(), Vec::new(), Vec::new());
    for at in 0..SIDE * SIDE {
        let place = |pixel: usize| (2.0 * (pixel as f32 + 0.5) / SIDE as f32 - 1.0) * SLOPE;
        let direction = (forward + place(at % SIDE) * right - place(at / SIDE) * up).normalize();
        let (mut end, mut normal) = (if direction.y < 0.0 { -EYE.y / direction.y } else { 50.0 }, Vec3::Y);
        let mut on_ground = true;
        for [a, b, c] in &triangles {
            let (p, q) = (*b - *a, *c - *a);
            let across = direction.cross(q);
            let volume = p.dot(across);
            let to_eye = EYE - *a;
            let u = to_eye.dot(across) / volume;
            let w = to_eye.cross(p);
            let (v, distance) = (direction.dot(w) / volume, q.dot(w) / volume);
            if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 && distance < end {
                (end, normal, on_ground) = (distance, p.cross(q).normalize(), false);
            }
        }
        // Off the figure by a hair, so that the rays of the truth do not start within it.
        let hair = if on_ground { 0.0 } else { 2e-3 };
        places.push((EYE + end * direction + hair * normal).to_array());
        normals.push(normal.to_array());
        ground.push(on_ground);
    }
    Picture { places, normals, ground }
}

/// Panels from left to right.
pub fn beside(panels: &[Vec<DVec3>]) -> FloatImage {
    let width = SIDE * panels.len();
    let pixel = |at: usize| {
        let (x, y) = (at % width, at / width);
        panels[x / SIDE][y * SIDE + x % SIDE].as_vec3().max(Vec3::ZERO).to_array()
    };
    FloatImage { width, height: SIDE, pixels: (0..width * SIDE).map(pixel).collect() }
}
