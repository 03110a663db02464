//! What is lit: vertices of one mesh or of many instances, that share one tree and one set of samples.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{Buffer, Context, GpuError, Label, Location, Recorder};
use airglow_graph::BufferDesc;
use airglow_math::sh::rotation::Rotation;
use bytemuck::Pod;
use glam::DMat3;

use crate::gpu::refinement::rounds;
use crate::gpu::tree;
use crate::gpu::vertices::{self, GROUP};
use crate::gpu::{EmitterTriangle, LightShape, OldSamples, RefineState, SampleBuffers, Surfaces};
use crate::part::{Chunk, Layout, Part};
use crate::resource::Resource;
use crate::{Hierarchy, PassSettings, RadianceError};

/// Whom this room's memory is charged to.
const OWNER: &str = "radiance";

/// A receiver on the device, with room for its samples.
#[derive(Clone)]
pub struct Receiver {
    pub(crate) settings: PassSettings,
    pub(crate) tree: Staged,
    /// Its vertices in the order of [`Layout`].
    pub(crate) vertices: Staged,
    pub(crate) groups: Staged,
    pub(crate) chunks: Vec<Chunk>,
    /// Bytes of each part's light.
    pub(crate) light_bytes: Vec<u64>,
    /// The rotation of each part, by its index.
    pub(crate) rotations: BTreeMap<u32, Staged>,
    pub(crate) samples: SampleBuffers,
    /// Those of the frame before, where samples are kept.
    pub(crate) old: Option<OldSamples>,
    /// Rounds after which no node is left to split.
    pub(crate) rounds: u32,
    /// Of the root.
    pub(crate) reach: f32,
    /// Whether any vertex reflects light.
    pub(crate) reflects: bool,
    /// The emitters that its samples were taken of.
    sampled: Arc<Mutex<Sampled>>,
}

/// What samples were taken of; no triangle stands for none taken.
#[derive(Debug, Default)]
pub(crate) struct Sampled {
    pub triangles: Vec<EmitterTriangle>,
    pub surfaces: Surfaces,
}

impl Receiver {
    /// Makes buffers of a receiver: the tree over its vertices, built with their transfer vectors, and their positions in
    /// the same order, metres. The copies to the device become part of the next frame that uses it.
    ///
    /// # Errors
    /// [`RadianceError::Length`] unless tree and positions have the same vertices; [`RadianceError::Setting`] for settings
    /// out of range and parts that are no vertices; [`RadianceError::Math`] for a turn that is not orthogonal;
    /// [`RadianceError::Gpu`].
    pub fn new(
        context: &Context,
        settings: PassSettings,
        hierarchy: &Hierarchy,
        positions: &[[f32; 3]],
        parts: &[Part],
    ) -> Result<Self, RadianceError> {
        settings.check()?;
        let (expected, actual) = (hierarchy.vertices().len(), positions.len());
        if expected != actual {
            return Err(RadianceError::Length { what: "the receiver's positions", expected, actual });
        }
        let Some(root) = hierarchy.nodes().first() else {
            return Err(RadianceError::setting("the receiver", "empty", "at least one vertex"));
        };
        let range = u64::from(context.limits().max_storage_buffer_range);
        tree::check_range(hierarchy.nodes().len(), range)?;
        let mut rotations = BTreeMap::new();
        for (index, part) in (0..).zip(parts) {
            if part.vertices.is_empty() || part.vertices.end as usize > positions.len() {
                let given = format!("vertices {:?}", part.vertices);
                return Err(RadianceError::setting("a part of the receiver", given, "some of its vertices"));
            }
            if let Some(turn) = part.turn.filter(|turn| *turn != DMat3::IDENTITY) {
                let matrices = vertices::matrices(&Rotation::from_matrix(settings.order, turn)?);
                rotations.insert(index, Staged::new(context, "radiance rotation", &matrices)?);
            }
        }
        let nodes = tree::nodes(hierarchy, settings.refinement.oracle);
        let Layout { vertices, groups, chunks } =
            Layout::new(hierarchy, positions, parts, chunk(range, settings.light_bytes()));
        // Once where the device reads them and once where they are copied from.
        let staged = size_of_val(&*nodes) + size_of_val(&*vertices) + size_of_val(&*groups);
        let turned: u64 = rotations.values().map(|rotation| rotation.buffer.size()).sum();
        settings.check_budget(nodes.len(), 2 * (staged as u64 + turned), context.memory_left())?;
        Ok(Self {
            settings,
            tree: Staged::new(context, "radiance tree", &nodes)?,
            vertices: Staged::new(context, "radiance vertices", &vertices)?,
            groups: Staged::new(context, "radiance groups", &groups)?,
            chunks,
            light_bytes: parts
                .iter()
                .map(|part| settings.light_bytes() * part.vertices.len() as u64)
                .collect(),
            rotations,
            samples: samples(context, &settings, nodes.len())?,
            old: (settings.keep > 0.0).then(|| old_samples(context, &settings, nodes.len())).transpose()?,
            rounds: rounds(positions.len()),
            reach: root.reach,
            reflects: root.transfer > 0.0,
            sampled: Arc::default(),
        })
    }

