//! The modules of this room, their bindings and constants, stated once.

use airglow_gpu::{BindingDesc, BindingKind, Kernel, words};
use bytemuck::{Pod, Zeroable};

use crate::exponential::Exponential;
use crate::order::MIN_ORDER;
use crate::polynomial;
use crate::table::{LINEAR_STEPS, Tables};

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
static PIXELS: Orders = orders!("pixels.EXPONENTIAL0.NORMALS");
static PRODUCTS: Orders = orders!("visibility.EXPONENTIAL7");
static ROWS: [Orders; 6] = [
    orders!("rows.EXPONENTIAL0"),
    orders!("rows.EXPONENTIAL1"),
    orders!("rows.EXPONENTIAL3"),
    orders!("rows.EXPONENTIAL4"),
    orders!("rows.EXPONENTIAL5"),
    orders!("rows.EXPONENTIAL6"),
];

const fn storage(binding: u32) -> BindingDesc {
    BindingDesc::new(binding, BindingKind::StorageBuffer)
}

const fn uniform(binding: u32) -> BindingDesc {
    BindingDesc::new(binding, BindingKind::UniformBuffer)
}

/// Bindings of `visibility.comp`: positions, slots, spheres, factors, visibility, records, normals, table of the exponential,
/// nodes. Normals and the table are there where the kernel reads them.
pub const VISIBILITY_BINDINGS: [BindingDesc; 9] = [
    storage(0),
    storage(1),
    uniform(2),
    uniform(3),
    storage(4),
    storage(5),
    storage(6),
    uniform(7),
    uniform(8),
];

/// Bindings of `pixels.comp`: positions, normals, spheres, factors, picture, table of the exponential, nodes, products.
pub const PIXEL_BINDINGS: [BindingDesc; 8] = [
    BindingDesc::new(0, BindingKind::SampledImage),
    BindingDesc::new(1, BindingKind::SampledImage),
    BindingDesc::new(2, BindingKind::UniformBuffer),
    BindingDesc::new(3, BindingKind::UniformBuffer),
    BindingDesc::new(4, BindingKind::StorageImage),
    BindingDesc::new(7, BindingKind::UniformBuffer),
    BindingDesc::new(8, BindingKind::UniformBuffer),
    BindingDesc::new(9, BindingKind::UniformBuffer),
];

/// Bindings of `rows.comp`: rows, results, and the table of the exponential where it is read.
pub const ROW_BINDINGS: [BindingDesc; 3] = [storage(0), storage(1), storage(2)];

/// Flag of [`VisibilityConstants`]: results are made ones that a visibility can have.
pub const CLAMPED: u32 = 1;
/// Flag: begins with the logarithm that the buffer holds.
pub const CONTINUED: u32 = 2;
/// Flag: ends without exponential.
pub const LOGARITHM: u32 = 4;

/// `Settings` of `pixels.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct PixelConstants {
    /// Pixels.
    pub size: [u32; 2],
    /// Nodes.
    pub count: u32,
    /// 1: clamped. 2: the share of the light.
    pub flags: u32,
    /// Least height of a cap.
    pub reach: f32,
    /// Height of a cap below which a node stands for what it holds.
    pub cut: f32,
    /// Strength of the window.
    pub window: f32,
    /// Angular radius of the disc; 0: none.
    pub disc_radius: f32,
    /// Its direction.
    pub disc: [f32; 4],
    /// Its irradiance.
    pub irradiance: [f32; 4],
}

/// `Settings` of `visibility.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct VisibilityConstants {
    /// Nodes of the range.
    pub count: u32,
    /// Degree of the series; 0: the polynomial of the vector's interval.
    pub degree: u32,
    /// Norm to scale to.
    pub norm: f32,
    /// Least height of a cap.
    pub reach: f32,
    /// Height of a cap below which a node stands for what it holds.
    pub cut: f32,
    /// Strength of the window.
    pub window: f32,
    /// [`CLAMPED`], [`CONTINUED`], [`LOGARITHM`].
    pub flags: u32,
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
    /// Degree of the series; 0: the polynomial of the vector's interval.
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

