//! The modules of this room and their bindings, stated once.

pub(crate) use airglow_gpu::words;
use airglow_gpu::{BindingDesc, BindingKind, Kernel};
use bytemuck::{Pod, Zeroable};

use crate::NormalsError;
use crate::brdf::{Brdf, Directions};
use crate::method::Method;
use crate::mixture::MAX_LOBES;
use crate::storage::Storage;

static FIT: [(usize, &[u8]); 4] = [
    (1, include_bytes!("../../../shaders/spirv/normals/fit.LOBES1.spv").as_slice()),
    (2, include_bytes!("../../../shaders/spirv/normals/fit.LOBES2.spv").as_slice()),
    (4, include_bytes!("../../../shaders/spirv/normals/fit.LOBES4.spv").as_slice()),
    (6, include_bytes!("../../../shaders/spirv/normals/fit.LOBES6.spv").as_slice()),
];
static ALIGN: [(usize, &[u8]); 3] = [
    (2, include_bytes!("../../../shaders/spirv/normals/align.LOBES2.spv").as_slice()),
    (4, include_bytes!("../../../shaders/spirv/normals/align.LOBES4.spv").as_slice()),
    (6, include_bytes!("../../../shaders/spirv/normals/align.LOBES6.spv").as_slice()),
];
static PACK_F16: &[u8] = include_bytes!("../../../shaders/spirv/normals/pack.f16.spv").as_slice();
static PACK_OCTAHEDRAL8: &[u8] =
    include_bytes!("../../../shaders/spirv/normals/pack.octahedral8.spv").as_slice();
static PACK_SNORM8: &[u8] = include_bytes!("../../../shaders/spirv/normals/pack.snorm8.spv").as_slice();
static AVERAGE: [(Kept, &[u8], usize); 5] = [
    (Kept::Mean, include_bytes!("../../../shaders/spirv/normals/average.mean.spv").as_slice(), 1),
    (Kept::Lean, include_bytes!("../../../shaders/spirv/normals/average.lean.spv").as_slice(), 2),
    (
        Kept::Harmonics(3),
        include_bytes!("../../../shaders/spirv/normals/average.sh.ORDER3.spv").as_slice(),
        3,
    ),
    (
        Kept::Harmonics(4),
        include_bytes!("../../../shaders/spirv/normals/average.sh.ORDER4.spv").as_slice(),
        4,
    ),
    (
        Kept::Harmonics(5),
        include_bytes!("../../../shaders/spirv/normals/average.sh.ORDER5.spv").as_slice(),
        7,
    ),
];
static RIVALS: [(Method, &[u8]); 9] = [
    (Method::Mip, include_bytes!("../../../shaders/spirv/normals/rivals.mip.spv").as_slice()),
    (Method::Length, include_bytes!("../../../shaders/spirv/normals/rivals.length.spv").as_slice()),
    (Method::Toksvig, include_bytes!("../../../shaders/spirv/normals/rivals.toksvig.spv").as_slice()),
    (Method::Roughness, include_bytes!("../../../shaders/spirv/normals/rivals.roughness.spv").as_slice()),
    (Method::Geometric, include_bytes!("../../../shaders/spirv/normals/rivals.geometric.spv").as_slice()),
    (Method::Lean, include_bytes!("../../../shaders/spirv/normals/rivals.lean.spv").as_slice()),
    (Method::Harmonics(3), include_bytes!("../../../shaders/spirv/normals/rivals.ORDER3.sh.spv").as_slice()),
    (Method::Harmonics(4), include_bytes!("../../../shaders/spirv/normals/rivals.ORDER4.sh.spv").as_slice()),
    (Method::Harmonics(5), include_bytes!("../../../shaders/spirv/normals/rivals.ORDER5.sh.spv").as_slice()),
];
static ROWS: &[u8] = include_bytes!("../../../shaders/spirv/normals/rows.spv").as_slice();

/// Bindings of every kernel of this room: what it reads and what it writes. `fit.comp`: samples, lobes. `align.comp`:
/// coarser lobes, lobes. `pack.comp`: lobes, packed lobes. `average.comp`: what the level below keeps, what this one does.
/// `rows.comp` and `rivals.comp`: rows, radiance.
pub const BINDINGS: [BindingDesc; 2] =
    [BindingDesc::new(0, BindingKind::StorageBuffer), BindingDesc::new(1, BindingKind::StorageBuffer)];

/// `Settings` of `fit.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct FitConstants {
    /// Columns and rows of the level of the samples.
    pub fine: [u32; 2],
    /// Columns and rows of the level that is fitted.
    pub size: [u32; 2],
    /// Samples of a texel.
    pub per_texel: u32,
    /// Steps of expectation and maximisation.
    pub iterations: u32,
    /// The sharpest lobe while fitting.
    pub sharpest: f32,
    /// The texel of the first invocation.
    pub first: u32,
}

