//! Makes `assets/mesh/court.glb`, the building of the demo scene: a paved court between two arcades, a gate at its far end,
//! a plinth with a sculpture, three lamps on brackets, a carpet, and a camera.

use std::f32::consts::PI;
use std::path::Path;

use glam::{Vec2, Vec3};
use serde_json::{Value, json};

use crate::arcade::{self, Arcade};
use crate::error::Error;
use crate::glb::{self, Buffers};
use crate::mesh::Mesh;
use crate::sculpture;
use crate::stone;

/// Low and high corners of the court's floor, metres.
const FLOOR: [Vec2; 2] = [Vec2::new(-8.0, -36.0), Vec2::new(8.0, 7.0)];
/// Left and right edge of the carpet, and the width of its border.
const CARPET: [f32; 2] = [0.35, 1.95];
const BORDER: f32 = 0.13;
/// Metres that it lies over the floor.
const LIFT: f32 = 0.012;

/// Metres from the axis of the court to that of an arcade, and to the walls behind.
const ARCADE: f32 = 4.6;
const WALL: f32 = 7.6;
/// Where the arcades begin and the gate stands.
const NEAR: f32 = 4.8;
const GATE: f32 = -30.4;

/// The middle of the plinth.
pub const PLINTH: Vec3 = Vec3::new(-1.75, 0.0, -3.4);

/// Where lamps hang, and which way the wall is that carries them.
const LAMPS: [(Vec3, f32); 3] = [
    (Vec3::new(-3.85, 2.95, -8.0), -1.0),
    (Vec3::new(3.85, 2.95, -14.4), 1.0),
    (Vec3::new(-3.85, 2.95, -24.0), -1.0),
];
const LAMP_RADIUS: f32 = 0.13;
/// The rope's lowest place, and how much higher its ends are, metres.
const ROPE: Vec3 = Vec3::new(0.0, 3.05, -2.45);
const ROPE_SAG: f32 = 0.45;
/// W/sr in each channel.
const LAMP_INTENSITY: Vec3 = Vec3::new(20.0, 11.5, 4.4);

/// Metres that a map covers.
const PAVING_TILE: f32 = 4.0;
const MASONRY_TILE: f32 = 1.6;
const CARPET_TILE: f32 = 0.3;

/// The materials, in the file's order.
#[derive(Clone, Copy)]
enum Material {
    Paving,
    Masonry,
    Stone,
    Carpet,
    Border,
    Marble,
    Iron,
    Globe,
}

/// Reads nothing; writes `court.glb` below `assets`, with the maps that it names.
pub fn make(assets: &Path) -> Result<(), Error> {
    stone::make(assets)?;
    let mut buffers = Buffers::default();
    let mut building = Vec::new();
    let mut add = |mesh: Mesh, material: Material, tile: Option<f32>| {
        let mut primitive = buffers.primitive(&mesh, material as usize);
        if let Some(tile) = tile {
            primitive["attributes"]["TEXCOORD_0"] =
                json!(buffers.texture_coordinates(&unrolled(&mesh, tile)));
        }
        building.push(primitive);
    };
    let [low, high] = FLOOR;
    let mut paving = ground([low, Vec2::new(CARPET[0], high.y)], 0.0);
    paving.append(&ground([Vec2::new(CARPET[1], low.y), high], 0.0));
    add(paving, Material::Paving, Some(PAVING_TILE));
    let [walls, dressed] = masonry();
    add(walls, Material::Masonry, Some(MASONRY_TILE));
    add(dressed, Material::Stone, None);
    let [carpet, border] = carpet();
    add(carpet, Material::Carpet, Some(CARPET_TILE));
    add(border, Material::Border, Some(CARPET_TILE));
    add(sculpture::with_plinth(PLINTH), Material::Marble, None);
    add(iron(), Material::Iron, None);
    let globe = buffers.primitive(&Mesh::sphere(LAMP_RADIUS, 12, 24), Material::Globe as usize);
    let mut nodes = vec![json!({"name": "court", "mesh": 0})];
    nodes.extend(LAMPS.map(|(place, _)| {
        json!({"name": "lamp", "mesh": 1, "translation": place.to_array(),
            "extensions": {"KHR_lights_punctual": {"light": 0}}})
    }));
    let strength = LAMP_INTENSITY.max_element();
    let normals = ["paving", "masonry", "weave"].map(|name| format!("../normalmap/{name}.png"));
    let colours = ["paving", "masonry"].map(|name| format!("../texture/{name}.png"));
    let images: Vec<Value> = normals.iter().chain(&colours).map(|uri| json!({"uri": uri})).collect();
    let all: Vec<usize> = (0..nodes.len()).collect();
    buffers.write(
        &assets.join("mesh/court.glb"),
        json!({
            "asset": {"version": "2.0", "generator": "xtask court", "extras": {"licence": "CC0"}},
            "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_emissive_strength"],
            "extensions": {"KHR_lights_punctual": {"lights": [
                {"type": "point", "color": (LAMP_INTENSITY / strength).to_array(), "intensity": strength}]}},
            "scene": 0,
            "scenes": [{"nodes": all}],
            "nodes": nodes,
            "meshes": [{"name": "court", "primitives": building}, {"name": "globe", "primitives": [globe]}],
            "materials": materials(),
            "images": images,
            "textures": (0..images.len()).map(|image| json!({"source": image})).collect::<Vec<_>>(),
        }),
    )
}

