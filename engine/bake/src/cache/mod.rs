//! Bakes kept in files: one bake, one safetensors file, found by a key over everything the bake depends on.
//!
//! The layout is in this crate's README. A file is written beside its target and renamed, so that it is whole or
//! absent; whatever cannot be used, for a reason that is told, is baked again.

pub mod container;
mod error;
mod file;
mod key;

use std::path::Path;

use glam::Mat4;

pub use error::{CacheError, Miss};
pub use file::{Precision, load, store};
pub use key::{CacheKey, SCHEMA};

use crate::{BakeError, Baked, Executor, Mesh, Occluder, Occluders, Progress, Settings, Stats, Transfer};

/// Where a result came from.
#[derive(Debug)]
pub enum Source {
    /// The file held it.
    Cache,
    /// It was baked and stored, because the file could not be used.
    Baked {
        /// The bake's account.
        stats: Stats,
        /// Why the file could not be used.
        miss: Miss,
    },
}

/// Why a cached bake failed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CachedBakeError {
    /// The bake itself failed; no file was touched.
    #[error(transparent)]
    Bake(#[from] BakeError),
    /// The bake succeeded, but its file could not be written.
    #[error(transparent)]
    Cache(#[from] CacheError),
}

/// Takes the bake from the file at `path` if that holds this very bake, or bakes and stores it there. Either way
/// the vectors are rounded to `precision`, so that both ways return the same bits. The hierarchy is only built
/// for a bake.
///
/// # Errors
/// Those of [`Occluders::build`], [`crate::bake()`] and [`store`].
pub fn bake_cached(
    path: &Path,
    precision: Precision,
    mesh: &Mesh<'_>,
    transform: Mat4,
    occluders: &[Occluder<'_>],
    settings: &Settings,
    executor: &dyn Executor,
    progress: &mut dyn Progress,
) -> Result<(Transfer, Source), CachedBakeError> {
    settings.check()?;
    mesh.check()?;
    let key = CacheKey::new(mesh, transform, occluders, settings);
    let miss = match load(path, &key, precision) {
        Ok(transfer) => return Ok((transfer, Source::Cache)),
        Err(miss) => miss,
    };
    let hierarchy = Occluders::build(occluders)?;
    let Baked { mut transfer, stats } =
        crate::bake(mesh, transform, &hierarchy, settings, executor, progress)?;
    precision.round(&mut transfer);
    store(path, &key, precision, &transfer)?;
    Ok((transfer, Source::Baked { stats, miss }))
}
