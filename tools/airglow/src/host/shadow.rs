//! The shadow pass with a scene: its spheres, the receivers of every instance, and what it counts.

use airglow::shadow::spheres::{Hierarchy, Node};
use airglow::shadow::{self, Blockers, Counts, Receivers, Shadow, Sphere};
use airglow_gpu::{Buffer, Imports, Look, Record, Requirements};
use airglow_graph::{self as graph, Access, Graph, Handle, LeftOut};
use airglow_scene::{Mesh, Scene};
use glam::{DMat4, DVec3, Mat4};

use super::device::Device;
use super::kept::Kept;
use super::skin::{self, Posed};
use super::spheres::InstanceSpheres;
use super::transfer::SceneTransfer;
use super::upload;
use crate::failure::{Failure, Outcome};

/// Bands that shadows can have.
const ORDERS: std::ops::RangeInclusive<u32> = 3..=6;

/// The pass with a scene's spheres and receivers.
pub struct SceneShadow {
    pass: Shadow,
    instances: Vec<Instance>,
    spheres: Blocking,
    moving: Scene,
}

/// What casts shadows.
pub struct Blocking {
    fixed: Vec<Sphere>,
    moving: Vec<InstanceSpheres>,
    /// Of each of these, what stands for many spheres from afar.
    hierarchies: Vec<Hierarchy>,
}

/// The vertices of an instance.
struct Instance {
    receivers: Receivers,
    blockers: Blockers,
    /// To the space that the transfer of the instance is in.
    receiver_from_world: DMat4,
    /// Positions and normals in that space; none for an instance that moves, whose posed ones are taken.
    vertices: Option<[Buffer; 2]>,
}

/// What a frame has of the pass.
#[derive(Default)]
pub struct Shadowed {
    /// Visibility of each instance's vertices.
    pub visibility: Vec<Option<Handle<graph::Buffer>>>,
    /// What the clusters of all instances counted, once the frame is done; filled only if it was asked for.
    pub counts: Vec<CountsSlot>,
    /// What a tally of the room's counters looks at.
    pub looks: Vec<Look<Handle<graph::Buffer>>>,
}

/// What is read back of an instance's clusters.
pub type CountsSlot = Kept;

/// Whether a scene has something that moves or is stated to cast shadows.
fn blocks(scene: &Scene) -> bool {
    !scene.blockers.is_empty() || scene.figures.iter().any(|figure| figure.spheres > 0)
}

/// Whether the pass has something to do in a scene.
pub fn is_drawn(scene: &Scene) -> bool {
    blocks(scene) && ORDERS.contains(&scene.quality.order)
}

/// A scene in which nothing that moves casts shadows; figures stay.
pub fn without(mut scene: Scene) -> Scene {
    scene.blockers.clear();
    scene.figures.iter_mut().for_each(|figure| figure.spheres = 0);
    scene
}

/// What the device must offer for a scene.
pub fn requirements(scene: &Scene) -> Requirements {
    if is_drawn(scene) { Shadow::requirements() } else { Requirements::engine() }
}

/// Bytes of the visibility of all vertices.
fn bytes(scene: &Scene) -> u64 {
    let vertices = |instance: &airglow_scene::Instance| scene.meshes[instance.mesh].positions.len() as u64;
    let count: u64 = scene.instances.iter().map(vertices).sum();
    4 * u64::from(scene.quality.order).pow(2) * count
}

/// The record of the pass being left out of a scene in which no light falls that it could take away, or which it has no
/// part in.
pub fn left_out(scene: &Scene) -> LeftOut {
    let (why, would_return) = match (blocks(scene), is_drawn(scene)) {
        (false, _) => ("nothing that moves blocks", "a [[figure]] or a [[blocker]] in the scene file"),
        (true, false) => ("it has no tables for so many bands", "3 to 6 bands"),
        (true, true) => ("nothing is relit that it could darken", "an environment or an [[emitter]]"),
    };
    record(why, would_return, bytes(scene))
}

/// The record of the pass being left out by the host.
pub fn asked(bytes: u64) -> LeftOut {
    record("the host was asked to leave it out (--without shadow)", "a frame without --without shadow", bytes)
}

fn record(why: &str, would_return: &str, bytes: u64) -> LeftOut {
    let [what, why, would_return] = ["shadow", why, would_return].map(str::to_owned);
    LeftOut { what, why, bytes, time: None, would_return }
}

