//! Where the light of a scene's vertices comes from, before anything is on the device.

use std::path::Path;

use airglow_scene::Scene;

use super::transfer::{self, SceneTransfer};
use super::{bake, needed};
use crate::failure::Outcome;
use crate::output::Output;

/// What lights the vertices.
pub enum Source {
    /// The relight pass, with this transfer.
    Relight(SceneTransfer),
    /// Colours that the host computed, one list for each instance.
    Colours(Vec<Vec<[f32; 3]>>),
    /// Evenly from everywhere: the pass is left out.
    Even(Reason),
}

/// Why a scene is lit evenly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// There is nothing to relight by.
    NoEnvironment,
    /// The command line says so.
    Asked,
}

impl Source {
    /// The pass with its transfer, baked or found in `cache`, or nothing where the pass has nothing to do.
    pub fn of_scene(scene: &Scene, without_relight: bool, cache: &Path, output: &Output) -> Outcome<Self> {
        match (needed::relighting(scene), without_relight) {
            (_, true) => Ok(Self::Even(Reason::Asked)),
            (false, false) => Ok(Self::Even(Reason::NoEnvironment)),
            (true, false) => bake::of_scene(scene, &scene.quality, cache, output).map(Self::Relight),
        }
    }

    /// The same without a bake, for plans alone.
    pub fn unbaked(scene: &Scene, without_relight: bool) -> Outcome<Self> {
        match (needed::relighting(scene), without_relight) {
            (_, true) => Ok(Self::Even(Reason::Asked)),
            (false, false) => Ok(Self::Even(Reason::NoEnvironment)),
            (true, false) => transfer::unbaked(scene).map(Self::Relight),
        }
    }

    /// Has the pass count bad texels of the environment, where there is the pass.
    pub fn count_health(&mut self) {
        if let Self::Relight(transfer) = self {
            transfer.health = true;
        }
    }
}
