//! A small indexed mesh for the tools that make assets: read, split, refine.

use std::collections::HashMap;
use std::f32::consts::{PI, TAU};
use std::path::Path;

use glam::Vec3;

use crate::error::Error;

/// Positions in metres, unit normals, three indices a triangle.
#[derive(Default)]
pub struct Mesh {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub indices: Vec<u32>,
}

impl Mesh {
    /// The first primitive of the first mesh of a GLB file that carries its own buffer.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let missing = |what: &str| Error::Asset { path: path.to_owned(), message: format!("has no {what}") };
        let bytes = std::fs::read(path).map_err(|source| Error::io(path, source))?;
        let file = gltf::Gltf::from_slice(&bytes)
            .map_err(|error| Error::Asset { path: path.to_owned(), message: error.to_string() })?;
        let blob = file.blob.as_deref().ok_or_else(|| missing("binary chunk"))?;
        let mut primitives = file.meshes().flat_map(|mesh| mesh.primitives());
        let primitive = primitives.next().ok_or_else(|| missing("mesh"))?;
        let reader = primitive.reader(|_| Some(blob));
        let vectors = |values: Option<Vec<[f32; 3]>>, what| {
            values.map(|v| v.into_iter().map(Vec3::from).collect()).ok_or_else(|| missing(what))
        };
        Ok(Self {
            positions: vectors(reader.read_positions().map(Iterator::collect), "positions")?,
            normals: vectors(reader.read_normals().map(Iterator::collect), "normals")?,
            indices: reader.read_indices().ok_or_else(|| missing("indices"))?.into_u32().collect(),
        })
    }

    /// An axis-aligned block with outward normals, every face its own four vertices.
    pub fn block(low: Vec3, high: Vec3) -> Self {
        let mut mesh = Self::default();
        for axis in 0..3 {
            for side in [0.0, 1.0] {
                let corner = |s: f32, t: f32| {
                    let mut unit = [0.0; 3];
                    unit[axis] = side;
                    unit[(axis + 1) % 3] = s;
                    unit[(axis + 2) % 3] = t;
                    low + (high - low) * Vec3::from(unit)
                };
                let mut normal = [0.0; 3];
                normal[axis] = 2.0 * side - 1.0;
                let base = mesh.positions.len() as u32;
                mesh.positions.extend([
                    corner(0.0, 0.0),
                    corner(1.0, 0.0),
                    corner(1.0, 1.0),
                    corner(0.0, 1.0),
                ]);
                mesh.normals.extend([Vec3::from(normal); 4]);
                let order = if side > 0.5 { [0, 1, 2, 0, 2, 3] } else { [0, 2, 1, 0, 3, 2] };
                mesh.indices.extend(order.map(|corner| base + corner));
            }
        }
        mesh
    }

    /// A sphere about the origin of `rows` times `columns` quadrilaterals.
    pub fn sphere(radius: f32, rows: u32, columns: u32) -> Self {
        let mut mesh = Self::default();
        for row in 0..=rows {
            let (sine, cosine) = (PI * row as f32 / rows as f32).sin_cos();
            for column in 0..=columns {
                let (z, x) = (TAU * column as f32 / columns as f32).sin_cos();
                let normal = Vec3::new(sine * x, cosine, sine * z);
                mesh.positions.push(radius * normal);
                mesh.normals.push(normal);
            }
        }
        for row in 0..rows {
            for column in 0..columns {
                let a = row * (columns + 1) + column;
                let b = a + columns + 1;
                // Next to the poles one of the two has no area.
                if row > 0 {
                    mesh.indices.extend([a, a + 1, b]);
                }
                if row + 1 < rows {
                    mesh.indices.extend([a + 1, b + 1, b]);
                }
            }
        }
        mesh
    }

    /// Index triples.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.indices.chunks_exact(3).map(|triangle| [triangle[0], triangle[1], triangle[2]])
    }

    /// Unit normal of a triangle's plane; zero where it has no area.
    pub fn face_normal(&self, triangle: &[u32; 3]) -> Vec3 {
        let [a, b, c] = triangle.map(|index| self.positions[index as usize]);
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// Mean of a triangle's corners.
    pub fn centre(&self, triangle: &[u32; 3]) -> Vec3 {
        triangle.iter().map(|&index| self.positions[index as usize]).sum::<Vec3>() / 3.0
    }

    /// Box around some triangles.
    pub fn bounds(&self, triangles: &[[u32; 3]]) -> (Vec3, Vec3) {
        let corners = triangles.iter().flatten().map(|&index| self.positions[index as usize]);
        corners.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
    }

    /// Box around all vertices.
    pub fn extent(&self) -> (Vec3, Vec3) {
        let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        self.positions.iter().fold(start, |(low, high), &p| (low.min(p), high.max(p)))
    }

    /// Appends a triangle of another mesh with its own three vertices; [`Mesh::refined`] welds them.
    pub fn push_triangle(&mut self, other: &Mesh, triangle: &[u32; 3]) {
        for &index in triangle {
            self.indices.push(self.positions.len() as u32);
            self.positions.push(other.positions[index as usize]);
            self.normals.push(other.normals[index as usize]);
        }
    }

    /// Appends a quadrilateral; it is wound so that it is seen from where its normals point.
    pub fn push_quad(&mut self, corners: [Vec3; 4], normals: [Vec3; 4]) {
        let base = self.positions.len() as u32;
        let [a, b, c, d] = corners;
        let turned = (c - a).cross(d - b).dot(normals.iter().sum()) < 0.0;
        self.positions.extend(corners);
        self.normals.extend(normals);
        let order = if turned { [0, 2, 1, 0, 3, 2] } else { [0, 1, 2, 0, 2, 3] };
        self.indices.extend(order.map(|corner| base + corner));
    }

    /// Appends another mesh.
    pub fn append(&mut self, other: &Mesh) {
        let base = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        self.normals.extend(&other.normals);
        self.indices.extend(other.indices.iter().map(|index| base + index));
    }

    /// The mesh with equal vertices welded and every edge longer than `longest` of its middle halved until none is.
    ///
    /// An edge is split by what it knows itself, so that two triangles that share it split alike and no
    /// crack opens between them.
    pub fn refined(&self, longest: impl Fn(Vec3) -> f32) -> Self {
        let mut welder = Welder::default();
        let mut queue: Vec<[u32; 3]> = Vec::new();
        for triangle in self.triangles() {
            queue
                .push(triangle.map(|index| {
                    welder.vertex(self.positions[index as usize], self.normals[index as usize])
                }));
        }
        while let Some([a, b, c]) = queue.pop() {
            // Times by which an edge is too long.
            let excess = |i: u32, j: u32| {
                let [from, to] = [i, j].map(|index| welder.mesh.positions[index as usize]);
                from.distance(to) / longest((from + to) * 0.5)
            };
            let edges = [(a, b, c, excess(a, b)), (b, c, a, excess(b, c)), (c, a, b, excess(c, a))];
            let (from, to, opposite, worst) =
                edges.into_iter().max_by(|x, y| x.3.total_cmp(&y.3)).unwrap_or(edges[0]);
            if worst <= 1.0 {
                welder.mesh.indices.extend([a, b, c]);
                continue;
            }
            let middle = welder.middle(from, to);
            queue.extend([[from, middle, opposite], [middle, to, opposite]]);
        }
        welder.mesh
    }
}

/// Builds a mesh in which vertices with the same position and normal are one.
#[derive(Default)]
struct Welder {
    mesh: Mesh,
    known: HashMap<[u32; 6], u32>,
}

impl Welder {
    fn vertex(&mut self, position: Vec3, normal: Vec3) -> u32 {
        let [px, py, pz] = position.to_array().map(f32::to_bits);
        let [nx, ny, nz] = normal.to_array().map(f32::to_bits);
        *self.known.entry([px, py, pz, nx, ny, nz]).or_insert_with(|| {
            self.mesh.positions.push(position);
            self.mesh.normals.push(normal);
            self.mesh.positions.len() as u32 - 1
        })
    }

    fn middle(&mut self, a: u32, b: u32) -> u32 {
        // The sum does not depend on the order of the two ends: neighbours get the same bits.
        let [a, b] = [a as usize, b as usize];
        let position = (self.mesh.positions[a] + self.mesh.positions[b]) * 0.5;
        let normal = (self.mesh.normals[a] + self.mesh.normals[b]).normalize_or(self.mesh.normals[a]);
        self.vertex(position, normal)
    }
}
