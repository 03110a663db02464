//! Small glTF files made in memory.

use std::path::PathBuf;

use airglow_scene::{Scene, SceneError};
use serde_json::{Value, json};
use tempfile::TempDir;

pub const FLOAT: u32 = 5126;
pub const U8: u32 = 5121;
pub const U16: u32 = 5123;

/// A glTF document and its one buffer.
pub struct Model {
    pub json: Value,
    pub buffer: Vec<u8>,
}

impl Model {
    /// A document with one scene, one node and one mesh of one primitive, without attributes.
    pub fn new() -> Self {
        let json = json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0, "name": "node" }],
            "meshes": [{ "name": "mesh", "primitives": [{ "attributes": {} }] }],
            "accessors": [],
            "bufferViews": [],
        });
        Self { json, buffer: Vec::new() }
    }

    /// A square in z = 0, seen from +Z, of two triangles with shared vertices.
    pub fn square() -> Self {
        let mut model = Self::new();
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0_f32]];
        model.positions(&positions);
        let indices = model.accessor(&[0_u16, 1, 2, 0, 2, 3], U16, "SCALAR", 6);
        model.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
        model
    }

    /// Sets the positions of the primitive.
    pub fn positions(&mut self, positions: &[[f32; 3]]) {
        let accessor = self.accessor(positions.as_flattened(), FLOAT, "VEC3", positions.len());
        self.json["accessors"][accessor]["min"] = json!([0.0, 0.0, 0.0]);
        self.json["accessors"][accessor]["max"] = json!([1.0, 1.0, 1.0]);
        self.attribute("POSITION", accessor);
    }

    pub fn attribute(&mut self, name: &str, accessor: usize) {
        self.json["meshes"][0]["primitives"][0]["attributes"][name] = json!(accessor);
    }

    /// Adds a buffer view of the bytes.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.buffer.len();
        self.buffer.extend_from_slice(bytes);
        self.buffer.resize(self.buffer.len().next_multiple_of(4), 0);
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }))
    }

    /// Adds an accessor of `count` elements over its own buffer view.
    pub fn accessor<T: bytemuck::NoUninit>(
        &mut self,
        values: &[T],
        component: u32,
        shape: &str,
        count: usize,
    ) -> usize {
        let view = self.view(bytemuck::cast_slice(values));
        let accessor =
            json!({ "bufferView": view, "componentType": component, "type": shape, "count": count });
        self.push("accessors", accessor)
    }

    /// Appends to an array of the document, which is made if it is missing.
    pub fn push(&mut self, array: &str, value: Value) -> usize {
        if self.json[array].is_null() {
            self.json[array] = json!([]);
        }
        let array = self.json[array].as_array_mut().unwrap();
        array.push(value);
        array.len() - 1
    }

    /// The file's bytes.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if json["buffers"].is_null() {
            json["buffers"] = json!([{ "byteLength": self.buffer.len() }]);
        }
        glb(&serde_json::to_vec(&json).unwrap(), &self.buffer)
    }

    pub fn load(&self) -> Result<Scene, SceneError> {
        load(&self.glb(), "model.glb")
    }

    /// The message of the error that loading must end in.
    pub fn error(&self) -> String {
        match self.load() {
            Ok(_) => panic!("loaded: {}", self.json),
            Err(error) => error.to_string(),
        }
    }
}