fn materials() -> Vec<Value> {
    let mapped = |mut material: Value, normals: usize, colour: Option<usize>| {
        material["normalTexture"] = json!({"index": normals});
        if let Some(colour) = colour {
            material["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": colour});
        }
        material
    };
    // A uniform sphere of radiance L has the radiant intensity pi r^2 L.
    let glow = LAMP_INTENSITY / (PI * LAMP_RADIUS * LAMP_RADIUS);
    let strongest = glow.max_element();
    let mut globe = glb::material("globe", [0.0; 3], 0.0, 1.0);
    globe["emissiveFactor"] = json!((glow / strongest).to_array());
    globe["extensions"] = json!({"KHR_materials_emissive_strength": {"emissiveStrength": strongest}});
    vec![
        mapped(glb::material("paving", [0.55, 0.52, 0.50], 0.0, 0.34), 0, Some(3)),
        mapped(glb::material("masonry", [0.62, 0.56, 0.48], 0.0, 0.95), 1, Some(4)),
        glb::material("dressed stone", [0.58, 0.53, 0.46], 0.0, 0.85),
        mapped(glb::material("carpet", [0.36, 0.025, 0.03], 0.0, 0.95), 2, None),
        mapped(glb::material("border", [0.62, 0.42, 0.14], 0.0, 0.95), 2, None),
        glb::material("marble", [0.80, 0.78, 0.74], 0.0, 0.9),
        glb::material("iron", [0.04, 0.04, 0.045], 0.0, 0.5),
        globe,
    ]
}

/// A place on the surface for each vertex, by the side that it faces: maps run upwards on walls and along the floor.
fn unrolled(mesh: &Mesh, tile: f32) -> Vec<Vec2> {
    let place = |(p, n): (&Vec3, &Vec3)| {
        let n = n.abs();
        let place = if n.y >= n.x && n.y >= n.z {
            Vec2::new(p.x, p.z)
        } else if n.x >= n.z {
            Vec2::new(p.z, -p.y)
        } else {
            Vec2::new(p.x, -p.y)
        };
        place / tile
    };
    mesh.positions.iter().zip(&mesh.normals).map(place).collect()
}

/// A rectangle that faces upwards, cut along lines that lie close where light changes fast.
fn ground([low, high]: [Vec2; 2], height: f32) -> Mesh {
    let xs = lines(low.x, high.x, |x| (0.1 + 0.12 * (x.abs() - 2.5).max(0.0)).min(0.5));
    let zs = lines(low.y, high.y, |z| (0.1 + 0.07 * ((z + 2.4).abs() - 1.6).max(0.0)).min(0.9));
    let mut mesh = Mesh::default();
    for z in &zs {
        for x in &xs {
            mesh.positions.push(Vec3::new(*x, height, *z));
            mesh.normals.push(Vec3::Y);
        }
    }
    let row = xs.len() as u32;
    for j in 0..zs.len() as u32 - 1 {
        for i in 0..row - 1 {
            let a = j * row + i;
            mesh.indices.extend([a, a + row, a + row + 1, a, a + row + 1, a + 1]);
        }
    }
    mesh
}

/// Places from one end to the other, about `step` of a place apart.
fn lines(from: f32, to: f32, step: impl Fn(f32) -> f32) -> Vec<f32> {
    let mut places = vec![from];
    let mut at = from;
    while at < to {
        at += step(at);
        places.push(at);
    }
    let stretch = (to - from) / (at - from);
    places.iter().map(|place| from + stretch * (place - from)).collect()
}

/// Longest edge on walls, metres.
fn wall_edge(point: Vec3) -> f32 {
    0.5 + 0.03 * (NEAR - point.z).max(0.0)
}

