//! The knobs of a bake.

use crate::BakeError;

/// Highest number of bands a bake produces: "order n" has bands 0..n, n² coefficients.
pub const MAX_ORDER: usize = 6;
/// Most rays a vertex may ask for.
pub const MAX_RAYS: u32 = 1 << 20;

/// Settings of a shadowed bake.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Bands of the transfer and visibility vectors, 1..=[`MAX_ORDER`]. Default 4: below it the shadows of a
    /// sun are too wide, above it they cost more memory than they show.
    pub order: usize,
    /// Rays per vertex over the hemisphere of its normal, 1..=[`MAX_RAYS`]. Default 1024, whose
    /// noise of 0.3 % (root mean square, measured) is a twentieth of what order 4 leaves out.
    pub rays: u32,
    /// The static visibility vector wanted beside the transfer, from the same rays. Default none.
    pub visibility: Option<BelowHorizon>,
    /// Longest ray, in metres of the space baked in; occluders further away do not count. Positive; default
    /// infinite.
    pub reach: f32,
    /// Decorrelates two bakes of the same mesh; the result depends on nothing else that is random. Default 0.
    pub seed: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self { order: 4, rays: 1024, visibility: None, reach: f32::INFINITY, seed: 0 }
    }
}

/// What the visibility function V(s) is where s points below the vertex's tangent plane. No ray is traced
/// there, and the clamped cosine multiplies it by zero; but the vectors are truncated, so the choice shows in
/// products.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BelowHorizon {
    /// V = the share of the cosine-weighted upper hemisphere that is free. An open vertex then has V = 1 and a
    /// closed one V = 0, both exactly, and the product with the clamped cosine is close to the transfer vector
    /// at every order.
    Mean,
    /// V = 1: what other geometry blocks, without the vertex's own surface.
    Visible,
    /// V = 0: the surface blocks its own lower hemisphere, as shading normals tilted off the vertex's see it.
    Blocked,
}

impl Settings {
    /// Checks every field against its range.
    ///
    /// # Errors
    /// [`BakeError::Setting`] names the first field out of range.
    pub fn check(&self) -> Result<(), BakeError> {
        let refuse = |name, value: String, range| Err(BakeError::Setting { name, value, range });
        check_order(self.order)?;
        if !(1..=MAX_RAYS).contains(&self.rays) {
            return refuse("rays", self.rays.to_string(), "1..=1048576");
        }
        if self.reach.is_nan() || self.reach <= 0.0 {
            return refuse("reach", self.reach.to_string(), "positive metres, or infinity");
        }
        Ok(())
    }

    /// Coefficients per vector: the square of the order.
    #[must_use]
    pub fn coefficient_count(&self) -> usize {
        self.order * self.order
    }
}

/// Refuses an order outside 1..=[`MAX_ORDER`].
pub(crate) fn check_order(order: usize) -> Result<(), BakeError> {
    if (1..=MAX_ORDER).contains(&order) {
        Ok(())
    } else {
        Err(BakeError::Setting { name: "order", value: order.to_string(), range: "1..=6" })
    }
}
