//! Spheres as files to be looked at.

use std::fmt::Write;

use airglow_scene::Blocker;
use serde_json::json;

use super::ball::Ball;
use crate::failure::{Failure, Outcome};

/// The balls of spheres, centre and radius.
fn balls(spheres: &[[f64; 4]]) -> Vec<Ball> {
    let ball = |(number, [x, y, z, radius]): (usize, &[f64; 4])| {
        let name = format!("sphere {number}");
        let center = [x, y, z].map(|value| *value as f32);
        Ball::new(&Blocker { name, center, radius: *radius as f32 })
    };
    spheres.iter().enumerate().map(ball).collect()
}

/// Wavefront OBJ, an object each.
pub fn obj(spheres: &[[f64; 4]]) -> String {
    let (mut text, mut first) = (String::new(), 1);
    for ball in balls(spheres) {
        let _ = writeln!(text, "o {}", ball.name);
        for [x, y, z] in &ball.positions {
            let _ = writeln!(text, "v {x} {y} {z}");
        }
        for corners in ball.indices.chunks_exact(3) {
            let [a, b, c] = [corners[0] + first, corners[1] + first, corners[2] + first];
            let _ = writeln!(text, "f {a} {b} {c}");
        }
        first += ball.positions.len() as u32;
    }
    text
}

/// glTF, one mesh of all.
pub fn glb(spheres: &[[f64; 4]]) -> Outcome<Vec<u8>> {
    let (mut positions, mut indices): (Vec<[f32; 3]>, Vec<u32>) = (Vec::new(), Vec::new());
    for ball in balls(spheres) {
        let first = positions.len() as u32;
        positions.extend(&ball.positions);
        indices.extend(ball.indices.iter().map(|index| index + first));
    }
    let bound = |pick: fn(f32, f32) -> f32, start: f32| {
        positions.iter().fold([start; 3], |bound, place| [0, 1, 2].map(|axis| pick(bound[axis], place[axis])))
    };
    let mut bytes: Vec<u8> = positions.as_flattened().iter().flat_map(|value| value.to_le_bytes()).collect();
    let vertices = bytes.len();
    bytes.extend(indices.iter().flat_map(|index| index.to_le_bytes()));
    let document = json!({
        "asset": {"version": "2.0", "generator": "airglow spheres"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "spheres", "mesh": 0}],
        "meshes": [{"name": "spheres", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": positions.len(),
                "min": bound(f32::min, f32::MAX), "max": bound(f32::max, f32::MIN)},
            {"bufferView": 1, "componentType": 5125, "type": "SCALAR", "count": indices.len()},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": vertices},
            {"buffer": 0, "byteOffset": vertices, "byteLength": bytes.len() - vertices},
        ],
        "buffers": [{"byteLength": bytes.len()}],
    });
    container(&document, &bytes)
}

/// The binary container: header, JSON chunk, binary chunk, each padded to four bytes (glTF 2.0, section 4.4).
fn container(document: &serde_json::Value, bytes: &[u8]) -> Outcome<Vec<u8>> {
    let mut text = serde_json::to_vec(document).map_err(Failure::work)?;
    text.resize(text.len().next_multiple_of(4), b' ');
    let total = 12 + 8 + text.len() + 8 + bytes.len();
    let Ok(total) = u32::try_from(total) else {
        return Err(Failure::input("the spheres fill more than 4 GiB; write fewer, or .json"));
    };
    let words = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    let head = words(&[0x4654_6C67, 2, total, text.len() as u32, 0x4E4F_534A]);
    Ok([head, text, words(&[bytes.len() as u32, 0x004E_4942]), bytes.to_vec()].concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_files_hold_the_spheres() {
        let spheres = [[0.0, 1.0, 0.0, 0.5], [2.0, 0.0, 0.0, 0.25]];
        let text = obj(&spheres);
        assert_eq!(text.lines().filter(|line| line.starts_with("o ")).count(), 2);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("spheres.glb");
        std::fs::write(&path, glb(&spheres).unwrap()).unwrap();
        let scene = airglow_scene::load(&path).unwrap();
        let faces = text.lines().filter(|line| line.starts_with("f ")).count();
        assert_eq!(faces, scene.meshes[0].triangle_count());
        let (low, high) = scene.bounding_box().unwrap();
        for (found, wanted) in [(low[0], -0.5), (high[0], 2.25), (high[1], 1.5)] {
            assert!((found - wanted).abs() < 0.01, "{found} and {wanted}");
        }
    }
}
