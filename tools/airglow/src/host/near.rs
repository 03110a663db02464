//! The scene's near emitters: as things that are drawn, and as light of each vertex by the radiance pass.

use std::ops::ControlFlow;

use airglow::math::sh::rotation::Rotation;
use airglow::math::sphere::equirect::Projector;
use airglow::radiance::{
    Control, Hierarchy, Lights, Lit, Part, PassSettings, Radiance, Receiver, Settings, Triangle,
};
use airglow_gpu::{Context, Imports, Record, Requirements};
use airglow_graph::Graph;
use airglow_scene::{Emitter, EmitterShape, Environment, Instance, Material, Mesh, Scene};
use glam::{DMat3, DQuat, DVec3, Mat4, Vec3};

use super::transfer::SceneTransfer;
use crate::failure::{Failure, Outcome};

/// Cube maps of 16 texels see emitters of a few degrees by four rays a texel.
const FACE: u32 = 16;
/// Error of a vertex colour that samples aim at, W/sr/m2 before exposure.
const BOUND: f64 = 2e-3;

/// Bands that samples can have.
const ORDERS: std::ops::RangeInclusive<u32> = 3..=6;

/// The pass with a scene's vertices and emitters.
pub struct NearLight {
    radiance: Radiance,
    receiver: Receiver,
    emitters: Vec<Triangle>,
    /// The environment about the world's axes where it is not turned.
    distant: Vec<[f64; 3]>,
    order: usize,
}

/// Whether the pass lights a scene.
pub fn is_drawn(scene: &Scene) -> bool {
    let glows = |emitter: &Emitter| emitter.radiance.iter().any(|x| *x > 0.0);
    scene.emitters.iter().any(glows) && ORDERS.contains(&scene.quality.order)
}

/// What the device must offer for a scene.
pub fn requirements(scene: &Scene) -> Requirements {
    match is_drawn(scene) {
        true => Radiance::requirements(&settings(scene)),
        false => Requirements::engine(),
    }
}

fn settings(scene: &Scene) -> PassSettings {
    let refinement = Settings { bound: BOUND, ..Settings::default() };
    let order = scene.quality.order as usize;
    PassSettings { order, face: FACE, rays: 4, refinement, ..PassSettings::default() }
}

/// Puts every emitter into the scene as a mesh that glows and reflects nothing, after all other instances.
pub fn place(scene: &mut Scene) {
    for emitter in &scene.emitters {
        let (positions, indices) = shape(emitter);
        let middle = Vec3::from(emitter.center);
        let normals = positions.iter().map(|p| (Vec3::from(*p) - middle).normalize_or(Vec3::Y).to_array());
        let mut mesh = Mesh {
            name: emitter.name.clone(),
            normals: normals.collect(),
            positions,
            tangents: Vec::new(),
            uv0: Vec::new(),
            joints: Vec::new(),
            weights: Vec::new(),
            indices,
            material: scene.materials.len(),
            hash: Default::default(),
        };
        mesh.hash = mesh.content_hash();
        scene.materials.push(Material {
            name: emitter.name.clone(),
            base_color: [0.0, 0.0, 0.0, 1.0],
            emissive: emitter.radiance,
            ..Material::default()
        });
        scene.instances.push(Instance {
            name: emitter.name.clone(),
            mesh: scene.meshes.len(),
            node: 0,
            skin: None,
            transform: Mat4::IDENTITY,
            material: mesh.material,
        });
        scene.meshes.push(mesh);
    }
}

/// Positions in the world and triangles of an emitter: the twelve of a box, eighty of a sphere.
fn shape(emitter: &Emitter) -> (Vec<[f32; 3]>, Vec<u32>) {
    let middle = Vec3::from(emitter.center);
    let corners = |size: Vec3| {
        let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) - 0.5;
        (0..8).map(|i| middle + size * corner(i)).collect::<Vec<_>>()
    };
    match emitter.shape {
        EmitterShape::Box { size } => {
            let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
            let indices = sides.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
            (corners(Vec3::from(size)).iter().map(|p| p.to_array()).collect(), indices)
        }
        EmitterShape::Sphere { radius } => sphere(middle, radius),
    }
}

/// An octahedron whose sides are parted in four twice, its corners on the sphere.
fn sphere(middle: Vec3, radius: f32) -> (Vec<[f32; 3]>, Vec<u32>) {
    let mut triangles: Vec<[Vec3; 3]> = (0..8)
        .map(|i: u32| {
            let sign = |bit: u32| if i >> bit & 1 == 0 { 1.0 } else { -1.0 };
            let [x, y, z] = [Vec3::X * sign(0), Vec3::Y * sign(1), Vec3::Z * sign(2)];
            if x.cross(y).dot(z) > 0.0 { [x, y, z] } else { [x, z, y] }
        })
        .collect();
    for _ in 0..2 {
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let [d, e, f] = [a + b, b + c, c + a].map(Vec3::normalize);
                [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
            })
            .collect();
    }
    let positions: Vec<_> = triangles.iter().flatten().map(|p| (middle + radius * *p).to_array()).collect();
    let indices = (0..positions.len() as u32).collect();
    (positions, indices)
}

