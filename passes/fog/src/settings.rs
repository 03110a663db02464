//! The knobs of the pass: range, default and its reason.

use airglow_gpu::ash::vk;
use airglow_graph::ImageDesc;

use crate::FogError;
use crate::error::check;
use crate::medium::PhaseKind;

/// How exactly the airlight is computed: relative error against quadrature in f64 over random inputs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Preset {
    /// 6 taps a light and pixel.
    #[default]
    Default,
    /// 16 taps a light and pixel.
    Reference,
}

/// What a [`Fog`](crate::Fog) is prepared for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Format of the picture that the pass writes. Default RGBA32F; RGBA16F ends at 65504 and has steps of 1/1024.
    pub format: vk::Format,
    /// How exactly. Default [`Preset::Default`]: its error is below half an 8-bit step.
    pub preset: Preset,
    /// The kind of phase function; its numbers come with the medium. Default Henyey-Greenstein, which scene files and
    /// most hosts know, and which is isotropic at g = 0.
    pub phase: PhaseKind,
    /// Whether a medium may thin with height. Default no: then its arithmetic does not exist.
    pub height: bool,
    /// Whether there is an environment behind the medium. Default no: then its arithmetic does not exist. Not with
    /// [`height`](Self::height).
    pub environment: bool,
    /// Radiance, W/sr/m2, below which the airlight of one light is left out of a pixel. 0 leaves nothing out. Default
    /// 1e-4: half an 8-bit step of the darkest pixels at an exposure of 1.
    pub bound: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            format: vk::Format::R32G32B32A32_SFLOAT,
            preset: Preset::Default,
            phase: PhaseKind::HenyeyGreenstein,
            height: false,
            environment: false,
            bound: 1e-4,
        }
    }
}

impl Settings {
    /// Bytes of a picture of so many pixels that the pass makes for the frame; `None` for a format whose size is not known.
    #[must_use]
    pub fn picture_bytes(&self, [width, height]: [u32; 2]) -> Option<u64> {
        ImageDesc::new_2d(width, height, self.format).bytes()
    }

    /// The settings nearest below these whose picture fits `bytes`, what a refused plan's budget had left: half floats. None
    /// when not even they fit: then the pass needs a target of the host's, such as [`Frame::target`](crate::Frame::target)
    /// takes, or fewer pixels.
    #[must_use]
    pub fn next_that_fits(&self, size: [u32; 2], bytes: u64) -> Option<Self> {
        let with = |format| Self { format, ..*self };
        let formats = [self.format, vk::Format::R16G16B16A16_SFLOAT];
        formats
            .map(with)
            .into_iter()
            .find(|settings| settings.picture_bytes(size).is_some_and(|n| n <= bytes))
    }

    /// Refuses what is out of range.
    ///
    /// # Errors
    /// [`FogError::Range`] with the field, [`FogError::Kernel`] for what does not go together.
    pub fn check(&self) -> Result<(), FogError> {
        if self.environment && self.height {
            let (what, mend) = ("thins with height", "choose Settings::height or Settings::environment");
            return Err(FogError::Kernel { what, mend });
        }
        let bound = self.bound;
        check(|| "bound".to_owned(), bound, bound >= 0.0 && bound.is_finite(), "a radiance from 0 on")
    }
}
