//! A part of a mesh that stands for the whole: runs of consecutive triangles, evenly spread over its list.

use airglow_bake::Mesh;

/// Triangles of a run: long enough that most vertices keep all the triangles around them.
const RUN: usize = 64;

/// A mesh of its own, made of some triangles of another.
pub struct Subset<'a> {
    name: &'a str,
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    indices: Vec<u32>,
}

impl<'a> Subset<'a> {
    /// About `vertices` vertices of `mesh`, or all of them if it has no more.
    pub fn new(mesh: &Mesh<'a>, vertices: usize) -> Self {
        if mesh.positions.len() <= vertices {
            let (positions, normals) = (mesh.positions.to_vec(), mesh.normals.to_vec());
            return Self { name: mesh.name, positions, normals, indices: mesh.indices.to_vec() };
        }
        let every = mesh.positions.len().div_ceil(vertices.max(1));
        let mut part =
            Self { name: mesh.name, positions: Vec::new(), normals: Vec::new(), indices: Vec::new() };
        let mut taken = vec![None; mesh.positions.len()];
        for run in mesh.indices.chunks(3 * RUN).step_by(every) {
            for &index in run {
                let (Some(place), Some(&position), Some(&normal)) = (
                    taken.get_mut(index as usize),
                    mesh.positions.get(index as usize),
                    mesh.normals.get(index as usize),
                ) else {
                    continue;
                };
                let number = *place.get_or_insert_with(|| {
                    part.positions.push(position);
                    part.normals.push(normal);
                    part.positions.len() as u32 - 1
                });
                part.indices.push(number);
            }
        }
        part
    }

    /// As the bake takes it.
    pub fn mesh(&self) -> Mesh<'_> {
        Mesh { name: self.name, positions: &self.positions, normals: &self.normals, indices: &self.indices }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_keeps_whole_triangles_and_a_small_mesh_all_of_them() {
        let positions: Vec<[f32; 3]> = (0..3000).map(|index| [index as f32, 0.0, 0.0]).collect();
        let normals = vec![[0.0, 1.0, 0.0]; 3000];
        let indices: Vec<u32> = (0..3000).collect();
        let mesh = Mesh { name: "strip", positions: &positions, normals: &normals, indices: &indices };
        assert_eq!(Subset::new(&mesh, 3000).mesh().indices, indices);
        let part = Subset::new(&mesh, 1000);
        let part = part.mesh();
        assert!((600..=1200).contains(&part.positions.len()), "{} vertices", part.positions.len());
        for triangle in part.indices.chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|corner| part.positions[triangle[corner] as usize][0]);
            assert_eq!((b - a, c - a, a % 3.0), (1.0, 2.0, 0.0));
        }
    }
}
