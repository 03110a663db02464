//! Figures on the device: a pass of the host's that poses their vertices in each frame.

use std::sync::{Arc, Mutex, PoisonError};

use airglow_gpu::ash::vk;
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Buffer, ComputePipeline, ComputePipelineDesc, GpuError, Imports,
    Label, Location, Record, Recorder, Resources,
};
use airglow_graph::{self as graph, Access, BufferDesc, Graph, Handle, PassBuilder, PassKind};
use airglow_scene::{Mesh, Scene};
use glam::Mat4;

use super::device::Device;
use super::scene::DeviceScene;
use super::{shaders, upload};
use crate::failure::{Failure, Outcome};

/// Joints that the kernel takes; further ones move nothing.
const MAX_JOINTS: usize = 256;

/// The instances that move, and what moves them.
pub struct Skins {
    pipeline: ComputePipeline,
    parts: Vec<Part>,
    /// Nodes, skins, animations and figures of the scene.
    moving: Scene,
}

/// An instance of a figure.
struct Part {
    figure: usize,
    instance: usize,
    vertices: u32,
    /// Positions, normals, joints and weights at rest.
    rest: [Buffer; 4],
    /// Positions and normals in the world.
    posed: [Buffer; 2],
    joints: Arc<Mutex<Vec<[f32; 4]>>>,
}

/// An instance posed in a frame.
#[derive(Clone, Copy, Debug)]
pub struct Posed {
    /// Its index in the scene.
    pub instance: usize,
    /// `[f32; 3]` a vertex, in the world.
    pub positions: Handle<graph::Buffer>,
    /// The same, of length 1.
    pub normals: Handle<graph::Buffer>,
}

impl Posed {
    /// Declares that a pass draws it.
    pub fn read(&self, pass: &mut PassBuilder<'_, Record>) {
        pass.read(&self.positions, Access::VertexBuffer).read(&self.normals, Access::VertexBuffer);
    }
}

const BINDINGS: [BindingDesc; 7] = [
    BindingDesc::new(0, BindingKind::StorageBuffer),
    BindingDesc::new(1, BindingKind::StorageBuffer),
    BindingDesc::new(2, BindingKind::StorageBuffer),
    BindingDesc::new(3, BindingKind::StorageBuffer),
    BindingDesc::new(4, BindingKind::UniformBuffer),
    BindingDesc::new(5, BindingKind::StorageBuffer),
    BindingDesc::new(6, BindingKind::StorageBuffer),
];

impl Skins {
    /// Uploads the figures of a scene and has its draws take their posed vertices; `None` where nothing moves.
    pub fn new(device: &Device<'_>, scene: &Scene, drawn: &mut DeviceScene) -> Outcome<Option<Self>> {
        if scene.figures.is_empty() {
            return Ok(None);
        }
        let pipeline = device.context().create_compute_pipeline(&ComputePipelineDesc {
            name: "skin",
            spirv: &shaders::skin(),
            bindings: &BINDINGS,
            push_constant_size: size_of::<u32>() as u32,
        });
        let mut skins =
            Self { pipeline: pipeline.map_err(Failure::work)?, parts: Vec::new(), moving: moving(scene) };
        for (figure, index) in scene.figures.iter().zip(0..) {
            for (instance, mesh) in figure.instances.clone().zip(&figure.meshes) {
                let part = device
                    .run(|recorder| Part::upload(recorder, &scene.meshes[*mesh], index, instance))
                    .map_err(Failure::work)?;
                let mesh = &mut drawn.draws[instance].mesh;
                mesh.positions = part.posed[0].clone();
                mesh.normals = mesh.normals.as_ref().map(|_| part.posed[1].clone());
                skins.parts.push(part);
            }
        }
        skins.set_time(0.0);
        Ok(Some(skins))
    }

    /// Puts the figures where they start in a scene that has moved them.
    #[cfg(feature = "view")]
    pub fn place(&mut self, scene: &Scene) {
        self.moving = moving(scene);
    }

    /// Poses the figures as they are `seconds` after the scene's time 0, from the next recording on.
    pub fn set_time(&self, seconds: f32) {
        let poses: Vec<_> =
            self.moving.figures.iter().map(|figure| self.moving.pose(figure, seconds)).collect();
        for part in &self.parts {
            let joints = self.moving.joints(&self.moving.instances[part.instance], &poses[part.figure]);
            let rows = |matrix: &Mat4| [0, 1, 2].map(|row| matrix.row(row).to_array());
            let mut held = part.joints.lock().unwrap_or_else(PoisonError::into_inner);
            held.clear();
            held.extend(joints.iter().take(MAX_JOINTS).flat_map(rows));
            held.resize(3 * MAX_JOINTS, [0.0; 4]);
        }
    }

