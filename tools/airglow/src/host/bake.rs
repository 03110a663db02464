//! All that is computed of a scene before its first frame, or found in the cache.

use std::path::Path;

use airglow_scene::{Quality, Scene};

use super::transfer::{self, SceneTransfer};
use crate::failure::Outcome;
use crate::output::Output;

/// Transfer and spheres, by what `quality` asks for; and where near emitters light the scene, the tree over its vertices.
pub fn of_scene(scene: &Scene, quality: &Quality, cache: &Path, output: &Output) -> Outcome<SceneTransfer> {
    let transfer = transfer::of_scene(scene, quality, cache, output)?;
    #[cfg(all(feature = "relight", feature = "radiance"))]
    let transfer = {
        let tree = super::near_tree::of_scene(scene, &transfer, cache, output)?;
        SceneTransfer { tree, ..transfer }
    };
    Ok(transfer)
}