/// The triangles of all emitters, in the world.
fn triangles(scene: &Scene) -> Vec<Triangle> {
    let emitted = |emitter: &Emitter| {
        let (positions, indices) = shape(emitter);
        let corner = |i: &u32| DVec3::from(positions[*i as usize].map(f64::from));
        let radiance = DVec3::from(emitter.radiance.map(f64::from));
        let triangle =
            |i: &[u32]| Triangle { corners: [corner(&i[0]), corner(&i[1]), corner(&i[2])], radiance };
        indices.chunks_exact(3).map(triangle).collect::<Vec<_>>()
    };
    scene.emitters.iter().flat_map(emitted).collect()
}

impl NearLight {
    /// The pass for a scene, where it has something to do.
    pub fn new(context: &Context, scene: &Scene, transfer: &SceneTransfer) -> Outcome<Option<Self>> {
        if !is_drawn(scene) {
            return Ok(None);
        }
        let settings = settings(scene);
        let (mut positions, mut vectors, mut parts) = (Vec::new(), Vec::new(), Vec::new());
        let drawn = scene.instances.len() - scene.emitters.len();
        for (index, (instance, lit)) in scene.instances.iter().zip(&transfer.instances).enumerate() {
            let first = positions.len() as u32;
            let place = |p: &[f32; 3]| instance.transform.transform_point3((*p).into()).to_array();
            positions.extend(scene.meshes[instance.mesh].positions.iter().map(place));
            let baked = &transfer.transfers[lit.transfer].coefficients;
            match index < drawn {
                true => vectors.extend_from_slice(baked),
                // An emitter reflects nothing.
                false => vectors.resize(vectors.len() + baked.len(), 0.0),
            }
            let side = if lit.inverted { -1.0 } else { 1.0 };
            let turn = side * DMat3::from_quat(lit.rotation.conjugate());
            parts.push(Part { vertices: first..positions.len() as u32, turn: Some(turn) });
        }
        let mut progress = |_, _| ControlFlow::Continue(());
        let tree = Hierarchy::build(&positions, &vectors, &mut progress).map_err(Failure::work)?;
        let receiver = Receiver::new(context, settings, &tree, &positions, &parts).map_err(Failure::work)?;
        let radiance = Radiance::new(context, settings).map_err(Failure::work)?;
        let distant = match &scene.environment {
            Some(environment) => distant(environment, settings.order)?,
            None => Vec::new(),
        };
        Ok(Some(Self { radiance, receiver, emitters: triangles(scene), distant, order: settings.order }))
    }

    /// Adds the pass; distant light is turned by `turn`.
    pub fn add(&self, graph: &mut Graph<Record>, imports: &mut Imports, turn: DQuat) -> Outcome<Lit> {
        let distant = self.turned(turn)?;
        let lights = Lights { emitters: &self.emitters, distant: &distant };
        self.radiance.add(graph, imports, &self.receiver, &lights).map_err(Failure::work)
    }

    /// Turns the distant light of a declared frame.
    pub fn turn(&self, control: &Control, turn: DQuat) -> Outcome {
        let distant = self.turned(turn)?;
        control.set(&Lights { emitters: &self.emitters, distant: &distant }).map_err(Failure::work)
    }

    fn turned(&self, turn: DQuat) -> Outcome<Vec<[f32; 3]>> {
        if self.distant.is_empty() {
            return Ok(Vec::new());
        }
        let rotation = Rotation::from_quaternion(self.order, turn).map_err(Failure::work)?;
        let turned = rotation.apply_rgb(&self.distant).map_err(Failure::work)?;
        Ok(turned.iter().map(|light| light.map(|x| x as f32)).collect())
    }
}

/// The environment's coefficients about the world's axes.
fn distant(environment: &Environment, order: usize) -> Outcome<Vec<[f64; 3]>> {
    let projector = Projector::new(order, environment.width, environment.height).map_err(Failure::input)?;
    let light = projector.project(&environment.pixels).map_err(Failure::input)?;
    let rotation = Rotation::from_quaternion(order, environment.rotation.as_dquat());
    rotation.and_then(|rotation| rotation.apply_rgb(&light)).map_err(Failure::input)
}
