//! What a host may come to need, whose pipelines are all made ahead.

use airglow_gpu::ash::vk;
use airglow_gpu::{Kernel, Outside, Permutations};

use crate::medium::PhaseKind;
use crate::settings::{Preset, Settings};
use crate::tiles::KINDS;
use crate::{FogError, kernels};

/// Every [`Settings`] that can be made of these, and what stands beside the pass; bounds may be any. What does not go
/// together, height and an environment, is no part of it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Envelope {
    /// Formats of pictures, and of maps where there are backgrounds.
    pub formats: Vec<vk::Format>,
    /// How exactly.
    pub presets: Vec<Preset>,
    /// Kinds of phase functions.
    pub phases: Vec<PhaseKind>,
    /// Media that thin with height, that do not, or both.
    pub height: Vec<bool>,
    /// An environment behind the medium, none, or both.
    pub environment: Vec<bool>,
    /// Whether [`Background`](crate::Background) may be needed.
    pub backgrounds: bool,
    /// Whether [`LobeTables`](crate::LobeTables) may be needed.
    pub lobes: bool,
    /// Whether [`InputHealth`](crate::InputHealth) may be needed.
    pub health: bool,
}

/// Every pipeline of an [`Envelope`], for the `with_pipelines` of [`Fog`](crate::Fog) and of what stands beside it.
pub type Pipelines = airglow_gpu::Pipelines<Envelope>;

impl From<&Settings> for Envelope {
    /// The envelope of these settings alone.
    fn from(settings: &Settings) -> Self {
        Self {
            formats: vec![settings.format],
            presets: vec![settings.preset],
            phases: vec![settings.phase],
            height: vec![settings.height],
            environment: vec![settings.environment],
            backgrounds: false,
            lobes: false,
            health: false,
        }
    }
}

/// What stands beside the pass.
#[derive(Clone, Copy)]
pub(crate) enum Part {
    Background(vk::Format),
    Lobes(Preset),
    Health,
}

impl Envelope {
    /// Backgrounds of a format, and nothing else.
    pub(crate) fn of_backgrounds(format: vk::Format) -> Self {
        Self { height: Vec::new(), backgrounds: true, ..(&Settings { format, ..Settings::default() }).into() }
    }

    /// Every settings of the envelope that has kernels.
    #[must_use]
    pub fn settings(&self) -> Vec<Settings> {
        let mut all = vec![Settings::default()];
        all = each(&all, &self.formats, |settings, format| Settings { format, ..settings });
        all = each(&all, &self.presets, |settings, preset| Settings { preset, ..settings });
        all = each(&all, &self.phases, |settings, phase| Settings { phase, ..settings });
        all = each(&all, &self.height, |settings, height| Settings { height, ..settings });
        all = each(&all, &self.environment, |settings, environment| Settings { environment, ..settings });
        all.retain(|settings| settings.check().is_ok());
        all
    }

    /// Refuses settings outside, naming the first that is.
    ///
    /// # Errors
    /// [`FogError::Envelope`].
    pub fn check(&self, settings: &Settings) -> Result<(), FogError> {
        let Settings { format, preset, phase, height, environment, .. } = *settings;
        Ok(Outside::check([
            (self.formats.contains(&format), "formats", format!("format {format:?}")),
            (self.presets.contains(&preset), "presets", format!("preset {preset:?}")),
            (self.phases.contains(&phase), "phases", format!("phase {phase:?}")),
            (self.height.contains(&height), "height", format!("height: {height}")),
            (self.environment.contains(&environment), "environment", format!("environment: {environment}")),
        ])?)
    }

    /// Refuses what stands beside the pass, where the envelope has it not.
    pub(crate) fn check_part(&self, part: Part) -> Result<(), Outside> {
        match part {
            Part::Health => Outside::check([(self.health, "health", "counting of bad pixels".to_owned())]),
            Part::Lobes(preset) => Outside::check([
                (self.lobes, "lobes", "tables of lobes".to_owned()),
                (self.presets.contains(&preset), "presets", format!("preset {preset:?}")),
            ]),
            Part::Background(format) => Outside::check([
                (
                    self.backgrounds,
                    "backgrounds",
                    "an environment as it is seen through the medium".to_owned(),
                ),
                (self.formats.contains(&format), "formats", format!("format {format:?}")),
            ]),
        }
    }
}

/// Each of `all` with each of `values`.
fn each<T: Copy>(all: &[Settings], values: &[T], with: impl Fn(Settings, T) -> Settings) -> Vec<Settings> {
    all.iter()
        .flat_map(|&settings| values.iter().map(move |&value| (settings, value)))
        .map(|(s, v)| with(s, v))
        .collect()
}

impl Permutations for Envelope {
    type Error = FogError;

    fn kernels(&self) -> Result<Vec<Kernel>, FogError> {
        let of = |settings: &Settings| KINDS.map(|kind| kernels::airlight(settings, kind));
        let mut all: Vec<_> = self.settings().iter().flat_map(of).collect();
        if self.backgrounds {
            all.push(kernels::background_parts());
            all.extend(self.formats.iter().map(|&format| kernels::background(format)));
        }
        if self.lobes {
            all.extend(self.presets.iter().map(|&preset| kernels::lobe_table(preset)));
        }
        all.extend(self.health.then(kernels::health));
        match all.is_empty() {
            true => Err(FogError::Kernel { what: "has an empty envelope", mend: "give every list an entry" }),
            false => Ok(all),
        }
    }
}
