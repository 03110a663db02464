//! What the shared presets mean here.

use airglow_math::Preset;

use crate::chain::MOST_ITERATIONS;
use crate::fit::FitSettings;
use crate::settings::Settings;

/// Lobes of a texel, steps of their fit, and what the texture may take.
impl From<Preset> for Settings {
    fn from(preset: Preset) -> Self {
        let fitted = |lobes, iterations| FitSettings { lobes, iterations, ..FitSettings::default() };
        let with = |fit| Self { fit, ..Self::default() };
        match preset {
            Preset::Low => with(fitted(2, 8)),
            Preset::Medium => Self::default(),
            Preset::High => with(fitted(6, 20)),
            Preset::Reference => Self { budget: Some(u64::MAX), ..with(fitted(6, MOST_ITERATIONS)) },
        }
    }
}
