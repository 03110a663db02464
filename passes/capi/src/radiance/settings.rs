//! What the light of near emitters is prepared for.

use airglow_radiance::{Oracle, PassSettings, Settings};

use crate::input::{Versioned, one_of, or_default};
use crate::pass;
use crate::status::Failure;

/// How the error of a sample that serves many vertices is estimated.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowRadianceOracle {
    /// The change of the vertices' colours, by their transfer vectors; radiance.
    Transfer = 0,
    /// Brightness times variation; radiance times metres.
    Argued = 1,
    /// As it is printed in the thesis; radiance a metre.
    Printed = 2,
}

/// What the light of near emitters is prepared for. Zero is the default of every field.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowRadianceSettings {
    /// `sizeof(AirglowRadianceSettings)`.
    pub struct_size: u32,
    /// Bands of light vectors, 3 to 6: that of the relighting they go into. 0 is 4.
    pub order: u32,
    /// 1: samples hold no gradients.
    pub without_gradients: u32,
    /// Texels along a side of a cube face, a multiple of 8 to 128. 0 is 8.
    pub face: u32,
    /// Rays along a side of a texel: 1, 2 or 4. 0 is 4.
    pub rays: u32,
    /// An `AirglowRadianceOracle`.
    pub oracle: u32,
    /// Most samples of a receiver, to 65536: they have their memory from the start. 0 is 4096.
    pub limit: u32,
    /// Most levels that a split goes down, to 8. 0 is 3.
    pub stride: u32,
    /// Nodes estimated above it are split, in the oracle's unit. 0 is 0.01, below 0 is 0.
    pub bound: f64,
    /// What part of the light that emitters would send unhidden a sample is taken to miss, to 1. 0 is 0.1, below 0 is 0.
    pub hidden: f64,
    /// By what part of the bound samples may be stale before they are taken again when emitters move. 0 is 0.25; below 0
    /// all are taken again in each such frame, and half the memory is needed.
    pub keep: f64,
    /// 1: samples are never taken in closed form.
    pub without_closed_forms: u32,
    /// Not used; 0.
    pub reserved: u32,
}

// SAFETY: `#[repr(C)]`, its size first, numbers; fields of 8 bytes are at multiples of 8.
unsafe impl Versioned for AirglowRadianceSettings {
    const OLDEST: usize = size_of::<Self>();
}

impl pass::Settings for AirglowRadianceSettings {
    type Read = PassSettings;

    fn read(&self) -> Result<PassSettings, Failure> {
        let default = PassSettings::default();
        let count = |given: u32, default: usize| if given == 0 { default } else { given as usize };
        let refinement = default.refinement;
        let settings = PassSettings {
            order: count(self.order, default.order),
            gradients: one_of("without_gradients", self.without_gradients, &[true, false])?,
            face: if self.face == 0 { default.face } else { self.face },
            rays: if self.rays == 0 { default.rays } else { self.rays },
            closed_forms: one_of("without_closed_forms", self.without_closed_forms, &[true, false])?,
            keep: or_default(self.keep, default.keep),
            refinement: Settings {
                oracle: one_of("oracle", self.oracle, &[Oracle::Transfer, Oracle::Argued, Oracle::Printed])?,
                bound: or_default(self.bound, refinement.bound),
                limit: count(self.limit, refinement.limit),
                stride: count(self.stride, refinement.stride),
                hidden: or_default(self.hidden, refinement.hidden),
            },
        };
        settings.check()?;
        Ok(settings)
    }
}
