//! The modules of this room and their bindings, stated once.

use airglow_gpu::ash::vk::{Format, VertexInputRate};
pub(crate) use airglow_gpu::words;
use airglow_gpu::{BindingDesc, BindingKind, Kernel, Stages, VertexAttribute, VertexBufferLayout};
use bytemuck::{Pod, Zeroable};

use crate::FogError;
use crate::medium::PhaseKind;
use crate::settings::{Preset, Settings};
use crate::tiles::{Kind, TileConstants};

macro_rules! phases {
    ($before:literal) => {
        [
            include_bytes!(concat!("../../../shaders/spirv/fog/", $before, ".isotropic.spv")).as_slice(),
            include_bytes!(concat!("../../../shaders/spirv/fog/", $before, ".polynomial.spv")).as_slice(),
            include_bytes!(concat!("../../../shaders/spirv/fog/", $before, ".henyey_greenstein.spv"))
                .as_slice(),
            include_bytes!(concat!("../../../shaders/spirv/fog/", $before, ".draine.spv")).as_slice(),
        ]
    };
}

/// By height, whether all lights are points, preset, phase function.
static AIRLIGHT: [[[[&[u8]; 4]; 2]; 2]; 2] = [
    [
        [phases!("airlight.FOG_TAPS6"), phases!("airlight.FOG_TAPS16")],
        [phases!("airlight.FOG_POINTS.FOG_TAPS6"), phases!("airlight.FOG_POINTS.FOG_TAPS16")],
    ],
    [
        [phases!("airlight.FOG_HEIGHT.FOG_TAPS6"), phases!("airlight.FOG_HEIGHT.FOG_TAPS16")],
        [
            phases!("airlight.FOG_HEIGHT.FOG_POINTS.FOG_TAPS6"),
            phases!("airlight.FOG_HEIGHT.FOG_POINTS.FOG_TAPS16"),
        ],
    ],
];
/// By whether all lights are points, preset, phase function.
static AIRLIGHT_ENVIRONMENT: [[[&[u8]; 4]; 2]; 2] = [
    [phases!("airlight_environment.FOG_TAPS6"), phases!("airlight_environment.FOG_TAPS16")],
    [
        phases!("airlight_environment.FOG_POINTS.FOG_TAPS6"),
        phases!("airlight_environment.FOG_POINTS.FOG_TAPS16"),
    ],
];
/// By height.
static DARK: [&[u8]; 2] = [
    include_bytes!("../../../shaders/spirv/fog/airlight_dark.spv").as_slice(),
    include_bytes!("../../../shaders/spirv/fog/airlight_dark.FOG_HEIGHT.spv").as_slice(),
];
/// By preset.
static DARK_ENVIRONMENT: [&[u8]; 2] = [
    include_bytes!("../../../shaders/spirv/fog/airlight_dark_environment.FOG_TAPS6.spv").as_slice(),
    include_bytes!("../../../shaders/spirv/fog/airlight_dark_environment.FOG_TAPS16.spv").as_slice(),
];
/// By whether it has a light.
static TILE: [&[u8]; 2] = [
    include_bytes!("../../../shaders/spirv/fog/tile.FOG_DARK.spv").as_slice(),
    include_bytes!("../../../shaders/spirv/fog/tile.spv").as_slice(),
];
/// By preset, phase function.
static ROWS: [[&[u8]; 4]; 2] = [phases!("airlight_rows.FOG_TAPS6"), phases!("airlight_rows.FOG_TAPS16")];
/// By preset.
static ROWS_HEIGHT: [&[u8]; 2] = [
    include_bytes!("../../../shaders/spirv/fog/airlight_rows_height.FOG_TAPS6.isotropic.spv").as_slice(),
    include_bytes!("../../../shaders/spirv/fog/airlight_rows_height.FOG_TAPS16.isotropic.spv").as_slice(),
];
static ROWS_WALL: &[u8] =
    include_bytes!("../../../shaders/spirv/fog/airlight_rows_wall.isotropic.spv").as_slice();
