//! Incident radiance of emitters that are near: light vectors that differ from vertex to vertex.
//!
//! Yu-Hsian Sun, "Effective Sampling and Reconstruction of Incident Radiance for Spherical Harmonic Lighting" (2005).
#![forbid(unsafe_code)]

mod control;
mod declare;
mod emitter;
mod error;
pub mod eval;
mod glow;
pub mod gpu;
mod hierarchy;
mod incident;
mod octree;
mod oracle;
mod part;
mod pass_settings;
mod radiance;
mod receiver;
mod reconstruct;
pub mod reference;
mod refine;
pub mod rivals;
pub mod stability;
mod stage;
#[cfg(test)]
mod testing;

pub use control::{Control, Lights};
pub use declare::Lit;
pub use emitter::{Sphere, Triangle, check};
pub use error::RadianceError;
pub use glow::Glow;
pub use hierarchy::{Hierarchy, MAX_VERTICES, Node};
pub use incident::Incident;
pub use octree::{LEVELS, Octree};
pub use oracle::Oracle;
pub use part::Part;
pub use pass_settings::PassSettings;
pub use radiance::Radiance;
pub use receiver::Receiver;
pub use reconstruct::{OVERLAP, Reconstruction, TRUST, Weights};
pub use refine::{HIDDEN, Refined, Sample, Sampler, Settings, refine};
pub use stage::{Bindings, Prepared, Resource, Stage};
