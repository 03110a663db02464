//! What fog is prepared for.

use airglow_fog::{PhaseKind, Preset, Settings};
use airglow_gpu::ash::vk;

use crate::input::{Versioned, one_of, or_default};
use crate::pass;
use crate::status::Failure;

/// How exactly the airlight is computed.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowFogPreset {
    /// 6 points of quadrature a light and pixel.
    Default = 0,
    /// 16 points of quadrature a light and pixel.
    Reference = 1,
}

/// The kind of phase function; its numbers come with a view.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowFogPhase {
    /// Henyey and Greenstein's, of mean cosine g: `phase[0]`.
    HenyeyGreenstein = 0,
    /// Alike in all directions.
    Isotropic = 1,
    /// The sum of `phase[k]` times the kth power of the cosine; the weights hold the 1 / (4 pi).
    Polynomial = 2,
    /// Draine's: g is `phase[0]`, alpha `phase[1]`.
    Draine = 3,
}

/// What fog is prepared for. Zero is the default of every field.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowFogSettings {
    /// `sizeof(AirglowFogSettings)`.
    pub struct_size: u32,
    /// `VkFormat` of the picture that is written; 0 is `VK_FORMAT_R32G32B32A32_SFLOAT`.
    pub format: u32,
    /// An `AirglowFogPreset`.
    pub preset: u32,
    /// An `AirglowFogPhase`.
    pub phase: u32,
    /// 1: a medium may thin with height. Not with an environment.
    pub height: u32,
    /// 1: views may have an environment behind the medium.
    pub environment: u32,
    /// Radiance, W/sr/m2, below which the airlight of one light is left out of a pixel; 0 is 1e-4, below 0 nothing is left
    /// out.
    pub bound: f64,
}

// SAFETY: `#[repr(C)]`, its size first, numbers; the field of 8 bytes is at a multiple of 8.
unsafe impl Versioned for AirglowFogSettings {
    const OLDEST: usize = size_of::<Self>();
}

impl pass::Settings for AirglowFogSettings {
    type Read = Settings;

    fn read(&self) -> Result<Settings, Failure> {
        use PhaseKind::{Draine, HenyeyGreenstein, Isotropic, Polynomial};
        let default = Settings::default();
        let settings = Settings {
            format: if self.format == 0 { default.format } else { vk::Format::from_raw(self.format as i32) },
            preset: one_of("preset", self.preset, &[Preset::Default, Preset::Reference])?,
            phase: one_of("phase", self.phase, &[HenyeyGreenstein, Isotropic, Polynomial, Draine])?,
            height: one_of("height", self.height, &[false, true])?,
            environment: one_of("environment", self.environment, &[false, true])?,
            bound: or_default(self.bound, default.bound),
        };
        settings.check()?;
        Ok(settings)
    }
}
