//! Makes `assets/mesh/cloister.glb`, columns and arches under the open sky, from `assets/mesh/nave.glb`.
//!
//! The nave is one white mesh without a camera. This keeps the connected pieces that stand without walls and
//! vault (floor, columns, arches, ribs, altar), gives each a material, refines what needs it (light is stored
//! per vertex), and adds two blocks to stand things on and a camera.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use glam::Vec3;
use serde_json::{Value, json};

use crate::error::Error;
use crate::glb::{self, Buffers};
use crate::mesh::Mesh;

/// Where the camera stands and what it looks at, metres.
const EYE: Vec3 = Vec3::new(1.6, 1.4, -5.3);
const TARGET: Vec3 = Vec3::new(-0.45, 1.65, 0.0);

/// Low and high corners of what carries the statue and the teapot, metres.
const BLOCKS: [(Vec3, Vec3); 2] = [
    (Vec3::new(-0.5, 0.0, -2.0), Vec3::new(0.5, 0.9, -1.0)),
    (Vec3::new(-2.3, 0.0, -2.4), Vec3::new(-1.6, 0.5, -1.7)),
];

/// Longest edge at the blocks, metres: their contact shadows fall there.
const FINE_EDGE: f32 = 0.08;

/// Longest edge at a point: fine at the blocks, growing slowly with the distance from them, so that edges of
/// one triangle ask for nearly the same.
fn longest_edge(point: Vec3, far: f32) -> f32 {
    let distance = |(low, high): &(Vec3, Vec3)| point.distance(point.clamp(*low, *high));
    let nearest = BLOCKS.iter().map(distance).fold(f32::INFINITY, f32::min);
    (FINE_EDGE + 0.25 * (nearest - 0.1).max(0.0)).min(far)
}

/// A part of the building.
struct Part {
    name: &'static str,
    /// Linear Rec. 709.
    base_colour: [f32; 3],
    roughness: f32,
    /// Longest edge after refinement, metres; the nave's own spacing is fine enough for the rest.
    longest_edge: f32,
}

const fn part(name: &'static str, base_colour: [f32; 3], roughness: f32, longest_edge: f32) -> Part {
    Part { name, base_colour, roughness, longest_edge }
}

const PARTS: [Part; 5] = [
    part("floor", [0.36, 0.31, 0.27], 0.5, 0.3),
    part("column", [0.58, 0.51, 0.43], 0.8, 0.5),
    part("arch", [0.62, 0.55, 0.47], 0.8, 0.5),
    part("rib", [0.55, 0.47, 0.40], 0.8, 0.5),
    part("altar", [0.76, 0.74, 0.70], 0.4, 0.1),
];

/// Reads `nave.glb` below `assets` and writes `cloister.glb` beside it.
pub fn make(assets: &Path) -> Result<(), Error> {
    let nave = Mesh::read(&assets.join("mesh/nave.glb"))?;
    let mut parts: Vec<Mesh> = PARTS.iter().map(|_| Mesh::default()).collect();
    let components = nave.components();
    for component in components.values() {
        let (low, high) = nave.bounds(component);
        for triangle in component {
            if let Some(part) = classify(&nave, triangle, component.len(), low, high) {
                parts[part].push_triangle(&nave, triangle);
            }
        }
    }
    let refined = parts
        .iter()
        .zip(&PARTS)
        .map(|(mesh, part)| mesh.refined(|middle| longest_edge(middle, part.longest_edge)));
    let blocks = BLOCKS.map(|(low, high)| Mesh::block(low, high).refined(|_| 1.5 * FINE_EDGE));
    write(&assets.join("mesh/cloister.glb"), &refined.collect::<Vec<_>>(), &blocks)
}

/// The part one triangle belongs to: by the size of its connected piece, and within the shell (the one piece
/// as long as the hall) by where it faces. `None` for walls, vault and pews.
fn classify(nave: &Mesh, triangle: &[u32; 3], size: usize, low: Vec3, high: Vec3) -> Option<usize> {
    let extent = high - low;
    let name = match size {
        10_000.. if nave.face_normal(triangle).y > 0.9 && nave.centre(triangle).y < 0.5 => "floor",
        1000..2000 => "column",
        600..1000 => "rib",
        100..600 => "arch",
        0..100 if extent.z > 0.9 => "altar",
        _ => return None,
    };
    PARTS.iter().position(|part| part.name == name)
}

fn write(path: &Path, parts: &[Mesh], blocks: &[Mesh]) -> Result<(), Error> {
    let mut buffers = Buffers::default();
    let building: Vec<Value> =
        parts.iter().enumerate().map(|(index, part)| buffers.primitive(part, index)).collect();
    let altar = PARTS.len() - 1;
    let stands: Vec<Value> = blocks.iter().map(|block| buffers.primitive(block, altar)).collect();
    let materials: Vec<Value> = PARTS
        .iter()
        .map(|Part { name, base_colour, roughness, .. }| glb::material(name, *base_colour, 0.0, *roughness))
        .collect();
    buffers.write(
        path,
        json!({
            "asset": {"version": "2.0", "generator": "xtask cloister", "extras": {"licence": "CC0"}},
            "scene": 0,
            "scenes": [{"nodes": [0, 1, 2]}],
            "nodes": [
                {"name": "building", "mesh": 0},
                {"name": "blocks", "mesh": 1},
                {"name": "camera", "camera": 0, "translation": EYE.to_array(), "rotation": glb::look(EYE, TARGET)},
            ],
            "meshes": [{"name": "building", "primitives": building}, {"name": "blocks", "primitives": stands}],
            "materials": materials,
            "cameras": [{"type": "perspective", "name": "aisle", "perspective": {"yfov": 0.95, "znear": 0.1, "zfar": 100.0}}],
        }),
    )
}

impl Mesh {
    /// Triangles grouped by connected piece, vertices welded by position.
    fn components(&self) -> BTreeMap<usize, Vec<[u32; 3]>> {
        let mut welded = HashMap::new();
        let vertex: Vec<usize> = self
            .positions
            .iter()
            .enumerate()
            .map(|(index, position)| *welded.entry(position.to_array().map(f32::to_bits)).or_insert(index))
            .collect();
        let mut parent: Vec<usize> = (0..self.positions.len()).collect();
        for triangle in self.triangles() {
            let [a, b, c] = triangle.map(|index| root(&mut parent, vertex[index as usize]));
            parent[b] = a;
            let c = root(&mut parent, c);
            parent[c] = root(&mut parent, a);
        }
        let mut components: BTreeMap<usize, Vec<[u32; 3]>> = BTreeMap::new();
        for triangle in self.triangles() {
            components.entry(root(&mut parent, vertex[triangle[0] as usize])).or_default().push(triangle);
        }
        components
    }
}

fn root(parent: &mut [usize], mut index: usize) -> usize {
    while parent[index] != index {
        parent[index] = parent[parent[index]];
        index = parent[index];
    }
    index
}