/// A GLB container of two chunks.
pub fn glb(json: &[u8], buffer: &[u8]) -> Vec<u8> {
    let mut json = json.to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend(((12 + 8 + json.len() + 8 + buffer.len()) as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json.as_slice()), (b"BIN\0", buffer)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

/// Loads bytes from a file of this name in a folder of its own.
pub fn load(bytes: &[u8], name: &str) -> Result<Scene, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    airglow_scene::load(&put(&folder, name, bytes))
}

/// Writes a file into `folder`.
pub fn put(folder: &TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let file = folder.path().join(name);
    std::fs::write(&file, bytes).unwrap();
    file
}

/// A file among the repository's assets.
pub fn asset(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../assets").join(name)
}

/// A skinned, textured, animated, lit model with most features that are read.
pub fn full_model() -> Model {
    let mut model = Model::square();
    let uv = model.accessor(&[0.0_f32, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0], FLOAT, "VEC2", 4);
    model.attribute("TEXCOORD_0", uv);
    let joints = model.accessor(&[0_u8, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0], U8, "VEC4", 4);
    model.attribute("JOINTS_0", joints);
    let weights = [0.75_f32, 0.25, 0.0, 0.0].repeat(4);
    let weights = model.accessor(&weights, FLOAT, "VEC4", 4);
    model.attribute("WEIGHTS_0", weights);
    let identity = glam::Mat4::IDENTITY.to_cols_array();
    let bind = model.accessor(&[identity, identity], FLOAT, "MAT4", 2);
    model.json["nodes"] = json!([
        { "mesh": 0, "skin": 0, "name": "node" },
        { "name": "hip", "children": [2], "translation": [0.0, 1.0, 0.0] },
        { "name": "knee", "rotation": [0.0, 0.0, 0.6, 0.8] },
        { "camera": 0, "translation": [0.0, 0.0, 3.0] },
        { "extensions": { "KHR_lights_punctual": { "light": 0 } } },
    ]);
    model.json["scenes"] = json!([{ "nodes": [0, 1, 3, 4] }]);
    model.json["skins"] = json!([{ "joints": [1, 2], "inverseBindMatrices": bind }]);
    let times = model.accessor(&[0.0_f32, 0.5, 2.0], FLOAT, "SCALAR", 3);
    let turns = [[0.0_f32, 0.0, 0.0, 1.0], [0.0, 0.0, 0.6, 0.8], [0.0, 0.0, 1.0, 0.0]];
    let turns = model.accessor(turns.as_flattened(), FLOAT, "VEC4", 3);
    model.json["animations"] = json!([{
        "name": "walk",
        "samplers": [{ "input": times, "output": turns }],
        "channels": [{ "sampler": 0, "target": { "node": 2, "path": "rotation" } }],
    }]);
    let camera = json!({ "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.1 } });
    model.json["cameras"] = json!([camera]);
    let spot = json!({ "type": "spot", "intensity": 30.0, "color": [1.0, 0.5, 0.25], "spot": {} });
    model.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [spot] } });
    model.json["extensionsUsed"] = json!(["KHR_lights_punctual", "KHR_texture_transform"]);
    let picture = model.view(&png());
    model.json["images"] = json!([{ "bufferView": picture, "mimeType": "image/png", "name": "wood" }]);
    model.json["samplers"] = json!([{ "wrapS": 33071, "magFilter": 9728 }]);
    model.json["textures"] = json!([{ "source": 0, "sampler": 0 }]);
    let transform = json!({ "KHR_texture_transform": { "offset": [0.5, 0.0], "scale": [2.0, 1.0] } });
    model.json["materials"] = json!([{
        "name": "board",
        "pbrMetallicRoughness": {
            "baseColorTexture": { "index": 0, "extensions": transform.clone() },
            "metallicFactor": 0.0,
            "roughnessFactor": 0.5,
        },
        "normalTexture": { "index": 0, "scale": 0.5, "extensions": transform },
        "emissiveFactor": [1.0, 0.0, 0.0],
        "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 5.0 } },
        "alphaMode": "MASK",
        "alphaCutoff": 0.25,
        "doubleSided": true,
    }]);
    model.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    model
}

/// A PNG of 2 x 1 pixels: the sRGB grey 188 and a half transparent red.
pub fn png() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let pixels = [188, 188, 188, 255, 255, 0, 0, 128];
    image::RgbaImage::from_raw(2, 1, pixels.to_vec())
        .unwrap()
        .write_to(&mut bytes, image::ImageFormat::Png)
        .unwrap();
    bytes.into_inner()
}