/// The settings of the pass for a scene.
pub fn settings(scene: &Scene) -> shadow::Settings {
    let asked = scene.presets.of("shadow").map_or_else(shadow::Settings::default, shadow::Settings::from);
    shadow::Settings { order: scene.quality.order as usize, normals: true, ..asked }
}

impl SceneShadow {
    /// The pass for a scene, where it has something to do.
    pub fn new(device: &Device<'_>, scene: &Scene, transfer: &SceneTransfer) -> Outcome<Option<Self>> {
        if !is_drawn(scene) {
            return Ok(None);
        }
        Self::with_settings(device, scene, transfer, settings(scene)).map(Some)
    }

    /// The same with other settings than the scene asks for, where it has something to do.
    pub fn with_settings(
        device: &Device<'_>,
        scene: &Scene,
        transfer: &SceneTransfer,
        settings: shadow::Settings,
    ) -> Outcome<Self> {
        let pass = Shadow::new(device.context(), settings).map_err(Failure::work)?;
        let mut instances = Vec::with_capacity(scene.instances.len());
        for (number, lit) in transfer.instances.iter().enumerate() {
            // Baked in the world, or in the space of the object.
            let frame = if lit.in_world { Mat4::IDENTITY } else { scene.instances[number].transform };
            instances.push(Instance::new(device, &pass, scene, number, frame)?);
        }
        let spheres = Blocking::new(scene, transfer.spheres.clone(), settings.order)?;
        let shadow = Self { pass, instances, spheres, moving: skin::moving(scene) };
        shadow.set_time(0.0)?;
        Ok(shadow)
    }

    /// Puts the figures where they start in a scene that has moved them.
    #[cfg(feature = "view")]
    pub fn place_figures(&mut self, scene: &Scene) {
        self.moving = skin::moving(scene);
    }

    /// The spheres where they are `seconds` after the scene's time 0, in the world.
    #[cfg(feature = "view")]
    pub fn spheres(&self, seconds: f32) -> Vec<Sphere> {
        let moved = |own: &InstanceSpheres| {
            let figure = &self.moving.figures[own.figure];
            own.in_pose(&self.moving, &self.moving.pose(figure, seconds))
        };
        let moving = self.spheres.moving.iter().flat_map(moved);
        self.spheres.fixed.iter().copied().chain(moving).collect()
    }

    /// Moves the spheres to where they are `seconds` after the scene's time 0, from the next recording on.
    pub fn set_time(&self, seconds: f32) -> Outcome {
        let nodes = self.spheres.nodes(&self.moving, seconds)?;
        let set = |instance: &Instance| instance.blockers.set_nodes(&nodes, instance.receiver_from_world);
        self.instances.iter().try_for_each(set).map_err(Failure::input)
    }

    /// Adds the pass for every instance; those that move bring their vertices. With `count` the counts are read back.
    pub fn add(
        &self,
        graph: &mut Graph<Record>,
        imports: &mut Imports,
        posed: &[Posed],
        count: bool,
    ) -> Shadowed {
        let mut shadowed = Shadowed::default();
        for (number, instance) in self.instances.iter().enumerate() {
            let moved = posed.iter().find(|posed| posed.instance == number);
            let vertices = match (&instance.vertices, moved) {
                (Some(buffers), _) => Some(import(graph, imports, buffers)),
                (None, moved) => moved.map(|moved| [moved.positions, moved.normals]),
            };
            let Some([positions, normals]) = vertices else {
                shadowed.visibility.push(None);
                continue;
            };
            let Instance { receivers, blockers, .. } = instance;
            let added = self.pass.add(graph, receivers, blockers, positions, Some(normals));
            shadowed.visibility.push(added.visibility);
            if let (Some(visibility), Some(records)) = (added.visibility, added.records) {
                let order = self.pass.settings().order;
                let looks = receivers.looks(order, positions, Some(normals), visibility, records);
                shadowed.looks.extend(looks);
            }
            if let (true, Some(records)) = (count, added.records) {
                shadowed.counts.push(Kept::add(graph, "shadow counts", records));
            }
        }
        shadowed
    }

    /// Bytes of the visibility of all vertices.
    pub fn bytes(&self) -> u64 {
        let order = self.pass.settings().order;
        self.instances.iter().map(|instance| instance.receivers.visibility_bytes(order)).sum()
    }

    /// Spheres of a frame.
    pub fn sphere_count(&self) -> usize {
        self.spheres.fixed.len() + self.spheres.moving.iter().map(InstanceSpheres::count).sum::<usize>()
    }
}

