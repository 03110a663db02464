//! Makes `assets/mesh/street.glb`: a street at night with lamps at three distances, a house with a spot light on its wall,
//! and two plinths.

use std::f32::consts::PI;
use std::path::Path;

use glam::{Quat, Vec3};
use serde_json::{Value, json};

use crate::error::Error;
use crate::glb::{self, Buffers};
use crate::mesh::Mesh;

const EYE: Vec3 = Vec3::new(0.2, 1.5, 3.6);
const TARGET: Vec3 = Vec3::new(0.1, 1.9, -10.0);

/// Where the lamps hang, metres: 7, 18 and 38 m from the camera.
const LAMPS: [Vec3; 3] =
    [Vec3::new(-2.6, 3.7, -2.6), Vec3::new(2.6, 3.7, -14.0), Vec3::new(-2.9, 3.7, -34.0)];
const LAMP_RADIUS: f32 = 0.16;
/// W/sr in each channel: warm.
const LAMP_INTENSITY: Vec3 = Vec3::new(60.0, 43.0, 24.0);

/// A spot light under the eaves of the house, which shines down and away from the wall.
const SPOT: Vec3 = Vec3::new(3.5, 3.2, -5.2);
const SPOT_DIRECTION: Vec3 = Vec3::new(-0.65, -1.0, 0.3);
const SPOT_INTENSITY: Vec3 = Vec3::new(60.0, 75.0, 100.0);

/// Low and high corners of the blocks, metres, by material.
const GROUND: (Vec3, Vec3) = (Vec3::new(-60.0, -0.2, -120.0), Vec3::new(60.0, 0.0, 30.0));
const HOUSE: (Vec3, Vec3) = (Vec3::new(3.7, 0.0, -9.5), Vec3::new(10.0, 5.5, 6.0));
const PLINTHS: [(Vec3, Vec3); 2] = [
    (Vec3::new(-1.25, 0.0, -3.4), Vec3::new(-0.45, 0.7, -2.6)),
    (Vec3::new(0.65, 0.0, -2.9), Vec3::new(1.45, 0.7, -2.1)),
];

/// Writes `street.glb` into `assets/mesh`.
pub fn make(assets: &Path) -> Result<(), Error> {
    let mut buffers = Buffers::default();
    let block = |(low, high): (Vec3, Vec3)| Mesh::block(low, high);
    let mut street = vec![
        buffers.primitive(&block(GROUND), 0),
        buffers.primitive(&block(HOUSE), 1),
        buffers.primitive(&block(PLINTHS[0]), 1),
        buffers.primitive(&block(PLINTHS[1]), 1),
    ];
    for lamp in LAMPS {
        let thick = Vec3::new(0.06, 0.0, 0.06);
        let foot = Vec3::new(lamp.x, 0.0, lamp.z);
        let top = lamp - LAMP_RADIUS * Vec3::Y;
        street.push(buffers.primitive(&Mesh::block(foot - thick, top + thick), 2));
    }
    let globe = buffers.primitive(&Mesh::sphere(LAMP_RADIUS, 24, 48), 3);
    let lit = |place: Vec3| {
        json!({"name": "lamp", "mesh": 1, "translation": place.to_array(),
        "extensions": {"KHR_lights_punctual": {"light": 0}}})
    };
    let mut nodes = vec![json!({"name": "street", "mesh": 0})];
    nodes.extend(LAMPS.map(lit));
    let turn = Quat::from_rotation_arc(Vec3::NEG_Z, SPOT_DIRECTION.normalize());
    nodes.push(json!({"name": "spot", "translation": SPOT.to_array(), "rotation": turn.to_array(),
        "extensions": {"KHR_lights_punctual": {"light": 1}}}));
    nodes.push(json!({"name": "camera", "camera": 0, "translation": EYE.to_array(), "rotation": glb::look(EYE, TARGET)}));
    // A uniform sphere of radiance L has the radiant intensity pi r^2 L.
    let glow = LAMP_INTENSITY / (PI * LAMP_RADIUS * LAMP_RADIUS);
    let strongest = glow.max_element();
    let mut globe_material = glb::material("globe", [0.0; 3], 0.0, 1.0);
    globe_material["emissiveFactor"] = json!((glow / strongest).to_array());
    globe_material["extensions"] =
        json!({"KHR_materials_emissive_strength": {"emissiveStrength": strongest}});
    let materials: [Value; 4] = [
        glb::material("ground", [0.16, 0.16, 0.17], 0.0, 0.45),
        glb::material("plaster", [0.55, 0.50, 0.45], 0.0, 1.0),
        glb::material("iron", [0.05, 0.05, 0.05], 0.0, 0.5),
        globe_material,
    ];
    let light = |kind, intensity: Vec3| {
        let strength = intensity.max_element();
        json!({"type": kind, "color": (intensity / strength).to_array(), "intensity": strength})
    };
    let mut spot = light("spot", SPOT_INTENSITY);
    spot["spot"] = json!({"innerConeAngle": 0.35, "outerConeAngle": 0.5});
    let all: Vec<usize> = (0..nodes.len()).collect();
    buffers.write(
        &assets.join("mesh/street.glb"),
        json!({
            "asset": {"version": "2.0", "generator": "xtask street", "extras": {"licence": "CC0"}},
            "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_emissive_strength"],
            "extensions": {"KHR_lights_punctual": {"lights": [light("point", LAMP_INTENSITY), spot]}},
            "scene": 0,
            "scenes": [{"nodes": all}],
            "nodes": nodes,
            "meshes": [{"name": "street", "primitives": street}, {"name": "globe", "primitives": [globe]}],
            "materials": materials,
            "cameras": [{"type": "perspective", "name": "pavement", "perspective": {"yfov": 0.85, "znear": 0.1, "zfar": 300.0}}],
        }),
    )
}
