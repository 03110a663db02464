//! What shadows are prepared for.

use airglow_shadow::{Exponential, Settings};

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
    /// An `AirglowShadowExponential`.
    pub exponential: u32,
    /// Of a series, 1 to 32.
    pub degree: u32,
    /// Of a series by Horner's rule the largest norm of what it is given, of the hybrid its threshold; above 0.
    pub norm: f64,
    /// Share of a half space below which a node of a hierarchy stands for what it holds, to 1. 0 is 0.03, below 0 spheres
    /// are taken alone.
    pub cut: f64,
}

/// The way to the exponential.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowShadowExponential {
    /// The polynomial of the least degree that is near enough wherever it is asked.
    Adaptive = 0,
    /// The product series of a degree, of the whole vector.
    Series = 1,
    /// A series by Horner's rule of what is scaled to a norm, then squared.
    Horner = 2,
    /// Optimal linear.
    OptimalLinear = 3,
    /// Optimal linear of what is scaled to a threshold, then squared.
    Hybrid = 4,
}

// SAFETY: `#[repr(C)]`, its size first, numbers; fields of 8 bytes are at multiples of 8.
unsafe impl Versioned for AirglowShadowSettings {
    const OLDEST: usize = std::mem::offset_of!(Self, exponential);
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
            cut: or_default(self.cut, default.cut),
            exponential: self.exponential()?,
        };
        settings.check()?;
        Ok(settings)
    }
}

impl AirglowShadowSettings {
    fn exponential(&self) -> Result<Exponential, Failure> {
        let (degree, norm) = (self.degree as usize, self.norm);
        let ways = [
            Exponential::Adaptive,
            Exponential::Series { degree },
            Exponential::Horner { degree, norm },
            Exponential::OptimalLinear,
            Exponential::Hybrid { threshold: norm },
        ];
        one_of("exponential", self.exponential, &ways)
    }
}