/// `Settings` of `align.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct AlignConstants {
    /// Columns and rows of the coarser level.
    pub coarse_size: [u32; 2],
    /// Columns and rows of the level that is put in order.
    pub size: [u32; 2],
}

/// `Settings` of `pack.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct PackConstants {
    /// Texels of the level.
    pub texels: u32,
    /// Lobes of a texel.
    pub lobes: u32,
}

/// `Settings` of `average.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct AverageConstants {
    /// Columns and rows of the level below.
    pub fine_size: [u32; 2],
    /// Columns and rows of this level.
    pub size: [u32; 2],
    /// The texel of the first invocation.
    pub first: u32,
    /// 1 where the level below is the map of normals.
    pub single: u32,
}

/// Vectors of the largest row that a rival keeps: 25 coefficients.
pub(crate) const MOST_VECTORS: usize = 7;

/// `Row` of `rivals.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct RivalConstants {
    /// Towards the light; w: 0 Lambert, 1 Blinn-Phong, 2 GGX.
    pub light: [f32; 4],
    /// Between light and view, or zero; w: exponent or alpha.
    pub half_vector: [f32; 4],
    /// Bands of the cosine in the first two, of the BRDF in the others.
    pub factors: [[f32; 4]; 4],
    /// What is kept of the texel.
    pub kept: [[f32; 4]; MOST_VECTORS],
}

/// `Row` of `rows.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct RowConstants {
    /// Towards the light; w: 0 Lambert, 1 Blinn-Phong, 2 GGX.
    pub light: [f32; 4],
    /// Between light and view, or zero; w: exponent or alpha.
    pub half_vector: [f32; 4],
    /// Moment and weight of each lobe.
    pub lobes: [[f32; 4]; MAX_LOBES],
}

/// The kernel that fits so many lobes.
///
/// # Errors
/// [`NormalsError::Range`] for a number without kernel.
pub(crate) fn fit(lobes: usize) -> Result<Kernel, NormalsError> {
    let Some((_, module)) = FIT.iter().find(|(count, _)| *count == lobes) else {
        let (what, range) = ("the number of lobes", "1, 2, 4 or 6");
        return Err(NormalsError::Range { what, value: lobes as f64, range });
    };
    Ok(Kernel::compute("normals fit", module, &BINDINGS, size_of::<FitConstants>()))
}

/// What a rival averages.
#[derive(Clone, Copy, PartialEq)]
enum Kept {
    Mean,
    Lean,
    Harmonics(usize),
}

/// The kernel that averages what a rival keeps, and its vectors of a texel.
///
/// # Errors
/// [`NormalsError::Method`] for lobes, which are no average, and for orders without kernel.
pub(crate) fn average(method: Method) -> Result<(Vec<u32>, usize), NormalsError> {
    let kept = match method {
        Method::Lobes(_) | Method::Taps => None,
        Method::Harmonics(order) => Some(Kept::Harmonics(order)),
        Method::Lean => Some(Kept::Lean),
        _ => Some(Kept::Mean),
    };
    let found = AVERAGE.iter().find(|(of, ..)| Some(*of) == kept);
    let found = found.map(|&(_, bytes, vectors)| (words(bytes), vectors));
    found.ok_or_else(|| NormalsError::Method { method: method.to_string() })
}

/// The kernel of a rival's radiance.
///
/// # Errors
/// As [`average`].
pub(crate) fn rival(method: Method) -> Result<Vec<u32>, NormalsError> {
    let found = RIVALS.iter().find(|(of, _)| *of == method).map(|(_, bytes)| words(bytes));
    found.ok_or_else(|| NormalsError::Method { method: method.to_string() })
}

/// Light with the kind of the material, half vector with its parameter, as rows of both kernels begin.
pub(crate) fn material(brdf: Brdf, directions: Directions) -> [[f32; 4]; 2] {
    let (kind, parameter) = match brdf {
        Brdf::Lambert => (0.0, 0.0),
        Brdf::BlinnPhong { exponent } => (1.0, exponent),
        Brdf::Ggx { alpha } => (2.0, alpha),
    };
    [directions.light.extend(kind), directions.half.extend(parameter)].map(|v| v.as_vec4().to_array())
}

/// The kernel that puts so many lobes in order; there is none for one.
pub(crate) fn align(lobes: usize) -> Option<Kernel> {
    let (_, module) = ALIGN.iter().find(|(count, _)| *count == lobes)?;
    Some(Kernel::compute("normals align", module, &BINDINGS, size_of::<AlignConstants>()))
}

/// The kernel that writes lobes as a texture holds them.
pub(crate) fn pack(storage: Storage) -> Kernel {
    let module = match storage {
        Storage::F16 => PACK_F16,
        Storage::Snorm8 => PACK_SNORM8,
        Storage::Octahedral8 => PACK_OCTAHEDRAL8,
    };
    Kernel::compute("normals pack", module, &BINDINGS, size_of::<PackConstants>())
}

pub(crate) fn rows() -> Vec<u32> {
    words(ROWS)
}
