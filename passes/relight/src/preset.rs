//! What the shared presets mean here.

use airglow_math::Preset;

use crate::settings::{Settings, Storage};

/// Bands and storage: half floats in [`Preset::Low`], whose bands lose far more than half floats do.
impl From<Preset> for Settings {
    fn from(preset: Preset) -> Self {
        let storage = if preset == Preset::Low { Storage::F16 } else { Storage::F32 };
        Self { order: preset.order(), storage, ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_known_before_anything_is_made_and_what_does_not_fit_names_what_does() {
        let bytes = Preset::ALL.map(|preset| Settings::from(preset).mesh_bytes(10_000));
        assert!(bytes.is_sorted_by(|a, b| a < b), "{bytes:?}");
        for preset in Preset::ALL {
            let settings = Settings::from(preset);
            let refused = settings.mesh_bytes(10_000) - 1;
            let next = settings.next_that_fits(10_000, refused).unwrap();
            assert!(next.mesh_bytes(10_000) <= refused && next.order <= settings.order, "{preset}: {next:?}");
        }
    }
}
