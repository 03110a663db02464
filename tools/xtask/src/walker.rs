//! Makes `assets/mesh/walker.glb`, a figure of rounded limbs with a skin and a walk of one cycle, which loops; and
//! `ground.glb`, for it to walk on, whose scene file subdivides it.

use std::f32::consts::{PI, TAU};
use std::path::Path;

use glam::{Mat4, Quat, Vec3};
use serde_json::{Value, json};

use crate::error::Error;
use crate::glb::{self, Buffers};
use crate::mesh::Mesh;

/// A joint and the limb it moves: parent, where it is and where the limb ends in the bind pose, metres, and its radius.
struct Bone {
    name: &'static str,
    parent: Option<usize>,
    joint: Vec3,
    end: Vec3,
    radius: f32,
}

/// Vertices around a limb, rings of each rounded end and between them.
const AROUND: usize = 16;
const CAP: usize = 4;
const LENGTH: usize = 6;

/// Seconds of a cycle, two steps, and keys in it.
const CYCLE: f32 = 1.2;
const KEYS: usize = 17;

/// Metres of the ground's side, and squares along it: with 6 subdivisions 193 x 193 vertices, 42 mm apart.
const SIDE: f32 = 8.0;
const SQUARES: usize = 3;

/// Writes `walker.glb` and `ground.glb` into `assets/mesh`.
pub fn make(assets: &Path) -> Result<(), Error> {
    let bones = bones();
    let (mut mesh, mut joints, mut weights) = (Mesh::default(), Vec::new(), Vec::new());
    for (number, bone) in bones.iter().enumerate() {
        limb(number, bone, &mut mesh, &mut joints, &mut weights);
    }
    let mut buffers = Buffers::default();
    let mut primitive = buffers.primitive(&mesh, 0);
    let count = mesh.positions.len();
    let description = json!({"componentType": 5123, "type": "VEC4", "count": count});
    primitive["attributes"]["JOINTS_0"] = json!(buffers.accessor(bytemuck::cast_slice(&joints), description));
    let description = json!({"componentType": 5126, "type": "VEC4", "count": count});
    primitive["attributes"]["WEIGHTS_0"] =
        json!(buffers.accessor(bytemuck::cast_slice(&weights), description));
    let bind: Vec<Mat4> = bones.iter().map(|bone| Mat4::from_translation(-bone.joint)).collect();
    let description = json!({"componentType": 5126, "type": "MAT4", "count": bind.len()});
    let bind = buffers.accessor(bytemuck::cast_slice(&bind), description);
    let animation = walk(&mut buffers, &bones);
    let mut nodes: Vec<Value> = (0..bones.len()).map(|number| node(&bones, number)).collect();
    let figure = nodes.len();
    nodes.push(json!({"name": "walker", "mesh": 0, "skin": 0}));
    let eye = Vec3::new(2.2, 1.7, 3.2);
    let rotation = glb::look(eye, Vec3::new(0.0, 0.7, 0.0));
    nodes.push(json!({"name": "camera", "camera": 0, "translation": eye.to_array(), "rotation": rotation}));
    let document = json!({
        "asset": {"version": "2.0", "generator": "airglow xtask walker", "copyright": "CC0"},
        "scene": 0,
        "scenes": [{"nodes": [0, figure, figure + 1]}],
        "nodes": nodes,
        "meshes": [{"name": "walker", "primitives": [primitive]}],
        "materials": [glb::material("clay", [0.7, 0.62, 0.55], 0.0, 0.9)],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.05}}],
        "skins": [{"name": "walker", "joints": (0..bones.len()).collect::<Vec<_>>(), "inverseBindMatrices": bind}],
        "animations": [animation],
    });
    buffers.write(&assets.join("mesh/walker.glb"), document)?;
    ground(&assets.join("mesh/ground.glb"))
}

