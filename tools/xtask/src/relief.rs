//! Makes normal maps whose texels far away are no single normal, and the scenes that show them:
//! `assets/normalmap/grooves.png` with `assets/mesh/grooves.glb`, and `weave.png` with `weave.glb`.

use std::f32::consts::TAU;
use std::path::Path;

use glam::{Quat, Vec2, Vec3};
use serde_json::{Value, json};

use crate::error::Error;
use crate::glb::{self, Buffers};
use crate::mesh::Mesh;

/// Texels of a side of the maps.
const SIZE: u32 = 512;

/// Grooves of a map: 32 texels each, half of them on either flank.
const GROOVES: u32 = 16;
/// Slope of the flanks: 22 degrees.
const FLANK: f32 = 0.4;

/// Threads of a map, each way: 32 texels each.
const THREADS: u32 = 16;
/// Slope at the edges of a thread, which is round across.
const THREAD_EDGE: f32 = 0.8;
/// Slope along a thread where it dives under the next.
const THREAD_DIVE: f32 = 0.45;

/// Metres of a side of the grooved plane, and of the map on it.
const PLANE: f32 = 400.0;
const TILE: f32 = 0.25;

/// Radii of the woven ring, metres, and repetitions of the map around it and around its tube.
const RING: [f32; 2] = [0.7, 0.32];
const REPEATS: [f32; 2] = [8.0, 4.0];

/// Writes the maps and the meshes below `assets`.
pub fn make(assets: &Path) -> Result<(), Error> {
    write_map(&assets.join("normalmap/grooves.png"), SIZE, groove)?;
    write_map(&assets.join("normalmap/weave.png"), SIZE, thread)?;
    let sun = json!({"type": "directional", "color": [1.0, 0.93, 0.8], "intensity": 3.0});
    let lamp = json!({"type": "point", "color": [0.45, 0.7, 1.0], "intensity": 9.0});
    let shining = |number, translation: Vec3, towards: Vec3| {
        let turn = Quat::from_rotation_arc(Vec3::NEG_Z, towards.normalize());
        json!({"name": "light", "translation": translation.to_array(), "rotation": turn.to_array(),
            "extensions": {"KHR_lights_punctual": {"light": number}}})
    };
    let eye = Vec3::new(0.0, 1.6, 0.0);
    let plane = [
        json!({"name": "plane", "mesh": 0}),
        shining(0, Vec3::ZERO, Vec3::new(0.0, -0.22, 1.0)),
        shining(1, Vec3::new(-2.2, 0.9, -9.0), Vec3::NEG_Y),
        camera(eye, Vec3::new(0.0, 0.35, -6.0)),
    ];
    write(assets, "grooves", grooved_plane(), &plane, [sun.clone(), lamp.clone()])?;
    let ring = [
        json!({"name": "ring", "mesh": 0}),
        shining(0, Vec3::ZERO, Vec3::new(-0.8, -0.9, -1.0)),
        shining(1, Vec3::new(-1.6, 1.4, 1.2), Vec3::NEG_Y),
        camera(Vec3::new(0.0, 0.9, 2.6), Vec3::ZERO),
    ];
    write(assets, "weave", woven_ring(), &ring, [sun, lamp])
}

fn camera(eye: Vec3, target: Vec3) -> Value {
    json!({"name": "camera", "camera": 0, "translation": eye.to_array(), "rotation": glb::look(eye, target)})
}

/// A mesh with texture coordinates, its nodes and lights, as `assets/mesh/NAME.glb` with the map of the same name.
fn write(
    assets: &Path,
    name: &str,
    (mesh, coordinates): (Mesh, Vec<Vec2>),
    nodes: &[Value],
    lights: [Value; 2],
) -> Result<(), Error> {
    let mut buffers = Buffers::default();
    let mut primitive = buffers.primitive(&mesh, 0);
    primitive["attributes"]["TEXCOORD_0"] = json!(buffers.texture_coordinates(&coordinates));
    let mut material = glb::material(name, [0.72, 0.6, 0.42], 0.5, 0.42);
    material["normalTexture"] = json!({"index": 0});
    let all: Vec<usize> = (0..nodes.len()).collect();
    buffers.write(
        &assets.join(format!("mesh/{name}.glb")),
        json!({
            "asset": {"version": "2.0", "generator": "xtask relief", "extras": {"licence": "CC0"}},
            "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": {"KHR_lights_punctual": {"lights": lights}},
            "scene": 0,
            "scenes": [{"nodes": all}],
            "nodes": nodes,
            "meshes": [{"name": name, "primitives": [primitive]}],
            "materials": [material],
            "images": [{"uri": format!("../normalmap/{name}.png")}],
            // Texels are facets: between two flanks there is no third normal.
            "samplers": [{"magFilter": 9728, "minFilter": 9984}],
            "textures": [{"source": 0, "sampler": 0}],
            "cameras": [{"type": "perspective", "name": "view", "perspective": {"yfov": 0.7, "znear": 0.05, "zfar": 600.0}}],
        }),
    )
}

