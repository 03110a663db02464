//! Emitters of scene files as triangles.

use glam::Vec3;

use crate::{Emitter, EmitterShape};

/// Positions in the world, and three indices for each triangle, counter-clockwise from without: the twelve of a box, 128
/// of a sphere.
#[must_use]
pub fn emitter(emitter: &Emitter) -> (Vec<[f32; 3]>, Vec<u32>) {
    let middle = Vec3::from(emitter.center);
    match emitter.shape {
        EmitterShape::Box { size } => block(middle, Vec3::from(size)),
        EmitterShape::Sphere { radius } => sphere(middle, radius),
    }
}

fn block(middle: Vec3, size: Vec3) -> (Vec<[f32; 3]>, Vec<u32>) {
    let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) - 0.5;
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let indices = sides.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
    ((0..8).map(|i| (middle + size * corner(i)).to_array()).collect(), indices)
}

/// An octahedron whose sides are parted in four twice, its corners on the sphere.
fn sphere(middle: Vec3, radius: f32) -> (Vec<[f32; 3]>, Vec<u32>) {
    let mut triangles: Vec<[Vec3; 3]> = (0..8)
        .map(|i: u32| {
            let sign = |bit: u32| if i >> bit & 1 == 0 { 1.0 } else { -1.0 };
            let [x, y, z] = [Vec3::X * sign(0), Vec3::Y * sign(1), Vec3::Z * sign(2)];
            if x.cross(y).dot(z) > 0.0 { [x, y, z] } else { [x, z, y] }
        })
        .collect();
    for _ in 0..2 {
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let [d, e, f] = [a + b, b + c, c + a].map(Vec3::normalize);
                [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
            })
            .collect();
    }
    let positions: Vec<_> = triangles.iter().flatten().map(|p| (middle + radius * *p).to_array()).collect();
    let indices = (0..positions.len() as u32).collect();
    (positions, indices)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_are_closed_and_face_outwards() {
        let center = [1.0, 2.0, 3.0];
        let shapes = [
            (EmitterShape::Box { size: [2.0, 1.0, 4.0] }, 8.0, 12, 1e-5),
            (EmitterShape::Sphere { radius: 2.0 }, 32.0 / 3.0 * std::f32::consts::PI, 128, 0.1),
        ];
        for (shape, volume, count, tolerance) in shapes {
            let (positions, indices) =
                emitter(&Emitter { name: String::new(), center, shape, radiance: [1.0; 3], to: None });
            let corner = |i: u32| Vec3::from(positions[i as usize]) - Vec3::from(center);
            let parts =
                indices.chunks_exact(3).map(|i| corner(i[0]).dot(corner(i[1]).cross(corner(i[2]))) / 6.0);
            let found: f32 = parts.sum();
            assert_eq!(indices.len(), 3 * count);
            assert!((found / volume - 1.0).abs() < tolerance, "{found} is not {volume}");
        }
    }
}
