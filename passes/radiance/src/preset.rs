//! What the shared presets mean here.

use airglow_math::Preset;

use crate::pass_settings::PassSettings;
use crate::refine::Settings;

/// Bands, rays of a sample, and how far the tree is refined.
impl From<Preset> for PassSettings {
    fn from(preset: Preset) -> Self {
        let medium = Self { order: preset.order(), ..Self::default() };
        let refined = |bound, limit| Settings { bound, limit, ..Settings::default() };
        match preset {
            Preset::Low => Self { rays: 2, refinement: refined(0.03, 1024), ..medium },
            Preset::Medium => medium,
            Preset::High => Self { face: 16, refinement: refined(0.003, 4096), ..medium },
            Preset::Reference => Self { face: 32, keep: 0.0, refinement: refined(0.001, 16_384), ..medium },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_that_do_not_fit_are_halved_until_they_do() {
        let nodes = 2 * 20_000 - 1;
        for preset in Preset::ALL {
            let settings = PassSettings::from(preset);
            let refused = settings.sample_bytes(nodes) - 1;
            let next = settings.next_that_fits(nodes, refused).unwrap();
            assert!(next.sample_bytes(nodes) <= refused, "{preset}: {next:?}");
            assert!(next.refinement.limit < settings.refinement.limit, "{preset}: {next:?}");
        }
    }
}