static RECTANGLE: &[u8] = include_bytes!("../../../shaders/spirv/fog/rectangle.spv").as_slice();

/// By preset.
static LOBE_TABLE: [&[u8]; 2] = [
    include_bytes!("../../../shaders/spirv/fog/lobe_table.FOG_LOBE_SIZE64.spv").as_slice(),
    include_bytes!("../../../shaders/spirv/fog/lobe_table.FOG_LOBE_SIZE256.spv").as_slice(),
];
/// By preset.
static SURFACE_ROWS: [&[u8]; 2] = [
    include_bytes!("../../../shaders/spirv/fog/surface_rows.FOG_LOBE_SIZE64.spv").as_slice(),
    include_bytes!("../../../shaders/spirv/fog/surface_rows.FOG_LOBE_SIZE256.spv").as_slice(),
];
static BACKGROUND_PARTS: &[u8] = include_bytes!("../../../shaders/spirv/fog/background_parts.spv").as_slice();
static BACKGROUND: &[u8] = include_bytes!("../../../shaders/spirv/fog/background.spv").as_slice();
static HEALTH: &[u8] = include_bytes!("../../../shaders/spirv/fog/health.spv").as_slice();
static COMPLETE_ROWS: &[u8] = include_bytes!("../../../shaders/spirv/fog/complete_rows.spv").as_slice();
static SPREAD_ROWS: &[u8] = include_bytes!("../../../shaders/spirv/fog/spread_rows.spv").as_slice();

/// Bindings of the airlight pass: the frame, the surfaces' radiance, their depth.
pub const BINDINGS: [BindingDesc; 3] = [
    BindingDesc::new(0, BindingKind::UniformBuffer),
    BindingDesc::new(1, BindingKind::SampledImage),
    BindingDesc::new(2, BindingKind::SampledImage),
];

/// Bindings of the kernels of the background: the environment, the pyramid of its parts.
pub const BACKGROUND_BINDINGS: [BindingDesc; 2] =
    [BindingDesc::new(0, BindingKind::SampledImage), BindingDesc::new(1, BindingKind::StorageBuffer)];

/// Bindings of the kernel that fills tables: exponents, tables.
pub const LOBE_BINDINGS: [BindingDesc; 2] =
    [BindingDesc::new(0, BindingKind::StorageBuffer), BindingDesc::new(1, BindingKind::StorageBuffer)];

/// Bindings of `health.comp`: the surfaces' radiance, their depth, the counters.
pub const HEALTH_BINDINGS: [BindingDesc; 3] = [
    BindingDesc::new(0, BindingKind::SampledImage),
    BindingDesc::new(1, BindingKind::SampledImage),
    BindingDesc::new(2, BindingKind::StorageBuffer),
];

/// Push constants of `background_parts.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct LevelConstants {
    pub(crate) size: [u32; 2],
    pub(crate) level: u32,
    pub(crate) first: u32,
    pub(crate) below: u32,
}

/// Push constants of `background.frag`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct GatherConstants {
    pub(crate) optical: [f32; 4],
    pub(crate) albedo: [f32; 4],
    pub(crate) size: [u32; 2],
    pub(crate) target: [u32; 2],
    pub(crate) levels: u32,
    pub(crate) straight: f32,
    pub(crate) padding: [u32; 2],
}

/// Push constants of `health.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct SizeConstants {
    pub(crate) size: [u32; 2],
}

/// Tiles, an instance each.
static TILE_ROWS: [VertexBufferLayout<'static>; 1] = [VertexBufferLayout {
    stride: size_of::<TileConstants>() as u32,
    rate: VertexInputRate::INSTANCE,
    attributes: &[VertexAttribute { location: 0, format: Format::R32G32B32A32_UINT, offset: 0 }],
}];

