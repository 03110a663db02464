//! The knobs of the pass on a device.

use crate::gpu::{LightShape, TexelSettings};
use crate::{RadianceError, Settings};

/// What the pass is made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassSettings {
    /// Bands of light vectors, 3 to 6. Default 4, as relight has it.
    pub order: usize,
    /// Whether samples hold gradients and are continued by them. Default on: the largest gain there is.
    pub gradients: bool,
    /// Texels along a side of a cube face, a multiple of 8, 8 to 128. Default 8: rays decide the error, texels the time.
    pub face: u32,
    /// Rays along a side of a texel: 1, 2 or 4. Default 4: a lamp of a few degrees is not seen by texels alone.
    pub rays: u32,
    /// Whether samples are taken in closed form where that is exact. Default on.
    pub closed_forms: bool,
    /// By what part of the bound, 0 or more, samples may be stale before they are taken again when emitters move; 0 takes all
    /// of them in each frame that emitters move in, and needs half the memory. For [`Oracle::Transfer`](crate::Oracle).
    /// Default 0.25: light within the bound of that from scratch at a fraction of its samples.
    pub keep: f64,
    /// How far the tree is refined. Its limit says how much memory samples get.
    pub refinement: Settings,
}

impl Default for PassSettings {
    fn default() -> Self {
        Self {
            order: 4,
            gradients: true,
            face: 8,
            rays: 4,
            closed_forms: true,
            keep: 0.25,
            refinement: Settings::default(),
        }
    }
}

/// Most samples of a device: the light of so many fits into a binding of 128 MiB at any order.
const MOST_SAMPLES: usize = 1 << 16;

impl PassSettings {
    /// Refuses what is out of range.
    ///
    /// # Errors
    /// [`RadianceError::Setting`].
    pub fn check(&self) -> Result<(), RadianceError> {
        self.refinement.check()?;
        if self.keep.is_nan() || self.keep < 0.0 {
            return Err(RadianceError::setting("keep", self.keep, "zero or more"));
        }
        if !(3..=6).contains(&self.order) {
            return Err(RadianceError::setting("order", self.order, "3 to 6 bands"));
        }
        if !(1..=MOST_SAMPLES).contains(&self.refinement.limit) {
            return Err(RadianceError::setting("limit", self.refinement.limit, "1 to 65536 samples"));
        }
        Ok(())
    }

    pub(crate) fn shape(&self) -> LightShape {
        LightShape { order: self.order, gradients: self.gradients }
    }

    pub(crate) fn texels(&self) -> TexelSettings {
        TexelSettings { shape: self.shape(), size: self.face, rays: self.rays }
    }

    /// Bytes of a vertex's light.
    #[must_use]
    pub fn light_bytes(&self) -> u64 {
        12 * self.shape().coefficients() as u64
    }
}