impl Blocking {
    /// The blockers of a scene and the spheres of its figures, with ratios for so many bands.
    pub fn new(scene: &Scene, moving: Vec<InstanceSpheres>, order: usize) -> Outcome<Self> {
        let fixed = scene.blockers.iter().map(|blocker| Sphere {
            center: DVec3::from_array(blocker.center.map(f64::from)),
            radius: f64::from(blocker.radius),
        });
        Ok(Self { fixed: fixed.collect(), hierarchies: hierarchies(&moving, order)?, moving })
    }

    /// In the world, as figures stand `seconds` after the scene's time 0.
    pub fn nodes(&self, scene: &Scene, seconds: f32) -> Outcome<Vec<Node>> {
        let poses: Vec<_> = scene.figures.iter().map(|figure| scene.pose(figure, seconds)).collect();
        let mut nodes: Vec<Node> = self.fixed.iter().copied().map(Node::alone).collect();
        for (moved, hierarchy) in self.moving.iter().zip(&self.hierarchies) {
            let spheres = moved.in_pose(scene, &poses[moved.figure]);
            nodes.extend(hierarchy.posed(&spheres).map_err(Failure::work)?);
        }
        Ok(nodes)
    }
}

/// One for each instance; those of the same spheres are made once.
fn hierarchies(instances: &[InstanceSpheres], order: usize) -> Outcome<Vec<Hierarchy>> {
    let mut made: Vec<Hierarchy> = Vec::with_capacity(instances.len());
    for (index, own) in instances.iter().enumerate() {
        let same = instances[..index].iter().position(|other| other.spheres == own.spheres);
        let hierarchy = match same.and_then(|same| made.get(same)) {
            Some(hierarchy) => hierarchy.clone(),
            None => Hierarchy::new(&own.spheres, order).map_err(Failure::work)?,
        };
        made.push(hierarchy);
    }
    Ok(made)
}

impl Instance {
    /// The instance of that number, whose transfer is in `world_from_receiver`.
    fn new(
        device: &Device<'_>,
        pass: &Shadow,
        scene: &Scene,
        number: usize,
        world_from_receiver: Mat4,
    ) -> Outcome<Self> {
        let name = &scene.instances[number].name;
        let (positions, normals) = still_receivers(scene, number, world_from_receiver);
        let receivers = pass.receivers(device.context(), name, &positions).map_err(Failure::work)?;
        let read = Access::ComputeStorageRead;
        let vertices = (!scene.moves(number)).then(|| {
            device.run(|recorder| {
                Ok([
                    upload::buffer(recorder, "receivers", &positions, read)?,
                    upload::buffer(recorder, "normals of receivers", &normals, read)?,
                ])
            })
        });
        let vertices = vertices.transpose().map_err(Failure::work)?;
        let receiver_from_world = world_from_receiver.inverse().as_dmat4();
        Ok(Self { receivers, blockers: Blockers::default(), receiver_from_world, vertices })
    }
}

/// Positions and normals of an instance, were it to stand still, in the space that its transfer is in.
pub fn still_receivers(
    scene: &Scene,
    number: usize,
    world_from_receiver: Mat4,
) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let instance = &scene.instances[number];
    let mesh = &scene.meshes[instance.mesh];
    match world_from_receiver == instance.transform {
        true => (mesh.positions.clone(), mesh.normals.clone()),
        false => still(mesh).posed(&[world_from_receiver.inverse() * instance.transform]),
    }
}

/// A mesh in its bind pose.
fn still(mesh: &Mesh) -> Mesh {
    Mesh { positions: mesh.positions.clone(), normals: mesh.normals.clone(), ..Mesh::default() }
}

/// Arrays that do not change between frames.
fn import(
    graph: &mut Graph<Record>,
    imports: &mut Imports,
    buffers: &[Buffer; 2],
) -> [Handle<graph::Buffer>; 2] {
    let mut import = |name, buffer: &Buffer| {
        let read = Access::ComputeStorageRead;
        let handle = graph.import_buffer(name, *buffer.desc(), read, read);
        imports.buffer(&handle, buffer);
        handle
    };
    [import("receivers", &buffers[0]), import("normals of receivers", &buffers[1])]
}

/// The sum of what was read back, once the frame is done.
pub fn counts(slots: &[CountsSlot]) -> Outcome<Counts> {
    let mut records: Vec<[u32; 2]> = Vec::new();
    for slot in slots {
        records.extend(slot.take::<[u32; 2]>()?);
    }
    Ok(Counts::of(&records))
}
