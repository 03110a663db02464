//! Meshes as sets of spheres, and the spheres of a mesh that moves.

mod ball;
mod fit;
mod skin;
mod voxels;

pub use fit::{FitSettings, SphereSet, fit};
pub use skin::{SphereWeights, skinned, weights};