    /// Bytes that it holds on the device.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let SampleBuffers { slots, places, points, lights, gradients, state } = &self.samples;
        let samples = [slots, places, points, lights, gradients, state].into_iter();
        let all = samples.chain(self.staged().map(|(_, staged)| &staged.buffer));
        all.map(Buffer::size).sum::<u64>() + self.old.as_ref().map_or(0, OldSamples::bytes)
    }

    /// What is copied to the device once.
    pub(crate) fn staged(&self) -> impl Iterator<Item = (Resource, &Staged)> {
        let rotations = self.rotations.iter().map(|(part, rotation)| (Resource::Rotation(*part), rotation));
        let all = [
            (Resource::Tree, &self.tree),
            (Resource::Vertices, &self.vertices),
            (Resource::Groups, &self.groups),
        ];
        all.into_iter().chain(rotations)
    }

    /// Forgets its samples, so that the next frame takes them again: for a host that threw away a recorded frame.
    pub fn forget_samples(&self) {
        self.sampled().triangles.clear();
    }

    pub(crate) fn sampled(&self) -> MutexGuard<'_, Sampled> {
        self.sampled.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What its samples hold.
    #[must_use]
    pub fn shape(&self) -> LightShape {
        self.settings.shape()
    }

    /// Its samples, for a host that reads them back: to draw them, or to count.
    #[must_use]
    pub fn samples(&self) -> &SampleBuffers {
        &self.samples
    }
}

/// Vertices whose light fits into a binding, a multiple of a workgroup: offsets are then aligned for any device.
fn chunk(range: u64, bytes: u64) -> u32 {
    let group = GROUP as u64;
    (range / (bytes * group) * group).clamp(group, 1 << 30) as u32
}

/// Room for as many samples as the limit allows.
fn samples(context: &Context, settings: &PassSettings, nodes: usize) -> Result<SampleBuffers, RadianceError> {
    let (shape, limit) = (settings.shape(), settings.refinement.limit.min(nodes));
    let make = |name, size| kept(context, name, size);
    Ok(SampleBuffers {
        slots: make("radiance slots", 4 * nodes as u64)?,
        places: make("radiance places", 4 * limit as u64)?,
        points: make("radiance points", 16 * limit as u64)?,
        lights: make("radiance lights", shape.light_bytes(limit))?,
        gradients: make("radiance gradients", shape.gradient_bytes(limit))?,
        state: make("radiance state", size_of::<RefineState>() as u64)?,
    })
}

/// As much room for those of the frame before.
fn old_samples(
    context: &Context,
    settings: &PassSettings,
    nodes: usize,
) -> Result<OldSamples, RadianceError> {
    let (shape, limit) = (settings.shape(), settings.refinement.limit.min(nodes));
    let make = |name, size| kept(context, name, size);
    Ok(OldSamples {
        places: make("radiance old places", 4 * limit as u64)?,
        lights: make("radiance old lights", shape.light_bytes(limit))?,
        gradients: make("radiance old gradients", shape.gradient_bytes(limit))?,
        state: make("radiance old state", size_of::<RefineState>() as u64)?,
    })
}

/// A buffer that lives from frame to frame.
fn kept(context: &Context, name: &str, size: u64) -> Result<Buffer, GpuError> {
    let usage = BufferUsageFlags::STORAGE_BUFFER
        | BufferUsageFlags::INDIRECT_BUFFER
        | BufferUsageFlags::TRANSFER_SRC
        | BufferUsageFlags::TRANSFER_DST;
    context.create_buffer(Label::new(OWNER, name), &BufferDesc { size, usage }, Location::Device)
}

/// A buffer of the device and what is still to be copied there, once.
#[derive(Clone)]
pub(crate) struct Staged {
    pub buffer: Buffer,
    staging: Arc<Mutex<Option<Buffer>>>,
}

impl Staged {
    pub(crate) fn new<T: Pod>(context: &Context, name: &str, values: &[T]) -> Result<Self, GpuError> {
        let size = size_of_val(values) as u64;
        let make = |usage, location| {
            context.create_buffer(Label::new(OWNER, name), &BufferDesc { size, usage }, location)
        };
        let staging = make(BufferUsageFlags::TRANSFER_SRC, Location::Upload)?;
        staging.write(0, values)?;
        let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::TRANSFER_DST;
        Ok(Self { buffer: make(usage, Location::Device)?, staging: Arc::new(Mutex::new(Some(staging))) })
    }

    /// Whether the copy was not recorded yet.
    pub(crate) fn is_pending(&self) -> bool {
        self.staging().is_some()
    }

    pub(crate) fn record(&self, recorder: &mut Recorder<'_>) -> Result<(), GpuError> {
        match self.staging().take() {
            Some(staging) => recorder.copy_buffer(&staging, &self.buffer),
            None => Ok(()),
        }
    }

    fn staging(&self) -> MutexGuard<'_, Option<Buffer>> {
        self.staging.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
