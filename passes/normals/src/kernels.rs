//! The modules of this room and their bindings, stated once.

use airglow_gpu::{BindingDesc, BindingKind};
use bytemuck::{Pod, Zeroable};

use crate::NormalsError;
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
static PACK_SNORM8: &[u8] = include_bytes!("../../../shaders/spirv/normals/pack.snorm8.spv").as_slice();
static ROWS: &[u8] = include_bytes!("../../../shaders/spirv/normals/rows.spv").as_slice();

/// Bindings of every kernel of this room: what it reads and what it writes. `fit.comp`: samples, lobes. `align.comp`:
/// coarser lobes, lobes. `pack.comp`: lobes, packed lobes. `rows.comp`: rows, radiance.
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
pub(crate) fn fit(lobes: usize) -> Result<Vec<u32>, NormalsError> {
    let found = FIT.iter().find(|(count, _)| *count == lobes).map(|(_, bytes)| words(bytes));
    let (what, range) = ("the number of lobes", "1, 2, 4 or 6");
    found.ok_or(NormalsError::Range { what, value: lobes as f64, range })
}

/// The kernel that puts so many lobes in order; there is none for one.
pub(crate) fn align(lobes: usize) -> Option<Vec<u32>> {
    ALIGN.iter().find(|(count, _)| *count == lobes).map(|(_, bytes)| words(bytes))
}

pub(crate) fn pack(storage: Storage) -> Vec<u32> {
    match storage {
        Storage::F16 => words(PACK_F16),
        Storage::Snorm8 => words(PACK_SNORM8),
    }
}

pub(crate) fn rows() -> Vec<u32> {
    words(ROWS)
}

/// Little-endian words of a module's bytes.
fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
}
