//! The pass: its pipelines, kept for all maps of a host.

use airglow_gpu::ash::vk::FormatFeatureFlags;
use airglow_gpu::requirements::FormatNeed;
use airglow_gpu::{ComputePipeline, Context, Requirements};

use crate::NormalsError;
use crate::chain::MOST_ITERATIONS;
use crate::envelope::Pipelines;
use crate::fit::FitSettings;
use crate::kernels::{self, BINDINGS};
use crate::settings::Settings;

/// Builds textures of lobes from normal maps. Made once for a device and [`Settings`]; holds no map.
#[derive(Clone)]
pub struct Normals {
    pub(crate) settings: Settings,
    pub(crate) fit: ComputePipeline,
    /// None for one lobe, which has but one order.
    pub(crate) align: Option<ComputePipeline>,
    pub(crate) pack: ComputePipeline,
    /// Pipelines that it and its like hold ready.
    pub(crate) pipeline_count: usize,
}

impl Normals {
    /// What a device must offer for these settings, to be joined to those of other passes before it is made.
    #[must_use]
    pub fn requirements(settings: &Settings) -> Requirements {
        let mut requirements = Requirements::engine().with_descriptors(&BINDINGS);
        requirements.formats.push(FormatNeed {
            format: settings.storage.format(),
            usage: FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR | FormatFeatureFlags::TRANSFER_DST,
            why: "lobes of normals",
        });
        requirements
    }

    /// Makes the kernels that `settings` need on a device.
    ///
    /// # Errors
    /// [`NormalsError::Range`] for settings out of range or without kernel, [`NormalsError::Gpu`].
    pub fn new(context: &Context, settings: Settings) -> Result<Self, NormalsError> {
        settings.check()?;
        Self::with_pipelines(settings, &Pipelines::prepare(context, (&settings).into())?)
    }

    /// The same with pipelines that were made before, on whatever thread: none is made here or while recording.
    ///
    /// # Errors
    /// [`NormalsError::Envelope`] for settings outside the envelope they were prepared for; else as [`Normals::new`].
    pub fn with_pipelines(settings: Settings, pipelines: &Pipelines) -> Result<Self, NormalsError> {
        settings.check()?;
        let FitSettings { lobes, iterations, .. } = settings.fit;
        if iterations > MOST_ITERATIONS {
            let (what, value) = ("the number of iterations", iterations as f64);
            return Err(NormalsError::Range { what, value, range: "0 to 32 on a device" });
        }
        pipelines.envelope().check(&settings)?;
        let align = kernels::align(lobes);
        Ok(Self {
            settings,
            fit: pipelines.compute(&kernels::fit(lobes)?)?,
            align: align.map(|kernel| pipelines.compute(&kernel)).transpose()?,
            pack: pipelines.compute(&kernels::pack(settings.storage))?,
            pipeline_count: pipelines.count(),
        })
    }

    /// The settings it was made for.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }
}