    /// Adds the pass; other passes read what it writes.
    pub fn add(&self, graph: &mut Graph<Record>, imports: &mut Imports) -> Vec<Posed> {
        let mut pass_over = |part: &Part| {
            // The draw of the frame before still reads them when this one begins.
            let mut import = |name, buffer: &Buffer| {
                let handle =
                    graph.import_buffer(name, *buffer.desc(), Access::VertexBuffer, Access::VertexBuffer);
                imports.buffer(&handle, buffer);
                handle
            };
            let [positions, normals] =
                [import("posed positions", &part.posed[0]), import("posed normals", &part.posed[1])];
            let mut pass = graph.pass("skin", PassKind::Compute);
            let positions = pass.write(positions, Access::ComputeStorageWrite);
            let normals = pass.write(normals, Access::ComputeStorageWrite);
            let (pipeline, rest, vertices) = (self.pipeline.clone(), part.rest.clone(), part.vertices);
            let joints = Arc::clone(&part.joints);
            pass.record(Box::new(move |recorder, resources| {
                let joints = joints.lock().unwrap_or_else(PoisonError::into_inner);
                record(recorder, resources, &pipeline, &rest, &joints, [&positions, &normals], vertices)
            }));
            Posed { instance: part.instance, positions, normals }
        };
        self.parts.iter().map(&mut pass_over).collect()
    }
}

/// Joints and weights of each vertex; a mesh without a skin follows its node, the one joint there is.
pub fn bound(mesh: &Mesh) -> (Vec<[u16; 4]>, Vec<[f32; 4]>) {
    let (mut joints, mut weights) = (mesh.joints.clone(), mesh.weights.clone());
    joints.resize(mesh.positions.len(), [0; 4]);
    weights.resize(mesh.positions.len(), [1.0, 0.0, 0.0, 0.0]);
    (joints, weights)
}

/// What is needed to move the figures of a scene.
pub fn moving(scene: &Scene) -> Scene {
    Scene {
        instances: scene.instances.clone(),
        nodes: scene.nodes.clone(),
        skins: scene.skins.clone(),
        animations: scene.animations.clone(),
        figures: scene.figures.clone(),
        ..Scene::default()
    }
}

fn record(
    recorder: &mut Recorder<'_>,
    resources: &Resources<'_>,
    pipeline: &ComputePipeline,
    rest: &[Buffer; 4],
    joints: &[[f32; 4]],
    posed: [&Handle<graph::Buffer>; 2],
    vertices: u32,
) -> Result<(), GpuError> {
    let joints = recorder.upload(joints)?;
    let [a, b, c, d] = rest;
    recorder.bind_compute(
        pipeline,
        &[
            Binding::storage(0, a),
            Binding::storage(1, b),
            Binding::storage(2, c),
            Binding::storage(3, d),
            Binding::uniform(4, &joints),
            Binding::storage(5, resources.buffer(posed[0])?),
            Binding::storage(6, resources.buffer(posed[1])?),
        ],
    )?;
    recorder.push_constants(&vertices)?;
    recorder.dispatch([vertices.div_ceil(64), 1, 1])
}

impl Part {
    fn upload(
        recorder: &mut Recorder<'_>,
        mesh: &Mesh,
        figure: usize,
        instance: usize,
    ) -> Result<Self, GpuError> {
        let count = mesh.positions.len();
        let (joints, weights) = bound(mesh);
        let read = Access::ComputeStorageRead;
        let rest = [
            upload::buffer(recorder, "rest positions", &mesh.positions, read)?,
            upload::buffer(recorder, "rest normals", &mesh.normals, read)?,
            upload::buffer(recorder, "joints", &joints, read)?,
            upload::buffer(recorder, "weights", &weights, read)?,
        ];
        let usage = Access::VertexBuffer.buffer_usage() | vk::BufferUsageFlags::STORAGE_BUFFER;
        let desc = BufferDesc { size: 12 * count as u64, usage };
        let context = recorder.context();
        let posed = |name| context.create_buffer(Label::new(upload::OWNER, name), &desc, Location::Device);
        let posed = [posed("posed positions")?, posed("posed normals")?];
        Ok(Self { figure, instance, vertices: count as u32, rest, posed, joints: Arc::default() })
    }
}
