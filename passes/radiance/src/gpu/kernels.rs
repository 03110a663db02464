//! The sampling kernels of this room and their bindings, stated once.

use airglow_gpu::{BindingDesc, BindingKind, Kernel};
use bytemuck::{Pod, Zeroable};

use super::LightShape;
use crate::RadianceError;

macro_rules! rays {
    ($before:literal) => {
        [
            include_bytes!(concat!("../../../../shaders/spirv/radiance/", $before, ".RAYS1.spv")).as_slice(),
            include_bytes!(concat!("../../../../shaders/spirv/radiance/", $before, ".RAYS2.spv")).as_slice(),
            include_bytes!(concat!("../../../../shaders/spirv/radiance/", $before, ".RAYS4.spv")).as_slice(),
        ]
    };
}

/// By gradients, order from 3 on, rays 1, 2 and 4.
static TEXELS: [[[&[u8]; 3]; 4]; 2] = [
    [rays!("texels.ORDER3"), rays!("texels.ORDER4"), rays!("texels.ORDER5"), rays!("texels.ORDER6")],
    [
        rays!("texels.GRADIENTS.ORDER3"),
        rays!("texels.GRADIENTS.ORDER4"),
        rays!("texels.GRADIENTS.ORDER5"),
        rays!("texels.GRADIENTS.ORDER6"),
    ],
];

/// By gradients, order from 3 on.
static ANALYTIC: [[&[u8]; 4]; 2] = [
    [
        include_bytes!("../../../../shaders/spirv/radiance/analytic.ORDER3.spv").as_slice(),
        include_bytes!("../../../../shaders/spirv/radiance/analytic.ORDER4.spv").as_slice(),
        include_bytes!("../../../../shaders/spirv/radiance/analytic.ORDER5.spv").as_slice(),
        include_bytes!("../../../../shaders/spirv/radiance/analytic.ORDER6.spv").as_slice(),
    ],
    [
        include_bytes!("../../../../shaders/spirv/radiance/analytic.GRADIENTS.ORDER3.spv").as_slice(),
        include_bytes!("../../../../shaders/spirv/radiance/analytic.GRADIENTS.ORDER4.spv").as_slice(),
        include_bytes!("../../../../shaders/spirv/radiance/analytic.GRADIENTS.ORDER5.spv").as_slice(),
        include_bytes!("../../../../shaders/spirv/radiance/analytic.GRADIENTS.ORDER6.spv").as_slice(),
    ],
];

const fn storage(binding: u32) -> BindingDesc {
    BindingDesc::new(binding, BindingKind::StorageBuffer)
}

/// Bindings of `texels.comp`: batch, points, triangles, solid angles, lights, surfaces, pictures, and gradients where there are
/// any.
pub const TEXEL_BINDINGS: [BindingDesc; 8] =
    [storage(0), storage(1), storage(2), storage(3), storage(4), storage(5), storage(6), storage(7)];

/// `Settings` of `texels.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct TexelConstants {
    /// Triangles in the buffer.
    pub triangle_count: u32,
    /// Texels along a side of a face.
    pub size: u32,
    /// 1: samples that are exact already, or kept, are left alone.
    pub keep_exact: u32,
    /// Triangles from it on show pictures.
    pub shown_first: u32,
    /// How many of them.
    pub shown_count: u32,
    /// Extinction of the medium between, 1/m.
    pub red: f32,
    /// The same.
    pub green: f32,
    /// The same.
    pub blue: f32,
    /// Faces in a row of the atlas, where there is one.
    pub columns: u32,
}

/// Bindings of `analytic.comp`: batch, points, triangles, lights, spheres, and gradients where there are any.
pub const ANALYTIC_BINDINGS: [BindingDesc; 6] =
    [storage(0), storage(1), storage(2), storage(3), storage(4), storage(5)];

/// The most triangles and spheres together that `analytic.comp` takes.
pub const MOST_ANALYTIC: u32 = 32;

/// `Settings` of `analytic.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct AnalyticConstants {
    /// Triangles that are no part of a sphere.
    pub triangle_count: u32,
    /// Spheres.
    pub sphere_count: u32,
    /// 1: samples of earlier frames are left alone.
    pub keep: u32,
}

/// The kernel of a shape and number of rays along a side of a texel.
pub(crate) fn texels(shape: LightShape, rays: u32) -> Result<Kernel, RadianceError> {
    let module = match (of_shape(&TEXELS, shape)?, rays) {
        (kernels, 1 | 2 | 4) => kernels[rays.ilog2() as usize],
        _ => return Err(RadianceError::setting("rays", rays, "1, 2 or 4 along a side of a texel")),
    };
    let bindings = &TEXEL_BINDINGS[..7 + usize::from(shape.gradients)];
    Ok(Kernel::compute("radiance texels", module, bindings, size_of::<TexelConstants>()))
}

/// The closed forms of a shape.
pub(crate) fn analytic(shape: LightShape) -> Result<Kernel, RadianceError> {
    let bindings = &ANALYTIC_BINDINGS[..5 + usize::from(shape.gradients)];
    let module = *of_shape(&ANALYTIC, shape)?;
    Ok(Kernel::compute("radiance closed forms", module, bindings, size_of::<AnalyticConstants>()))
}

fn of_shape<T>(kernels: &[[T; 4]; 2], shape: LightShape) -> Result<&T, RadianceError> {
    let orders = &kernels[usize::from(shape.gradients)];
    let found = shape.order.checked_sub(3).and_then(|place| orders.get(place));
    found.ok_or_else(|| RadianceError::setting("order", shape.order, "3 to 6 on a device"))
}
