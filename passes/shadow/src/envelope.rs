//! What a host may come to need, whose pipelines are all made ahead.

use airglow_gpu::{Kernel, Outside, Permutations};

use crate::ShadowError;
use crate::exponential::Exponential;
use crate::kernels::{self, Program};
use crate::settings::Settings;

/// Every [`Settings`] that can be made of these, and the pass per pixel; all other knobs may be any. What does not go
/// together, such as normals and the optimal linear exponential, is no part of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Envelope {
    /// Orders, 3 to 6.
    pub orders: Vec<usize>,
    /// Ways to the exponential; those that differ in numbers alone share their kernels.
    pub exponentials: Vec<Exponential>,
    /// Receivers with normals, without, or both; none where there is the pass per pixel alone.
    pub normals: Vec<bool>,
    /// Whether [`PixelShadow`](crate::PixelShadow) may be needed.
    pub pixels: bool,
}

/// Every pipeline of an [`Envelope`], for [`Shadow::with_pipelines`](crate::Shadow::with_pipelines) and
/// [`PixelShadow::with_pipelines`](crate::PixelShadow::with_pipelines).
pub type Pipelines = airglow_gpu::Pipelines<Envelope>;

impl From<&Settings> for Envelope {
    /// The envelope of these settings alone, over receivers.
    fn from(settings: &Settings) -> Self {
        Self {
            orders: vec![settings.order],
            exponentials: vec![settings.exponential],
            normals: vec![settings.normals],
            pixels: false,
        }
    }
}

impl Envelope {
    /// Every settings of the envelope that has a kernel over receivers.
    #[must_use]
    pub fn settings(&self) -> Vec<Settings> {
        let mut all = Vec::new();
        for &order in &self.orders {
            for &exponential in &self.exponentials {
                let with = |&normals| Settings { order, exponential, normals, ..Settings::default() };
                all.extend(self.normals.iter().map(with).filter(|settings| settings.check().is_ok()));
            }
        }
        all
    }

    /// Refuses settings outside, naming the first that is.
    ///
    /// # Errors
    /// [`ShadowError::Envelope`].
    pub fn check(&self, settings: &Settings) -> Result<(), ShadowError> {
        let Settings { order, exponential, normals, .. } = *settings;
        let kind = |exponential: Exponential| Program::of(exponential).kind;
        let known = self.exponentials.iter().any(|&known| kind(known) == kind(exponential));
        Ok(Outside::check([
            (self.orders.contains(&order), "orders", format!("order {order}")),
            (known, "exponentials", format!("{exponential:?}")),
            (self.normals.contains(&normals), "normals", format!("normals: {normals}")),
        ])?)
    }

    /// Refuses settings of the pass per pixel that are outside.
    ///
    /// # Errors
    /// [`ShadowError::Envelope`].
    pub fn check_pixels(&self, settings: &Settings) -> Result<(), ShadowError> {
        let order = settings.order;
        Ok(Outside::check([
            (self.pixels, "pixels", "the pass per pixel".to_owned()),
            (self.orders.contains(&order), "orders", format!("order {order}")),
        ])?)
    }
}

impl Permutations for Envelope {
    type Error = ShadowError;

    fn kernels(&self) -> Result<Vec<Kernel>, ShadowError> {
        let receivers = |settings: Settings| {
            kernels::visibility(Program::of(settings.exponential).kind, settings.order, settings.normals)
        };
        let mut all: Vec<_> = self.settings().into_iter().filter_map(receivers).collect();
        let orders = self.pixels.then_some(&self.orders).into_iter().flatten();
        all.extend(orders.filter_map(|&order| kernels::pixels(order)));
        match all.is_empty() {
            true => Err(ShadowError::Method {
                method: "an envelope without kernels".to_owned(),
                known: "orders 3 to 6 with an exponential that goes with one of the normals",
            }),
            false => Ok(all),
        }
    }
}
