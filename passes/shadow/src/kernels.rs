//! The modules of this room, their bindings and constants, stated once.

use airglow_gpu::{BindingDesc, BindingKind};
use bytemuck::{Pod, Zeroable};

use crate::exponential::Exponential;
use crate::order::MIN_ORDER;

/// The modules of a kernel, by order.
type Orders = [&'static [u8]; 4];

macro_rules! orders {
    ($name:literal) => {
        [
            include_bytes!(concat!("../../../shaders/spirv/shadow/", $name, ".ORDER3.spv")).as_slice(),
            include_bytes!(concat!("../../../shaders/spirv/shadow/", $name, ".ORDER4.spv")).as_slice(),
            include_bytes!(concat!("../../../shaders/spirv/shadow/", $name, ".ORDER5.spv")).as_slice(),
            include_bytes!(concat!("../../../shaders/spirv/shadow/", $name, ".ORDER6.spv")).as_slice(),
        ]
    };
}

static SERIES: Orders = orders!("visibility.EXPONENTIAL0");
static SERIES_NORMALS: Orders = orders!("visibility.EXPONENTIAL0.NORMALS");
static SQUARES: Orders = orders!("visibility.EXPONENTIAL1");
static LINEAR: Orders = orders!("visibility.EXPONENTIAL2");
static PRODUCTS: Orders = orders!("visibility.EXPONENTIAL7");
static LOGARITHM: Orders = orders!("visibility.EXPONENTIAL8");
static ROWS: [Orders; 7] = [
    orders!("rows.EXPONENTIAL0"),
    orders!("rows.EXPONENTIAL1"),
    orders!("rows.EXPONENTIAL2"),
    orders!("rows.EXPONENTIAL3"),
    orders!("rows.EXPONENTIAL4"),
    orders!("rows.EXPONENTIAL5"),
    orders!("rows.EXPONENTIAL6"),
];

const fn storage(binding: u32) -> BindingDesc {
    BindingDesc::new(binding, BindingKind::StorageBuffer)
}

/// Bindings of `visibility.comp`: positions, slots, spheres, factors, visibility, records, normals, linear. Normals and the
/// last are there where the kernel reads them.
pub const VISIBILITY_BINDINGS: [BindingDesc; 8] = [
    storage(0),
    storage(1),
    BindingDesc::new(2, BindingKind::UniformBuffer),
    BindingDesc::new(3, BindingKind::UniformBuffer),
    storage(4),
    storage(5),
    storage(6),
    storage(7),
];

/// Bindings of `rows.comp`: rows, results, and the table of the optimal linear exponential where it is read.
pub const ROW_BINDINGS: [BindingDesc; 3] = [storage(0), storage(1), storage(2)];

/// `Settings` of `visibility.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct VisibilityConstants {
    /// Spheres of the frame.
    pub sphere_count: u32,
    /// Degree of the series; 0: by the norm.
    pub degree: u32,
    /// Norm to scale to.
    pub norm: f32,
    /// Least height of a cap.
    pub reach: f32,
    /// Strength of the window.
    pub window: f32,
    /// 1: clamped.
    pub clamped: u32,
    /// Largest norm of the table of the optimal linear exponential.
    pub end: f32,
    /// First cluster of the dispatch.
    pub first: u32,
}

/// `Settings` of `rows.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct RowConstants {
    /// Rows.
    pub count: u32,
    /// Degree of the series; 0: by the norm.
    pub degree: u32,
    /// Norm to scale to.
    pub norm: f32,
    /// 1: the mean is not set apart.
    pub whole: u32,
    /// Times a product or square is taken.
    pub repeat: u32,
    /// Largest norm of the table of the optimal linear exponential.
    pub end: f32,
}

/// What a kernel over receivers makes of the spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Series,
    Squares,
    Linear,
    Factored,
    Operator,
    Product,
    Square,
    /// The rival: products of visibilities.
    Products,
    /// The sum of logarithms.
    Logarithm,
}

/// A kernel and its constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Program {
    pub kind: Kind,
    pub degree: u32,
    pub norm: f32,
    pub whole: u32,
}

impl Program {
    /// The program of an exponential.
    pub(crate) fn of(exponential: Exponential) -> Self {
        let (kind, degree, norm, whole) = match exponential {
            Exponential::Adaptive => (Kind::Series, 0, crate::exponential::ADAPTIVE_NORM, 0),
            Exponential::Series { degree } => (Kind::Series, degree, f64::from(f32::MAX), 1),
            Exponential::ScaledSeries { degree: 2 } => (Kind::Squares, 2, 0.125, 0),
            Exponential::ScaledSeries { degree } => (Kind::Factored, degree, 0.125, 0),
            Exponential::Horner { degree: 2, norm } => (Kind::Squares, 2, norm, 0),
            Exponential::Horner { degree, norm } => (Kind::Series, degree, norm, 0),
            Exponential::OptimalLinear => (Kind::Linear, 0, f64::from(f32::MAX), 0),
            Exponential::Hybrid { threshold } => (Kind::Linear, 0, threshold, 0),
            Exponential::Operator => (Kind::Operator, 0, f64::from(f32::MAX), 0),
        };
        Self { kind, degree: degree as u32, norm: norm as f32, whole }
    }

    /// A kernel without constants.
    pub(crate) fn without_constants(kind: Kind) -> Self {
        Self { kind, degree: 0, norm: f32::MAX, whole: 0 }
    }

    /// Whether it reads the table of the optimal linear exponential.
    pub(crate) fn reads_linear(self) -> bool {
        self.kind == Kind::Linear
    }
}

/// The kernel over receivers; `None` where there is none.
pub(crate) fn visibility(kind: Kind, order: usize, normals: bool) -> Option<Vec<u32>> {
    let modules = match (kind, normals) {
        (Kind::Series, false) => &SERIES,
        (Kind::Series, true) => &SERIES_NORMALS,
        (Kind::Squares, false) => &SQUARES,
        (Kind::Linear, false) => &LINEAR,
        (Kind::Products, false) => &PRODUCTS,
        (Kind::Logarithm, false) => &LOGARITHM,
        _ => return None,
    };
    modules.get(order.checked_sub(MIN_ORDER)?).map(|bytes| words(bytes))
}

/// The kernel over rows; `None` where there is none.
pub(crate) fn rows(kind: Kind, order: usize) -> Option<Vec<u32>> {
    let place = match kind {
        Kind::Series => 0,
        Kind::Squares => 1,
        Kind::Linear => 2,
        Kind::Factored => 3,
        Kind::Operator => 4,
        Kind::Product => 5,
        Kind::Square => 6,
        Kind::Products | Kind::Logarithm => return None,
    };
    ROWS.get(place)?.get(order.checked_sub(MIN_ORDER)?).map(|bytes| words(bytes))
}

/// Bindings of a kernel over receivers.
pub(crate) fn visibility_bindings(program: Program, normals: bool) -> Vec<BindingDesc> {
    let read = |desc: &BindingDesc| match desc.binding {
        6 => normals,
        7 => program.reads_linear(),
        _ => true,
    };
    VISIBILITY_BINDINGS.into_iter().filter(read).collect()
}

/// Little-endian words of a module's bytes.
fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
}