/// A square about the origin, at height 0.
fn ground(path: &Path) -> Result<(), Error> {
    let place = |at: usize| SIDE * (at as f32 / SQUARES as f32 - 0.5);
    let corners = (0..=SQUARES).flat_map(|z| (0..=SQUARES).map(move |x| Vec3::new(place(x), 0.0, place(z))));
    let squares = (0..SQUARES * SQUARES).flat_map(|at| {
        let first = (at / SQUARES * (SQUARES + 1) + at % SQUARES) as u32;
        let next = first + SQUARES as u32 + 1;
        [first, next, next + 1, first, next + 1, first + 1]
    });
    let mesh = Mesh {
        positions: corners.collect(),
        normals: vec![Vec3::Y; (SQUARES + 1) * (SQUARES + 1)],
        indices: squares.collect(),
    };
    let mut buffers = Buffers::default();
    let primitive = buffers.primitive(&mesh, 0);
    let document = json!({
        "asset": {"version": "2.0", "generator": "airglow xtask walker", "copyright": "CC0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "ground", "mesh": 0}],
        "meshes": [{"name": "ground", "primitives": [primitive]}],
        "materials": [glb::material("ground", [0.62, 0.6, 0.57], 0.0, 0.95)],
    });
    buffers.write(path, document)
}

fn bones() -> Vec<Bone> {
    let bone = |name, parent, joint: [f32; 3], end: [f32; 3], radius| Bone {
        name,
        parent,
        joint: joint.into(),
        end: end.into(),
        radius,
    };
    let mut bones = vec![
        bone("hips", None, [0.0, 0.95, 0.0], [0.0, 1.1, 0.0], 0.14),
        bone("spine", Some(0), [0.0, 1.08, 0.0], [0.0, 1.4, 0.0], 0.155),
        bone("head", Some(1), [0.0, 1.52, 0.01], [0.0, 1.68, 0.02], 0.1),
    ];
    for x in [1.0, -1.0] {
        let first = bones.len();
        bones.push(bone("upper arm", Some(1), [0.21 * x, 1.42, 0.0], [0.25 * x, 1.13, 0.0], 0.055));
        bones.push(bone("forearm", Some(first), [0.25 * x, 1.13, 0.0], [0.27 * x, 0.84, 0.02], 0.045));
        bones.push(bone("thigh", Some(0), [0.1 * x, 0.92, 0.0], [0.11 * x, 0.5, 0.0], 0.085));
        bones.push(bone("shin", Some(first + 2), [0.11 * x, 0.5, 0.0], [0.11 * x, 0.1, 0.0], 0.06));
        bones.push(bone("foot", Some(first + 3), [0.11 * x, 0.07, 0.0], [0.11 * x, 0.045, 0.16], 0.045));
    }
    bones
}

/// A cylinder with rounded ends; near its joint a limb half follows its parent.
fn limb(
    number: usize,
    bone: &Bone,
    mesh: &mut Mesh,
    joints: &mut Vec<[u16; 4]>,
    weights: &mut Vec<[f32; 4]>,
) {
    let along = bone.end - bone.joint;
    let (length, up) = (along.length(), along.normalize());
    let (side, front) = up.any_orthonormal_pair();
    let rings = 2 * CAP + LENGTH + 1;
    let base = mesh.positions.len() as u32;
    for ring in 0..rings {
        // Height over the joint, and the angle of the normal to the limb's axis.
        let (height, tilt) = if ring < CAP {
            (0.0, -PI / 2.0 * (1.0 - ring as f32 / CAP as f32))
        } else if ring <= CAP + LENGTH {
            (length * (ring - CAP) as f32 / LENGTH as f32, 0.0)
        } else {
            (length, PI / 2.0 * (ring - CAP - LENGTH) as f32 / CAP as f32)
        };
        for step in 0..AROUND {
            let turn = TAU * step as f32 / AROUND as f32;
            let normal = tilt.cos() * (turn.cos() * side + turn.sin() * front) + tilt.sin() * up;
            mesh.positions.push(bone.joint + height * up + bone.radius * normal);
            mesh.normals.push(normal);
            let parent = bone.parent.map_or(0.0, |_| 0.5 * (1.0 - 4.0 * height / length).max(0.0));
            joints.push([number as u16, bone.parent.unwrap_or(0) as u16, 0, 0]);
            weights.push([1.0 - parent, parent, 0.0, 0.0]);
        }
    }
    for ring in 0..rings as u32 - 1 {
        for step in 0..AROUND as u32 {
            let at = |ring: u32, step: u32| base + ring * AROUND as u32 + step % AROUND as u32;
            let [a, b, c, d] =
                [at(ring, step), at(ring, step + 1), at(ring + 1, step + 1), at(ring + 1, step)];
            // At the poles all places of a ring are one.
            if ring > 0 {
                mesh.indices.extend([a, b, c]);
            }
            if ring + 2 < rings as u32 {
                mesh.indices.extend([a, c, d]);
            }
        }
    }
}

fn node(bones: &[Bone], number: usize) -> Value {
    let bone = &bones[number];
    let from = bone.parent.map_or(Vec3::ZERO, |parent| bones[parent].joint);
    let mut node = json!({"name": bone.name, "translation": (bone.joint - from).to_array()});
    let children: Vec<usize> =
        (0..bones.len()).filter(|child| bones[*child].parent == Some(number)).collect();
    if !children.is_empty() {
        node["children"] = json!(children);
    }
    node
}

/// The turn of a joint about X at a phase of the cycle; forwards is +Z, which a negative turn swings a hanging limb to.
fn swing(bone: &Bone, phase: f32) -> f32 {
    let phase = if bone.joint.x < 0.0 { phase + PI } else { phase };
    match bone.name {
        "thigh" => -0.5 * phase.sin(),
        // Bent while the leg swings forwards.
        "shin" => 0.12 + 0.75 * phase.cos().max(0.0),
        "foot" => 0.35 * phase.sin() * phase.sin() - 0.15,
        "upper arm" => 0.45 * phase.sin(),
        "forearm" => -0.35 + 0.25 * phase.sin(),
        _ => 0.0,
    }
}

/// Turns of the limbs, and the hips up and down twice a cycle.
fn walk(buffers: &mut Buffers, bones: &[Bone]) -> Value {
    let times: Vec<f32> = (0..KEYS).map(|key| CYCLE * key as f32 / (KEYS - 1) as f32).collect();
    let phase = |time: &f32| TAU * time / CYCLE;
    let description =
        json!({"componentType": 5126, "type": "SCALAR", "count": KEYS, "min": [0.0], "max": [CYCLE]});
    let input = buffers.accessor(bytemuck::cast_slice(&times), description);
    let (mut channels, mut samplers) = (Vec::new(), Vec::new());
    let mut add = |node: usize, path: &str, output: usize| {
        channels.push(json!({"sampler": samplers.len(), "target": {"node": node, "path": path}}));
        samplers.push(json!({"input": input, "output": output}));
    };
    for (number, bone) in bones.iter().enumerate().skip(3) {
        let turns: Vec<[f32; 4]> =
            times.iter().map(|time| Quat::from_rotation_x(swing(bone, phase(time))).to_array()).collect();
        let description = json!({"componentType": 5126, "type": "VEC4", "count": KEYS});
        add(number, "rotation", buffers.accessor(bytemuck::cast_slice(&turns), description));
    }
    let heights: Vec<[f32; 3]> =
        times.iter().map(|time| [0.0, 0.935 - 0.02 * (2.0 * phase(time)).cos(), 0.0]).collect();
    let description = json!({"componentType": 5126, "type": "VEC3", "count": KEYS});
    add(0, "translation", buffers.accessor(bytemuck::cast_slice(&heights), description));
    json!({"name": "walk", "channels": channels, "samplers": samplers})
}
