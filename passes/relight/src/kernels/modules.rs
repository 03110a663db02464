//! The committed modules, by what they were compiled for.

macro_rules! module {
    ($($part:expr),*) => {
        include_bytes!(concat!("../../../../shaders/spirv/relight/", $($part,)* ".spv")).as_slice()
    };
}
macro_rules! by_order {
    ($before:literal, $after:literal) => {
        [
            module!($before, ".ORDER1", $after),
            module!($before, ".ORDER2", $after),
            module!($before, ".ORDER3", $after),
            module!($before, ".ORDER4", $after),
            module!($before, ".ORDER5", $after),
            module!($before, ".ORDER6", $after),
        ]
    };
}
/// Modules by order - 1.
pub(super) type ByOrder = [&'static [u8]; 6];

pub(super) static ENVIRONMENT_ROWS: ByOrder = by_order!("environment_rows", "");
pub(super) static ENVIRONMENT_ROWS_HEALTH: ByOrder = by_order!("environment_rows.HEALTH", "");
pub(super) static ENVIRONMENT_BANDS: ByOrder = by_order!("environment_bands", "");
pub(super) static ROTATE: ByOrder = by_order!("rotate", "");
pub(super) static PRODUCT: ByOrder = by_order!("product", "");
pub(super) static PRODUCT_MATRIX: ByOrder = by_order!("product_matrix", "");
/// By visibility, light, then f32, f16 or normals.
pub(super) static COLOUR: [[[ByOrder; 3]; 2]; 2] = [
    [
        [
            by_order!("colour.uniform", ".f32"),
            by_order!("colour.uniform", ".f16"),
            by_order!("colour.uniform", ".normals"),
        ],
        [
            by_order!("colour.vertex", ".f32"),
            by_order!("colour.vertex", ".f16"),
            by_order!("colour.vertex", ".normals"),
        ],
    ],
    [
        [
            by_order!("colour.uniform", ".f32.VISIBILITY"),
            by_order!("colour.uniform", ".f16.VISIBILITY"),
            by_order!("colour.uniform", ".normals.VISIBILITY"),
        ],
        [
            by_order!("colour.vertex", ".f32.VISIBILITY"),
            by_order!("colour.vertex", ".f16.VISIBILITY"),
            by_order!("colour.vertex", ".normals.VISIBILITY"),
        ],
    ],
];
/// By visibility, light, then f32, f16 or normals.
pub(super) static RECTANGLE: [[[ByOrder; 3]; 2]; 2] = [
    [
        [
            by_order!("colour_rectangle.uniform", ".f32"),
            by_order!("colour_rectangle.uniform", ".f16"),
            by_order!("colour_rectangle.uniform", ".normals"),
        ],
        [
            by_order!("colour_rectangle.vertex", ".f32"),
            by_order!("colour_rectangle.vertex", ".f16"),
            by_order!("colour_rectangle.vertex", ".normals"),
        ],
    ],
    [
        [
            by_order!("colour_rectangle.uniform", ".f32.VISIBILITY"),
            by_order!("colour_rectangle.uniform", ".f16.VISIBILITY"),
            by_order!("colour_rectangle.uniform", ".normals.VISIBILITY"),
        ],
        [
            by_order!("colour_rectangle.vertex", ".f32.VISIBILITY"),
            by_order!("colour_rectangle.vertex", ".f16.VISIBILITY"),
            by_order!("colour_rectangle.vertex", ".normals.VISIBILITY"),
        ],
    ],
];
/// By light, storage.
pub(super) static INCIDENT_BAKED: [[ByOrder; 2]; 2] = [
    [by_order!("incident.uniform", ".static.f32"), by_order!("incident.uniform", ".static.f16")],
    [by_order!("incident.vertex", ".static.f32"), by_order!("incident.vertex", ".static.f16")],
];
/// By light, storage.
pub(super) static INCIDENT_BOTH: [[ByOrder; 2]; 2] = [
    [by_order!("incident.uniform", ".both.f32"), by_order!("incident.uniform", ".both.f16")],
    [by_order!("incident.vertex", ".both.f32"), by_order!("incident.vertex", ".both.f16")],
];
/// By light.
pub(super) static INCIDENT_DYNAMIC: [ByOrder; 2] =
    [by_order!("incident.uniform", ".dynamic"), by_order!("incident.vertex", ".dynamic")];
/// By light.
pub(super) static INCIDENT_OPEN: [ByOrder; 2] =
    [by_order!("incident_open.uniform", ""), by_order!("incident_open.vertex", "")];
pub(crate) static RECTANGLE_VERTEX: &[u8] = module!("rectangle");
