//! Writes the GLB files that this project makes itself (glTF 2.0, section 4.4).

use std::path::Path;

use glam::{Quat, Vec2, Vec3};
use serde_json::{Value, json};

use crate::error::Error;
use crate::mesh::Mesh;

/// The binary chunk of a file while meshes are added, and what describes it.
#[derive(Default)]
pub struct Buffers {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffers {
    /// Adds a mesh; returns the primitive that draws it.
    pub fn primitive(&mut self, mesh: &Mesh, material: usize) -> Value {
        let (low, high) = mesh.extent();
        let count = mesh.positions.len();
        let positions = self.accessor(
            bytemuck::cast_slice(&mesh.positions),
            json!({"componentType": 5126, "type": "VEC3", "count": count, "min": low.to_array(), "max": high.to_array()}),
        );
        let normals = self.accessor(
            bytemuck::cast_slice(&mesh.normals),
            json!({"componentType": 5126, "type": "VEC3", "count": count}),
        );
        let indices = self.accessor(
            bytemuck::cast_slice(&mesh.indices),
            json!({"componentType": 5125, "type": "SCALAR", "count": mesh.indices.len()}),
        );
        json!({"attributes": {"POSITION": positions, "NORMAL": normals}, "indices": indices, "material": material})
    }

    /// Adds texture coordinates; returns the accessor that a primitive names as `TEXCOORD_0`.
    pub fn texture_coordinates(&mut self, coordinates: &[Vec2]) -> usize {
        let description = json!({"componentType": 5126, "type": "VEC2", "count": coordinates.len()});
        self.accessor(bytemuck::cast_slice(coordinates), description)
    }

    /// Adds what `description` says of the bytes; returns the accessor.
    pub fn accessor(&mut self, bytes: &[u8], mut description: Value) -> usize {
        self.views.push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend_from_slice(bytes);
        description["bufferView"] = json!(self.views.len() - 1);
        self.accessors.push(description);
        self.accessors.len() - 1
    }

    /// Writes the file: `document` with what was added.
    pub fn write(self, path: &Path, mut document: Value) -> Result<(), Error> {
        document["accessors"] = json!(self.accessors);
        document["bufferViews"] = json!(self.views);
        document["buffers"] = json!([{"byteLength": self.bytes.len()}]);
        std::fs::write(path, pack(&document, self.bytes)).map_err(|source| Error::io(path, source))
    }
}

/// A metallic-roughness material.
pub fn material(name: &str, [red, green, blue]: [f32; 3], metallic: f32, roughness: f32) -> Value {
    json!({"name": name, "pbrMetallicRoughness": {
        "baseColorFactor": [red, green, blue, 1.0], "metallicFactor": metallic, "roughnessFactor": roughness}})
}

/// The rotation of a camera at `eye` that looks at `target`, upright.
pub fn look(eye: Vec3, target: Vec3) -> [f32; 4] {
    let towards = (target - eye).normalize();
    let yaw = f32::atan2(-towards.x, -towards.z);
    (Quat::from_rotation_y(yaw) * Quat::from_rotation_x(towards.y.asin())).to_array()
}

/// The container: header, JSON chunk, binary chunk, each padded to four bytes.
fn pack(document: &Value, mut buffer: Vec<u8>) -> Vec<u8> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    buffer.resize(buffer.len().next_multiple_of(4), 0);
    let total = 12 + 8 + text.len() + 8 + buffer.len();
    let mut bytes = Vec::with_capacity(total);
    let words = |bytes: &mut Vec<u8>, words: &[usize]| {
        bytes.extend(words.iter().flat_map(|&word| (word as u32).to_le_bytes()));
    };
    words(&mut bytes, &[0x4654_6C67, 2, total, text.len(), 0x4E4F_534A]);
    bytes.extend_from_slice(&text);
    words(&mut bytes, &[buffer.len(), 0x004E_4942]);
    bytes.extend_from_slice(&buffer);
    bytes
}