/// The airlight pass over tiles of a kind.
pub(crate) fn airlight(settings: &Settings, kind: Kind) -> Kernel {
    let (height, preset) = (usize::from(settings.height), settings.preset as usize);
    let points = usize::from(kind == Kind::Points);
    let fragment = match (kind, settings.environment) {
        (Kind::Dark, false) => DARK[height],
        (Kind::Dark, true) => DARK_ENVIRONMENT[preset],
        (_, false) => AIRLIGHT[height][points][preset][settings.phase as usize],
        (_, true) => AIRLIGHT_ENVIRONMENT[points][preset][settings.phase as usize],
    };
    let name = match kind {
        Kind::Dark => "fog airlight, no light",
        Kind::Points => "fog airlight, points",
        Kind::All => "fog airlight, all lights",
    };
    let (vertex, format) = (TILE[usize::from(kind != Kind::Dark)], settings.format);
    let stages = Stages::Rectangles { vertex, fragment, vertex_buffers: &TILE_ROWS, format };
    Kernel { name, stages, bindings: BINDINGS.to_vec(), push_constant_size: 0 }
}

/// The kernel that counts a host's bad pixels.
pub(crate) fn health() -> Kernel {
    Kernel::compute("fog health", HEALTH, &HEALTH_BINDINGS, size_of::<SizeConstants>())
}

/// What `airlight.frag` takes for no surface, metres: above the 1e30 of the functions.
pub(crate) const FARTHEST: f32 = 1e32;

/// A kernel of the rows, by preset and phase function.
#[derive(Clone, Copy)]
pub(crate) enum Rows {
    Homogeneous(Preset, PhaseKind),
    Thinning(Preset),
    /// Isotropic at the reference preset, in a host that lets no light beyond [`WALL`].
    Wall,
}

/// Where `airlight_rows_wall` has its wall: the plane at this z relative to the eye, metres.
pub const WALL: f64 = -6.0;

impl Rows {
    /// That of the settings.
    pub(crate) fn of(settings: &Settings) -> Result<Self, FogError> {
        match (settings.height, settings.phase) {
            (false, phase) => Ok(Self::Homogeneous(settings.preset, phase)),
            (true, PhaseKind::Isotropic) => Ok(Self::Thinning(settings.preset)),
            (true, _) => Err(FogError::Kernel {
                what: "thins with height",
                mend: "rows of such a medium are isotropic",
            }),
        }
    }
}

/// The airlight of rows of parameters.
pub(crate) fn rows(rows: Rows) -> Vec<u32> {
    words(match rows {
        Rows::Homogeneous(preset, phase) => ROWS[preset as usize][phase as usize],
        Rows::Thinning(preset) => ROWS_HEIGHT[preset as usize],
        Rows::Wall => ROWS_WALL,
    })
}

/// Fills tables of lobes.
pub(crate) fn lobe_table(preset: Preset) -> Kernel {
    Kernel::compute("fog lobe tables", LOBE_TABLE[preset as usize], &LOBE_BINDINGS, 0)
}

/// The glow through lobes of rows of parameters.
pub(crate) fn surface_rows(preset: Preset) -> Vec<u32> {
    words(SURFACE_ROWS[preset as usize])
}

/// The complete model of rows of parameters.
pub(crate) fn complete_rows() -> Vec<u32> {
    words(COMPLETE_ROWS)
}

/// The point spread function of rows of parameters.
pub(crate) fn spread_rows() -> Vec<u32> {
    words(SPREAD_ROWS)
}

/// One level of the pyramid of an environment.
pub(crate) fn background_parts() -> Kernel {
    let constants = size_of::<LevelConstants>();
    Kernel::compute("fog background parts", BACKGROUND_PARTS, &BACKGROUND_BINDINGS, constants)
}

/// The environment through fog, over the whole of a map.
pub(crate) fn background(format: Format) -> Kernel {
    let (vertex, fragment) = (RECTANGLE, BACKGROUND);
    Kernel {
        name: "fog background",
        stages: Stages::Rectangles { vertex, fragment, vertex_buffers: &[], format },
        bindings: BACKGROUND_BINDINGS.to_vec(),
        push_constant_size: size_of::<GatherConstants>() as u32,
    }
}
