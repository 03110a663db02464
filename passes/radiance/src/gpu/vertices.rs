//! Light vectors of vertices from samples, on the device.

use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Buffer, BufferSlice, ComputePipeline, Context, GpuError, Kernel,
    Recorder,
};
use airglow_math::sh::rotation::Rotation;
use bytemuck::{Pod, Zeroable};

use super::{DeviceNode, LightShape, SampleBuffers};
use crate::{DARK, OVERLAP, RadianceError, TRUST};

/// Vertices of a workgroup of [`module`].
pub const GROUP: usize = 256;
/// Vertices of a workgroup of [`turn_module`].
const TURN_GROUP: u32 = 64;

macro_rules! by_order {
    ($before:literal) => {
        [
            include_bytes!(concat!("../../../../shaders/spirv/radiance/", $before, "3.spv")).as_slice(),
            include_bytes!(concat!("../../../../shaders/spirv/radiance/", $before, "4.spv")).as_slice(),
            include_bytes!(concat!("../../../../shaders/spirv/radiance/", $before, "5.spv")).as_slice(),
            include_bytes!(concat!("../../../../shaders/spirv/radiance/", $before, "6.spv")).as_slice(),
        ]
    };
}

/// By gradients, order - 3.
static VERTICES: [[&[u8]; 4]; 2] = [by_order!("vertices.ORDER"), by_order!("vertices.GRADIENTS.ORDER")];
/// By order - 3.
static TURN: [&[u8]; 4] = by_order!("turn.ORDER");

fn of_order(modules: &[&'static [u8]; 4], order: usize) -> Option<&'static [u8]> {
    modules.get(order.checked_sub(3)?).copied()
}

/// The module that makes light from samples of this shape; `None` for an order that has none.
#[must_use]
pub fn module(shape: LightShape) -> Option<&'static [u8]> {
    of_order(&VERTICES[usize::from(shape.gradients)], shape.order)
}

/// The module that turns light into the space of an instance; `None` for an order that has none.
#[must_use]
pub fn turn_module(order: usize) -> Option<&'static [u8]> {
    of_order(&TURN, order)
}

/// What [`turn_module`] binds.
pub const TURN_BINDINGS: [BindingDesc; 2] =
    [BindingDesc::new(0, BindingKind::StorageBuffer), BindingDesc::new(1, BindingKind::StorageBuffer)];

/// What [`module`] binds.
#[must_use]
pub fn bindings(shape: LightShape) -> Vec<BindingDesc> {
    let mut bindings: Vec<_> = (0..8).map(|i| BindingDesc::new(i, BindingKind::StorageBuffer)).collect();
    bindings.push(BindingDesc::new(8, BindingKind::UniformBuffer));
    bindings.extend(shape.gradients.then_some(BindingDesc::new(9, BindingKind::StorageBuffer)));
    bindings
}

/// A vertex as the kernel reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DeviceVertex {
    /// Metres.
    pub position: [f32; 3],
    /// Place in the light that is written.
    pub place: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Constants {
    count: u32,
    first: u32,
    first_group: u32,
    nodes: u32,
    overlap: f32,
    trust: f32,
    largest: f32,
    dark: f32,
}

/// Bytes of the push constants of [`module`].
pub const CONSTANTS: u32 = size_of::<Constants>() as u32;

/// Light from samples, and its turning into the space of an instance.
pub(crate) fn kernels(shape: LightShape) -> Result<[Kernel; 2], RadianceError> {
    let (Some(light), Some(turn)) = (module(shape), turn_module(shape.order)) else {
        return Err(RadianceError::setting("order", shape.order, "3 to 6 bands"));
    };
    Ok([
        Kernel::compute("radiance vertices", light, &bindings(shape), CONSTANTS as usize),
        Kernel::compute("radiance turn", turn, &TURN_BINDINGS, 4),
    ])
}

