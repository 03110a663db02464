//! Scene files.

use std::path::Path;

use crate::error::SceneError;
use crate::scene::Scene;

/// Loads a scene file.
pub(crate) fn load(file: &Path) -> Result<Scene, SceneError> {
    let _ = file;
    Ok(Scene::default())
}
