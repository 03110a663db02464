//! What a host may come to need, whose pipelines are all made ahead.

use airglow_gpu::{Kernel, Outside, Permutations};

use crate::NormalsError;
use crate::kernels;
use crate::settings::Settings;
use crate::storage::Storage;

/// Every [`Settings`] that can be made of these; iterations and budgets may be any.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Envelope {
    /// Lobes of a texel: 1, 2, 4, 6.
    pub lobes: Vec<usize>,
    /// How textures hold them.
    pub storages: Vec<Storage>,
}

/// Every pipeline of an [`Envelope`], for [`Normals::with_pipelines`](crate::Normals::with_pipelines).
pub type Pipelines = airglow_gpu::Pipelines<Envelope>;

impl From<&Settings> for Envelope {
    /// The envelope of these settings alone.
    fn from(settings: &Settings) -> Self {
        Self { lobes: vec![settings.fit.lobes], storages: vec![settings.storage] }
    }
}

impl Envelope {
    /// Refuses settings outside, naming the first that is.
    ///
    /// # Errors
    /// [`NormalsError::Envelope`].
    pub fn check(&self, settings: &Settings) -> Result<(), NormalsError> {
        let (lobes, storage) = (settings.fit.lobes, settings.storage);
        Ok(Outside::check([
            (self.lobes.contains(&lobes), "lobes", format!("{lobes} lobes")),
            (self.storages.contains(&storage), "storages", format!("storage {storage:?}")),
        ])?)
    }
}

impl Permutations for Envelope {
    type Error = NormalsError;

    fn kernels(&self) -> Result<Vec<Kernel>, NormalsError> {
        let mut all = Vec::new();
        for &lobes in &self.lobes {
            all.push(kernels::fit(lobes)?);
            all.extend(kernels::align(lobes));
        }
        all.extend(self.storages.iter().map(|&storage| kernels::pack(storage)));
        match self.lobes.is_empty() || self.storages.is_empty() {
            true => Err(NormalsError::Range {
                what: "the number of an envelope's lobes or storages",
                value: 0.0,
                range: "at least one of each",
            }),
            false => Ok(all),
        }
    }
}