/// The kernels over vertices.
#[derive(Clone)]
pub struct VertexKernels {
    shape: LightShape,
    light: ComputePipeline,
    turn: ComputePipeline,
}

/// Where the kernel over vertices reads and writes.
#[derive(Clone, Copy)]
pub struct VertexWork<'a> {
    /// The tree.
    pub nodes: &'a Buffer,
    /// The samples.
    pub samples: &'a SampleBuffers,
    /// All vertices, [`DeviceVertex`] each.
    pub vertices: &'a Buffer,
    /// A ball for each [`GROUP`] of them.
    pub groups: &'a Buffer,
    /// The first vertex.
    pub first: u32,
    /// Its group.
    pub first_group: u32,
    /// How many there are.
    pub count: u32,
    /// Their light: `[[f32; 3]; order^2]` each.
    pub light: &'a BufferSlice,
    /// Light from far away, `vec4[order^2]`.
    pub distant: &'a BufferSlice,
    /// Reach of the root.
    pub reach: f32,
}

impl VertexKernels {
    /// Makes the kernels.
    ///
    /// # Errors
    /// [`RadianceError::Setting`] for an order but 3 to 6; [`RadianceError::Gpu`] when the device refuses.
    pub fn new(context: &Context, shape: LightShape) -> Result<Self, RadianceError> {
        Self::with_kernels(shape, |kernel| kernel.compute_pipeline(context))
    }

    /// The same with pipelines that `find` has for the kernels.
    pub(crate) fn with_kernels(
        shape: LightShape,
        find: impl Fn(&Kernel) -> Result<ComputePipeline, GpuError>,
    ) -> Result<Self, RadianceError> {
        let [light, turn] = kernels(shape)?;
        Ok(Self { shape, light: find(&light)?, turn: find(&turn)? })
    }

    /// Records the light of some vertices. The barriers before and after are the caller's.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for buffers that do not fit.
    pub fn record(&self, recorder: &mut Recorder<'_>, work: &VertexWork<'_>) -> Result<(), GpuError> {
        let samples = work.samples;
        let bound = [
            Binding::storage(0, work.nodes),
            Binding::storage(1, &samples.slots),
            Binding::storage(2, &samples.places),
            Binding::storage(3, &samples.lights),
            Binding::storage(4, &samples.state),
            Binding::storage(5, work.vertices),
            Binding::storage(6, work.groups),
            Binding::storage(7, work.light.clone()),
            Binding::uniform(8, work.distant.clone()),
            Binding::storage(9, &samples.gradients),
        ];
        recorder.bind_compute(&self.light, &bound[..9 + usize::from(self.shape.gradients)])?;
        recorder.push_constants(&Constants {
            count: work.count,
            first: work.first,
            first_group: work.first_group,
            nodes: (work.nodes.size() / size_of::<DeviceNode>() as u64) as u32,
            overlap: OVERLAP as f32,
            trust: TRUST as f32,
            largest: (OVERLAP as f32 * work.reach).max(f32::MIN_POSITIVE),
            dark: DARK.sqrt() as f32,
        })?;
        recorder.dispatch([work.count.div_ceil(GROUP as u32), 1, 1])
    }

    /// Records the rotation of `count` vertices' light by [`matrices`], after a barrier of the caller's.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for buffers that do not fit.
    pub fn record_turn(
        &self,
        recorder: &mut Recorder<'_>,
        rotation: &Buffer,
        light: &BufferSlice,
        count: u32,
    ) -> Result<(), GpuError> {
        let bound = [Binding::storage(0, rotation), Binding::storage(1, light.clone())];
        recorder.bind_compute(&self.turn, &bound)?;
        recorder.push_constants(&count)?;
        recorder.dispatch([count.div_ceil(TURN_GROUP), 1, 1])
    }
}

/// The matrices of a rotation as the kernel reads them: band after band, row-major.
#[must_use]
pub fn matrices(rotation: &Rotation) -> Vec<f32> {
    rotation.matrices().iter().map(|element| *element as f32).collect()
}
