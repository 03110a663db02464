//! The pass: its pipelines, kept for all maps of a host.

use airglow_gpu::ash::vk::FormatFeatureFlags;
use airglow_gpu::requirements::FormatNeed;
use airglow_gpu::{ComputePipeline, ComputePipelineDesc, Context, Requirements};

use crate::NormalsError;
use crate::chain::MOST_ITERATIONS;
use crate::fit::FitSettings;
use crate::kernels::{self, AlignConstants, BINDINGS, FitConstants, PackConstants};
use crate::settings::Settings;

/// Builds textures of lobes from normal maps. Made once for a device and [`Settings`]; holds no map.
#[derive(Clone)]
pub struct Normals {
    pub(crate) settings: Settings,
    pub(crate) fit: ComputePipeline,
    /// None for one lobe, which has but one order.
    pub(crate) align: Option<ComputePipeline>,
    pub(crate) pack: ComputePipeline,
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
        let FitSettings { lobes, iterations, .. } = settings.fit;
        if iterations > MOST_ITERATIONS {
            let (what, value) = ("the number of iterations", iterations as f64);
            return Err(NormalsError::Range { what, value, range: "0 to 32 on a device" });
        }
        let pipeline = |name, spirv: &[u32], constants: usize| {
            let push_constant_size = constants as u32;
            context.create_compute_pipeline(&ComputePipelineDesc {
                name,
                spirv,
                bindings: &BINDINGS,
                push_constant_size,
            })
        };
        let align = kernels::align(lobes);
        let align =
            align.map(|spirv| pipeline("normals align", &spirv, size_of::<AlignConstants>())).transpose()?;
        Ok(Self {
            settings,
            fit: pipeline("normals fit", &kernels::fit(lobes)?, size_of::<FitConstants>())?,
            align,
            pack: pipeline("normals pack", &kernels::pack(settings.storage), size_of::<PackConstants>())?,
        })
    }

    /// The settings it was made for.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }
}
