//! Precomputed radiance transfer on the host's arrays: transfer and visibility vectors per vertex, by rays over
//! a bounding-volume hierarchy. CPU only: no Vulkan, no scene files.
//!
//! Sloan, Kautz, Snyder 2002 (diffuse, shadowed transfer), with the normalisation of Sun 2008 eq. 5.14: the
//! vector of a vertex with normal N and visibility V is t = 1/π ∫ V(s) max(s·N, 0) y(s) ds.
#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod analytic;
mod bake;
pub mod cache;
mod directions;
mod error;
mod executor;
mod frame;
mod instance;
mod mesh;
mod occluders;
mod origin;
mod probe;
mod progress;
pub mod reference;
mod scale;
mod settings;
mod transfer;
mod triangle;
mod vertices;
#[cfg(test)]
mod watertight;

pub use airglow_math::MathError;
pub use analytic::unshadowed;
pub use bake::bake;
pub use error::BakeError;
pub use executor::{Executor, Threads};
pub use instance::{LightFrame, NotShared, UNIFORM_TOLERANCE};
pub use mesh::{Mask, Mesh, Occluder};
pub use occluders::Occluders;
pub use probe::Probe;
pub use progress::{Progress, Report, Silent};
pub use settings::{BelowHorizon, MAX_ORDER, MAX_RAYS, Settings};
pub use transfer::{Baked, Stats, Transfer};
