//! Meshes with more vertices of the same shape.

use std::collections::HashMap;

use glam::Vec3;

use crate::Mesh;

/// Cuts each triangle into four at the middles of its edges, which lie on the same surface: no vertex moves. Neighbours
/// share the new vertices. Normals and tangents of these are the halved ones' mean, of length 1.
///
/// Skins do not come along: `joints` and `weights` are emptied. Triangles whose indices are out of range are left out.
#[must_use]
pub fn subdivide(mesh: &Mesh) -> Mesh {
    let mut fine = Mesh { joints: Vec::new(), weights: Vec::new(), ..mesh.clone() };
    fine.indices = Vec::with_capacity(4 * mesh.indices.len());
    let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
    let there = |corners: &&[u32]| corners.iter().all(|corner| (*corner as usize) < mesh.positions.len());
    for corners in mesh.indices.chunks_exact(3).filter(there) {
        let [a, b, c] = [corners[0], corners[1], corners[2]];
        let mut middle = |from: u32, to: u32| {
            *middles.entry([from.min(to), from.max(to)]).or_insert_with(|| halve(&mut fine, from, to))
        };
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        fine.indices.extend([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca]);
    }
    fine.hash = fine.content_hash();
    fine
}

/// Adds the vertex between two, and returns its index.
fn halve(mesh: &mut Mesh, from: u32, to: u32) -> u32 {
    let (from, to) = (from as usize, to as usize);
    let middle = |of: &[[f32; 3]]| Vec3::from(of[from]).midpoint(Vec3::from(of[to]));
    let (position, normal) = (middle(&mesh.positions), middle(&mesh.normals));
    let facing = Vec3::from(mesh.normals[from]);
    mesh.positions.push(position.to_array());
    mesh.normals.push(normal.normalize_or(facing).to_array());
    if !mesh.tangents.is_empty() {
        let [x, y, z, sign] = mesh.tangents[from];
        let [tx, ty, tz, _] = mesh.tangents[to];
        let [x, y, z] = Vec3::new(x + tx, y + ty, z + tz).normalize_or(Vec3::new(x, y, z)).to_array();
        mesh.tangents.push([x, y, z, sign]);
    }
    if !mesh.uv0.is_empty() {
        let [a, b] = [mesh.uv0[from], mesh.uv0[to]];
        mesh.uv0.push([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
    }
    mesh.positions.len() as u32 - 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_share_the_middle_of_their_edge() {
        let square = Mesh {
            positions: vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]],
            normals: vec![[0.0, 0.0, 1.0]; 4],
            uv0: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
            indices: vec![0, 1, 2, 0, 2, 3],
            ..Mesh::default()
        };
        let fine = subdivide(&square);
        // Four corners and five edges, one of them shared.
        assert_eq!((fine.positions.len(), fine.triangle_count()), (9, 8));
        assert_eq!([fine.normals.len(), fine.uv0.len(), fine.tangents.len()], [9, 9, 0]);
        let area = |mesh: &Mesh| -> f32 {
            let corner = |i: &u32| Vec3::from(mesh.positions[*i as usize]);
            let areas = mesh.indices.chunks_exact(3).map(|i| {
                let [a, b, c] = [corner(&i[0]), corner(&i[1]), corner(&i[2])];
                0.5 * (b - a).cross(c - a).z
            });
            areas.sum()
        };
        assert_eq!((area(&square), area(&fine)), (4.0, 4.0), "the same surface, with the same winding");
        let at = fine.positions.iter().position(|p| *p == [1.0, 1.0, 0.0]).unwrap();
        assert_eq!((fine.uv0[at], fine.normals[at]), ([0.5, 0.5], [0.0, 0.0, 1.0]));
        assert_ne!(fine.hash, square.content_hash());
    }
}
