//! Meshes as sets of spheres, and the spheres of a mesh that moves.

mod ball;
mod fit;
mod hierarchy;
mod parallel;
mod skin;
mod voxels;

pub use fit::{FitSettings, SphereSet, fit};
pub use hierarchy::{Hierarchy, Node};
pub use skin::{SphereWeights, skinned, weights};