/// A square on the ground whose grooves run away from the camera.
fn grooved_plane() -> (Mesh, Vec<Vec2>) {
    let (near, half) = (4.0, 0.5 * PLANE);
    let corners = [[-half, near], [half, near], [half, near - PLANE], [-half, near - PLANE]];
    let mesh = Mesh {
        positions: corners.iter().map(|&[x, z]| Vec3::new(x, 0.0, z)).collect(),
        normals: vec![Vec3::Y; 4],
        indices: vec![0, 1, 2, 0, 2, 3],
    };
    (mesh, corners.iter().map(|&[x, z]| Vec2::new(x, z) / TILE).collect())
}

/// A torus about the vertical axis, v along its tube.
fn woven_ring() -> (Mesh, Vec<Vec2>) {
    let ([around, across], [ring, tube]) = ([96_u32, 48], RING);
    let (mut mesh, mut coordinates) = (Mesh::default(), Vec::new());
    for i in 0..=around {
        let (sine, cosine) = (TAU * i as f32 / around as f32).sin_cos();
        for j in 0..=across {
            let (height, out) = (TAU * j as f32 / across as f32).sin_cos();
            let normal = Vec3::new(out * cosine, height, -out * sine);
            mesh.positions.push(Vec3::new(ring * cosine, 0.0, -ring * sine) + tube * normal);
            mesh.normals.push(normal);
            let place = Vec2::new(i as f32 / around as f32, 1.0 - j as f32 / across as f32);
            coordinates.push(place * Vec2::from(REPEATS));
        }
    }
    for i in 0..around {
        for j in 0..across {
            let a = i * (across + 1) + j;
            let b = a + across + 1;
            mesh.indices.extend([a, b, b + 1, a, b + 1, a + 1]);
        }
    }
    (mesh, coordinates)
}

/// Slope of a V-shaped groove, with the marks of the tool along it and across.
fn groove(x: u32, y: u32) -> Vec2 {
    let period = SIZE / GROOVES;
    let side = if x % period < period / 2 { FLANK } else { -FLANK };
    let phase = TAU * (y as f32 / 64.0 + unit(x / period));
    Vec2::new(side + 0.1 * (unit(x) - 0.5), 0.05 * phase.sin())
}

/// Slope of the upper thread of a plain weave.
fn thread(x: u32, y: u32) -> Vec2 {
    let width = SIZE / THREADS;
    let across = |i: u32| 2.0 * ((i % width) as f32 + 0.5) / width as f32 - 1.0;
    let along = ((x / width) ^ (y / width)) & 1 == 0;
    let (u, v) = if along { (across(x), across(y)) } else { (across(y), across(x)) };
    let slope = Vec2::new(THREAD_EDGE * u, THREAD_DIVE * v * v * v);
    if along { slope } else { Vec2::new(slope.y, slope.x) }
}

/// A number in [0, 1) for each integer, without pattern (Wellons, "Prospecting for Hash Functions", 2018).
pub fn unit(i: u32) -> f32 {
    let mut hash = i ^ (i >> 16);
    hash = hash.wrapping_mul(0x7feb_352d);
    hash ^= hash >> 15;
    hash = hash.wrapping_mul(0x846c_a68b);
    hash ^= hash >> 16;
    (hash >> 8) as f32 / (1 << 24) as f32
}

/// A square map of `size` texels a side from the slope of the surface along x and, upwards, y: RGB = normal * 0.5 + 0.5.
pub fn write_map(path: &Path, size: u32, slope: fn(u32, u32) -> Vec2) -> Result<(), Error> {
    let texel = |x, y| {
        let normal = (-slope(x, y)).extend(1.0).normalize();
        image::Rgb((127.5 * normal + 128.0).to_array().map(|value| value as u8))
    };
    let refused = |message: String| Error::Asset { path: path.to_owned(), message };
    image::RgbImage::from_fn(size, size, texel).save(path).map_err(|error| refused(error.to_string()))
}