/// What a kernel makes of spheres or rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Series,
    Squares,
    Factored,
    Operator,
    Product,
    Square,
    /// The rival: products of visibilities.
    Products,
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
        let most = f64::from(f32::MAX);
        let (kind, degree, norm, whole) = match exponential {
            Exponential::Adaptive => (Kind::Series, 0, most, 0),
            Exponential::Series { degree } => (Kind::Series, degree, most, 1),
            Exponential::ScaledSeries { degree: 2 } => (Kind::Squares, 2, 0.125, 0),
            Exponential::ScaledSeries { degree } => (Kind::Factored, degree, 0.125, 0),
            Exponential::Horner { degree: 2, norm } => (Kind::Squares, 2, norm, 0),
            Exponential::Horner { degree, norm } => (Kind::Series, degree, norm, 0),
            Exponential::OptimalLinear => (Kind::Squares, 1, most, 0),
            Exponential::Hybrid { threshold } => (Kind::Squares, 1, threshold, 0),
            Exponential::Operator => (Kind::Operator, 0, most, 0),
        };
        Self { kind, degree: degree as u32, norm: norm as f32, whole }
    }

    /// A kernel without constants.
    pub(crate) fn without_constants(kind: Kind) -> Self {
        Self { kind, degree: 0, norm: f32::MAX, whole: 0 }
    }

    /// The table its exponential reads, and where that ends; `None` where it reads none.
    pub(crate) fn table(self, tables: &Tables) -> Option<(Vec<f32>, f32)> {
        match (self.kind, self.degree) {
            (Kind::Series, _) => Some((polynomial::table(), 1.0)),
            (Kind::Squares, 1) => Some((tables.linear.as_flattened().to_vec(), tables.linear_end)),
            // The series itself: both powers count as they are.
            (Kind::Squares, _) => Some((vec![1.0; 2 * (LINEAR_STEPS + 1)], 1.0)),
            _ => None,
        }
    }
}

/// The kernel over receivers; `None` where there is none.
pub(crate) fn visibility(kind: Kind, order: usize, normals: bool) -> Option<Kernel> {
    let modules = match (kind, normals) {
        (Kind::Series, false) => &SERIES,
        (Kind::Series, true) => &SERIES_NORMALS,
        (Kind::Squares, false) => &SQUARES,
        (Kind::Products, false) => &PRODUCTS,
        _ => return None,
    };
    let module = modules.get(order.checked_sub(MIN_ORDER)?)?;
    let (bindings, constants) = (visibility_bindings(kind, normals), size_of::<VisibilityConstants>());
    Some(Kernel::compute("shadow visibility", module, &bindings, constants))
}

/// The kernel over pixels.
pub(crate) fn pixels(order: usize) -> Option<Kernel> {
    let module = PIXELS.get(order.checked_sub(MIN_ORDER)?)?;
    Some(Kernel::compute("shadow pixels", module, &PIXEL_BINDINGS, size_of::<PixelConstants>()))
}

/// The kernel over rows; `None` where there is none.
pub(crate) fn rows(kind: Kind, order: usize) -> Option<Vec<u32>> {
    let place = match kind {
        Kind::Series => 0,
        Kind::Squares => 1,
        Kind::Factored => 2,
        Kind::Operator => 3,
        Kind::Product => 4,
        Kind::Square => 5,
        Kind::Products => return None,
    };
    ROWS.get(place)?.get(order.checked_sub(MIN_ORDER)?).map(|bytes| words(bytes))
}

/// Bindings of a kernel over receivers.
pub(crate) fn visibility_bindings(kind: Kind, normals: bool) -> Vec<BindingDesc> {
    let read = |desc: &BindingDesc| match desc.binding {
        6 => normals,
        3 | 7 => kind != Kind::Products,
        _ => true,
    };
    VISIBILITY_BINDINGS.into_iter().filter(read).collect()
}
