//! What a host may come to need, whose pipelines are all made ahead.

use airglow_gpu::{Kernel, Outside, Permutations};

use crate::RadianceError;
use crate::gpu::{keep, kernels, refinement, vertices};
use crate::pass_settings::PassSettings;

/// Every [`PassSettings`] that can be made of these; faces, staleness and refinement may be any.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Envelope {
    /// Orders, 3 to 6.
    pub orders: Vec<usize>,
    /// Samples with gradients, without, or both.
    pub gradients: Vec<bool>,
    /// Rays along a side of a texel: 1, 2, 4.
    pub rays: Vec<u32>,
    /// Whether samples in closed form may be needed.
    pub closed_forms: bool,
}

/// Every pipeline of an [`Envelope`], for [`Radiance::with_pipelines`](crate::Radiance::with_pipelines).
pub type Pipelines = airglow_gpu::Pipelines<Envelope>;

impl From<&PassSettings> for Envelope {
    /// The envelope of these settings alone.
    fn from(settings: &PassSettings) -> Self {
        Self {
            orders: vec![settings.order],
            gradients: vec![settings.gradients],
            rays: vec![settings.rays],
            closed_forms: settings.closed_forms,
        }
    }
}

impl Envelope {
    /// Every settings of the envelope, each with closed forms where those may be needed.
    #[must_use]
    pub fn settings(&self) -> Vec<PassSettings> {
        let mut all = Vec::new();
        for &order in &self.orders {
            for &gradients in &self.gradients {
                let of_rays = |&rays| PassSettings {
                    order,
                    gradients,
                    rays,
                    closed_forms: self.closed_forms,
                    ..PassSettings::default()
                };
                all.extend(self.rays.iter().map(of_rays));
            }
        }
        all
    }

    /// Refuses settings outside, naming the first that is.
    ///
    /// # Errors
    /// [`RadianceError::Envelope`].
    pub fn check(&self, settings: &PassSettings) -> Result<(), RadianceError> {
        let PassSettings { order, gradients, rays, closed_forms, .. } = *settings;
        Ok(Outside::check([
            (self.orders.contains(&order), "orders", format!("order {order}")),
            (self.gradients.contains(&gradients), "gradients", format!("gradients: {gradients}")),
            (self.rays.contains(&rays), "rays", format!("{rays} rays")),
            (self.closed_forms || !closed_forms, "closed_forms", "samples in closed form".to_owned()),
        ])?)
    }
}

impl Permutations for Envelope {
    type Error = RadianceError;

    fn kernels(&self) -> Result<Vec<Kernel>, RadianceError> {
        let mut all = Vec::new();
        for settings in self.settings() {
            let shape = settings.shape();
            all.extend([
                refinement::kernel(),
                keep::kernel(),
                kernels::texels(settings.shape(), settings.rays)?,
            ]);
            all.extend(settings.closed_forms.then(|| kernels::analytic(shape)).transpose()?);
            all.extend(vertices::kernels(shape)?);
        }
        match all.is_empty() {
            true => Err(RadianceError::setting("the envelope", "empty", "every list an entry")),
            false => Ok(all),
        }
    }
}