/// Walls with a map of masonry, and dressed stone.
fn masonry() -> [Mesh; 2] {
    let [mut walls, mut dressed] = [Mesh::default(), Mesh::default()];
    let bays = ((NEAR - GATE) / 3.2).round() as u32;
    for side in [-1.0, 1.0] {
        let row = Arcade {
            from: Vec3::new(side * ARCADE, 0.0, NEAR),
            to: Vec3::new(side * ARCADE, 0.0, GATE),
            bays,
        };
        let [face, rest] = row.wall(-side);
        walls.append(&face.refined(wall_edge));
        dressed.append(&rest.refined(wall_edge));
        dressed.append(&row.columns());
        let at = |y: f32, z: f32| Vec3::new(side * WALL, y, z);
        let (near, far) = (NEAR + 2.0, GATE - 1.0);
        let mut outer = Mesh::default();
        outer.push_quad([at(0.0, near), at(0.0, far), at(5.3, far), at(5.3, near)], [-side * Vec3::X; 4]);
        walls.append(&outer.refined(|p| 1.5 * wall_edge(p)));
        dressed.append(&roof(side).refined(|p| 2.0 * wall_edge(p)));
    }
    let gate = Arcade { from: Vec3::new(-ARCADE, 0.0, GATE), to: Vec3::new(ARCADE, 0.0, GATE), bays: 3 };
    let [face, rest] = gate.wall(1.0);
    walls.append(&face.refined(wall_edge));
    dressed.append(&rest.refined(wall_edge));
    dressed.append(&gate.columns());
    [walls, dressed]
}

/// The slope over an arcade's walk.
fn roof(side: f32) -> Mesh {
    let mut mesh = Mesh::default();
    let at = |x: f32, y: f32, z: f32| Vec3::new(side * x, y, z);
    let (inner, outer) = ((ARCADE - 0.2, arcade::HEIGHT), (WALL + 0.4, 5.3));
    for (up, lift) in [(1.0, 0.12), (-1.0, 0.0)] {
        let (near, far) = (NEAR + 2.0, GATE - 1.0);
        let corners = [
            at(inner.0, inner.1 + lift, near),
            at(outer.0, outer.1 + lift, near),
            at(outer.0, outer.1 + lift, far),
            at(inner.0, inner.1 + lift, far),
        ];
        let slope = Vec3::new(-side * (outer.1 - inner.1), outer.0 - inner.0, 0.0).normalize();
        mesh.push_quad(corners, [up * slope; 4]);
    }
    mesh
}

/// The cloth and its border.
fn carpet() -> [Mesh; 2] {
    let [left, right] = CARPET;
    let inner = [left + BORDER, right - BORDER];
    let strip =
        |left: f32, right: f32| ground([Vec2::new(left, FLOOR[0].y), Vec2::new(right, FLOOR[1].y)], LIFT);
    let mut border = strip(left, inner[0]);
    border.append(&strip(inner[1], right));
    [strip(inner[0], inner[1]), border]
}

/// Brackets of the lamps, and the rope that a further lamp hangs from.
fn iron() -> Mesh {
    let mut mesh = rope();
    for (place, side) in LAMPS {
        let thick = 0.018;
        let wall = side * (ARCADE - 0.2);
        let top = place.y + 0.34;
        let bar = |a: Vec3, b: Vec3| Mesh::block(a.min(b) - thick, a.max(b) + thick);
        mesh.append(&bar(Vec3::new(wall, top, place.z), Vec3::new(place.x, top, place.z)));
        mesh.append(&bar(Vec3::new(place.x, top, place.z), place + LAMP_RADIUS * Vec3::Y));
        mesh.append(&bar(Vec3::new(wall, top - 0.45, place.z), Vec3::new(wall, top + 0.1, place.z)));
    }
    mesh
}

/// A rope from arcade to arcade, which hangs through a little.
fn rope() -> Mesh {
    let at = |step: u32| {
        let x = step as f32 / 12.0 - 1.0;
        Vec3::new(x * (ARCADE - 0.2), ROPE.y + ROPE_SAG * x * x, ROPE.z)
    };
    let mut mesh = Mesh::default();
    for step in 0..24 {
        let (from, to) = (at(step), at(step + 1));
        let along = (to - from).normalize();
        let (side, up) = (0.012 * Vec3::Z, 0.012 * Vec3::Z.cross(along));
        for [a, b, out] in
            [[side, up, side + up], [up, -side, up - side], [-side, -up, -side - up], [-up, side, side - up]]
        {
            mesh.push_quad([from + a, to + a, to + b, from + b], [out.normalize(); 4]);
        }
    }
    mesh
}
