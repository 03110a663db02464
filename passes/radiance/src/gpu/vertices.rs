//! Light vectors of vertices from samples, on the device.

use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Buffer, BufferSlice, ComputePipeline, ComputePipelineDesc,
};
use airglow_gpu::{Context, GpuError, Recorder};
use airglow_math::sh::rotation::Rotation;
use bytemuck::{Pod, Zeroable};

use super::{LightShape, SampleBuffers};
use crate::{OVERLAP, RadianceError, TRUST};

/// Invocations of a workgroup, a vertex each.
pub const WORKGROUP: u32 = 64;

macro_rules! by_order {
    ($before:literal, $after:literal) => {
        [
            include_bytes!(concat!("../../../../shaders/spirv/radiance/", $before, "3", $after)).as_slice(),
            include_bytes!(concat!("../../../../shaders/spirv/radiance/", $before, "4", $after)).as_slice(),
            include_bytes!(concat!("../../../../shaders/spirv/radiance/", $before, "5", $after)).as_slice(),
            include_bytes!(concat!("../../../../shaders/spirv/radiance/", $before, "6", $after)).as_slice(),
        ]
    };
}

/// By gradients, rotation, order - 3.
static VERTICES: [[[&[u8]; 4]; 2]; 2] = [
    [by_order!("vertices.ORDER", ".spv"), by_order!("vertices.ORDER", ".ROTATE.spv")],
    [by_order!("vertices.GRADIENTS.ORDER", ".spv"), by_order!("vertices.GRADIENTS.ORDER", ".ROTATE.spv")],
];

/// The module for samples of this shape; with `rotate` it turns light into the space of an instance. `None` for an order
/// that has none.
#[must_use]
pub fn module(shape: LightShape, rotate: bool) -> Option<&'static [u8]> {
    let place = shape.order.checked_sub(3)?;
    VERTICES[usize::from(shape.gradients)][usize::from(rotate)].get(place).copied()
}

/// What the module binds.
#[must_use]
pub fn bindings(shape: LightShape, rotate: bool) -> Vec<BindingDesc> {
    let mut bindings: Vec<_> = (0..7).map(|i| BindingDesc::new(i, BindingKind::StorageBuffer)).collect();
    bindings.push(BindingDesc::new(7, BindingKind::UniformBuffer));
    bindings.extend(shape.gradients.then_some(BindingDesc::new(8, BindingKind::StorageBuffer)));
    bindings.extend(rotate.then_some(BindingDesc::new(9, BindingKind::StorageBuffer)));
    bindings
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Constants {
    vertices: u32,
    nodes: u32,
    overlap: f32,
    trust: f32,
    largest: f32,
}

/// Bytes of the push constants of the kernels.
pub const CONSTANTS: u32 = size_of::<Constants>() as u32;

/// The kernels over vertices.
#[derive(Clone)]
pub struct VertexKernels {
    shape: LightShape,
    plain: ComputePipeline,
    rotating: ComputePipeline,
}

/// Where a kernel over vertices reads and writes.
#[derive(Clone, Copy)]
pub struct VertexWork<'a> {
    /// The tree.
    pub nodes: &'a Buffer,
    /// The samples.
    pub samples: &'a SampleBuffers,
    /// Positions of the vertices, `[f32; 3]` each, metres.
    pub positions: &'a BufferSlice,
    /// Their light: `[[f32; 3]; order^2]` each.
    pub light: &'a BufferSlice,
    /// How many there are.
    pub vertices: u32,
    /// Light from far away, `vec4[order^2]`.
    pub distant: &'a BufferSlice,
    /// Matrices of the rotation into the space of an instance, as [`matrices`] gives them; `None` for none.
    pub rotation: Option<&'a Buffer>,
    /// Reach of the root.
    pub reach: f32,
}

impl VertexKernels {
    /// Makes the kernels.
    ///
    /// # Errors
    /// [`RadianceError::Setting`] for an order but 3 to 6; [`RadianceError::Gpu`] when the device refuses.
    pub fn new(context: &Context, shape: LightShape) -> Result<Self, RadianceError> {
        let make = |rotate| {
            let refused = || RadianceError::setting("order", shape.order, "3 to 6 bands");
            let spirv = super::words(module(shape, rotate).ok_or_else(refused)?);
            let desc = ComputePipelineDesc {
                name: "radiance vertices",
                spirv: &spirv,
                bindings: &bindings(shape, rotate),
                push_constant_size: CONSTANTS,
            };
            Ok::<_, RadianceError>(context.create_compute_pipeline(&desc)?)
        };
        Ok(Self { shape, plain: make(false)?, rotating: make(true)? })
    }

    /// Records the light of some vertices. The barriers before and after are the caller's.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for buffers that do not fit.
    pub fn record(&self, recorder: &mut Recorder<'_>, work: &VertexWork<'_>) -> Result<(), GpuError> {
        let samples = work.samples;
        let [a, b, c, d, e, f, g, h] = [
            Binding::storage(0, work.nodes),
            Binding::storage(1, &samples.slots),
            Binding::storage(2, &samples.places),
            Binding::storage(3, &samples.lights),
            Binding::storage(4, &samples.state),
            Binding::storage(5, work.positions.clone()),
            Binding::storage(6, work.light.clone()),
            Binding::uniform(7, work.distant.clone()),
        ];
        let slopes = || Binding::storage(8, &samples.gradients);
        // Arrays, not a list: recording leaves the heap alone.
        match (self.shape.gradients, work.rotation.map(|rotation| Binding::storage(9, rotation))) {
            (false, None) => recorder.bind_compute(&self.plain, &[a, b, c, d, e, f, g, h]),
            (true, None) => recorder.bind_compute(&self.plain, &[a, b, c, d, e, f, g, h, slopes()]),
            (false, Some(turn)) => recorder.bind_compute(&self.rotating, &[a, b, c, d, e, f, g, h, turn]),
            (true, Some(turn)) => {
                recorder.bind_compute(&self.rotating, &[a, b, c, d, e, f, g, h, slopes(), turn])
            }
        }?;
        recorder.push_constants(&Constants {
            vertices: work.vertices,
            nodes: (work.nodes.size() / size_of::<super::DeviceNode>() as u64) as u32,
            overlap: OVERLAP as f32,
            trust: TRUST as f32,
            largest: (OVERLAP as f32 * work.reach).max(f32::MIN_POSITIVE),
        })?;
        recorder.dispatch([work.vertices.div_ceil(WORKGROUP), 1, 1])
    }
}

/// The matrices of a rotation as the kernel reads them: band after band, row-major.
#[must_use]
pub fn matrices(rotation: &Rotation) -> Vec<f32> {
    rotation.matrices().iter().map(|element| *element as f32).collect()
}
