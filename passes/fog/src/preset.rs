//! What the shared presets mean here.

use airglow_gpu::ash::vk::Format;
use airglow_math::Preset as Quality;

use crate::settings::{Preset, Settings};

/// Taps, the radiance below which a light is left out of a pixel, and the format of a picture that the pass makes.
impl From<Quality> for Settings {
    fn from(preset: Quality) -> Self {
        let medium = Self::default();
        match preset {
            Quality::Low => Self { bound: 1e-2, format: Format::R16G16B16A16_SFLOAT, ..medium },
            Quality::Medium => medium,
            Quality::High => Self { preset: Preset::Reference, ..medium },
            Quality::Reference => Self { preset: Preset::Reference, bound: 0.0, ..medium },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_that_does_not_fit_becomes_that_of_low() {
        let [low, medium] = [Quality::Low, Quality::Medium].map(Settings::from);
        let bytes = |settings: &Settings| settings.picture_bytes([640, 480]).unwrap();
        let next = medium.next_that_fits([640, 480], bytes(&medium) - 1).unwrap();
        assert_eq!((next.format, bytes(&next)), (low.format, bytes(&low)));
        assert!(low.next_that_fits([640, 480], bytes(&low) - 1).is_none());
    }
}
