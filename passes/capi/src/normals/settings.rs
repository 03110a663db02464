//! How textures of lobes are made.

use airglow_normals::{FitSettings, Settings, Storage};

use crate::input::{Versioned, one_of};
use crate::pass;
use crate::status::Failure;

/// How a texture holds its lobes.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowLobeStorage {
    /// `VK_FORMAT_R16G16B16A16_SFLOAT`.
    F16 = 0,
    /// `VK_FORMAT_R8G8B8A8_SNORM`: half the bytes, for matt materials.
    Snorm8 = 1,
    /// `VK_FORMAT_R8G8B8A8_UNORM`: axis, width and weight, for `normals_octahedral` of `normals/lobe.glsl`; nearer than the other
    /// in as many bytes.
    Octahedral8 = 2,
}

/// How textures of lobes are made. Zero is the default of every field.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowNormalsSettings {
    /// `sizeof(AirglowNormalsSettings)`.
    pub struct_size: u32,
    /// Lobes of a texel: 1, 2, 4 or 6. 0 is 4.
    pub lobes: u32,
    /// Steps of fitting, to 32. 0 is 20.
    pub iterations: u32,
    /// An `AirglowLobeStorage`.
    pub storage: u32,
    /// The sharpest lobe while fitting, 1 to 1e8. 0 is 1000.
    pub sharpest: f64,
    /// Bytes that the texture of a map may take; what takes more is refused. 0 is 16 bytes a texel of the map.
    pub budget: u64,
}

// SAFETY: `#[repr(C)]`, its size first, numbers; fields of 8 bytes are at multiples of 8.
unsafe impl Versioned for AirglowNormalsSettings {
    const OLDEST: usize = size_of::<Self>();
}

impl pass::Settings for AirglowNormalsSettings {
    type Read = Settings;

    fn read(&self) -> Result<Settings, Failure> {
        let fit = FitSettings::default();
        let count = |given: u32, default: usize| if given == 0 { default } else { given as usize };
        let settings = Settings {
            fit: FitSettings {
                lobes: count(self.lobes, fit.lobes),
                iterations: count(self.iterations, fit.iterations),
                sharpest: if self.sharpest == 0.0 { fit.sharpest } else { self.sharpest },
            },
            storage: one_of("storage", self.storage, &[Storage::F16, Storage::Snorm8, Storage::Octahedral8])?,
            budget: (self.budget > 0).then_some(self.budget),
        };
        settings.check()?;
        Ok(settings)
    }
}
