//! The knobs of a chain.

use crate::NormalsError;
use crate::fit::FitSettings;
use crate::storage::Storage;

/// Bytes of a texel of the maps that assets bring: four components of 8 bits.
const SOURCE_BYTES: u64 = 4;
/// What a chain may take of its map's bytes unless the host says otherwise.
const DEFAULT_SHARE: u64 = 4;

/// How a chain is made and kept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// How each texel is fitted; on a device 1, 2, 4 or 6 lobes and at most
    /// [`MOST_ITERATIONS`](crate::chain::MOST_ITERATIONS) steps.
    pub fit: FitSettings,
    /// How the texture holds lobes. Default [`Storage::F16`].
    pub storage: Storage,
    /// Bytes that the texture may take. Default `None`: four times the map at 4 bytes a texel.
    pub budget: Option<u64>,
}

impl Settings {
    /// Bytes that the chain of a map may take.
    #[must_use]
    pub fn budget(&self, texels: usize) -> u64 {
        self.budget.unwrap_or(DEFAULT_SHARE * SOURCE_BYTES * texels as u64)
    }

    /// Refuses what is out of range.
    ///
    /// # Errors
    /// [`NormalsError::Range`].
    pub fn check(&self) -> Result<(), NormalsError> {
        self.fit.check()
    }
}
