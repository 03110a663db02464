//! What the shared presets mean here.

use airglow_math::Preset;

use crate::settings::Settings;

/// Bands, and which spheres and nodes a cluster of receivers may do without.
impl From<Preset> for Settings {
    fn from(preset: Preset) -> Self {
        let medium = Self { order: preset.order(), ..Self::default() };
        match preset {
            Preset::Low => Self { reach: 1e-3, cut: 0.1, ..medium },
            Preset::Medium => medium,
            Preset::High => Self { cut: 0.01, ..medium },
            Preset::Reference => Self { reach: 0.0, cut: 0.0, ..medium },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn visibility_that_does_not_fit_becomes_that_of_the_preset_below() {
        for preset in Preset::ALL {
            let settings = Settings::from(preset);
            let next = settings.next_that_fits(10_000, settings.visibility_bytes(10_000) - 1);
            let below = preset.below().map(Preset::order);
            assert_eq!(next.map(|next| next.order), below, "{preset}");
        }
    }
}
