//! What shadows are prepared for.

use airglow_shadow::Settings;

use crate::input::{Versioned, one_of, or_default};
use crate::pass;
use crate::status::Failure;

/// What shadows are prepared for. Zero is the default of every field.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowShadowSettings {
    /// `sizeof(AirglowShadowSettings)`.
    pub struct_size: u32,
    /// Bands, 3 to 6: that of the relighting it goes into. 0 is 4.
    pub order: u32,
    /// 1: receivers bring normals, and what lies below their tangent planes is left out.
    pub normals: u32,
    /// 1: results stay as they come, and are not made ones that a visibility can have.
    pub unclamped: u32,
    /// Share of a half space below which a sphere is left out of a whole cluster, to 1. 0 is 1e-5, below 0 nothing is left
    /// out.
    pub reach: f64,
    /// Deringing: band l is divided by `1 + window l^2 (l + 1)^2`; 0 to 1.
    pub window: f64,
    /// Smallest eigenvalue over the largest before the logarithm, to 0.5. 0 is 0.02.
    pub clip: f64,
}

// SAFETY: `#[repr(C)]`, its size first, numbers; fields of 8 bytes are at multiples of 8.
unsafe impl Versioned for AirglowShadowSettings {
    const OLDEST: usize = size_of::<Self>();
}

impl pass::Settings for AirglowShadowSettings {
    type Read = Settings;

    fn read(&self) -> Result<Settings, Failure> {
        let default = Settings::default();
        let settings = Settings {
            order: if self.order == 0 { default.order } else { self.order as usize },
            normals: one_of("normals", self.normals, &[false, true])?,
            clamp: one_of("unclamped", self.unclamped, &[true, false])?,
            reach: or_default(self.reach, default.reach),
            window: self.window,
            clip: if self.clip == 0.0 { default.clip } else { self.clip },
            ..default
        };
        settings.check()?;
        Ok(settings)
    }
}
