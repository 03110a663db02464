//! The modules of this room and their bindings, stated once.

use airglow_gpu::{BindingDesc, BindingKind};

use crate::medium::PhaseKind;
use crate::settings::{Preset, Settings};

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

/// By height, preset, phase function.
static AIRLIGHT: [[[&[u8]; 4]; 2]; 2] = [
    [phases!("airlight.FOG_TAPS6"), phases!("airlight.FOG_TAPS16")],
    [phases!("airlight.FOG_HEIGHT.FOG_TAPS6"), phases!("airlight.FOG_HEIGHT.FOG_TAPS16")],
];
static RECTANGLE: &[u8] = include_bytes!("../../../shaders/spirv/fog/rectangle.spv").as_slice();

/// Bindings of the airlight pass: the frame, the surfaces' radiance, their depth.
pub const BINDINGS: [BindingDesc; 3] = [
    BindingDesc::new(0, BindingKind::UniformBuffer),
    BindingDesc::new(1, BindingKind::SampledImage),
    BindingDesc::new(2, BindingKind::SampledImage),
];

/// The fragment stage of the airlight pass.
pub(crate) fn airlight(settings: &Settings) -> Vec<u32> {
    let phase = match settings.phase {
        PhaseKind::Isotropic => 0,
        PhaseKind::Polynomial => 1,
        PhaseKind::HenyeyGreenstein => 2,
        PhaseKind::Draine => 3,
    };
    words(AIRLIGHT[usize::from(settings.height)][usize::from(settings.preset == Preset::Reference)][phase])
}

/// One triangle over the viewport.
pub(crate) fn rectangle() -> Vec<u32> {
    words(RECTANGLE)
}

/// Little-endian words of a module's bytes.
pub(crate) fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
}
