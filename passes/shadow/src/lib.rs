//! Soft shadows of moving things under environment light: blockers become spheres, their log visibility adds up in
//! spherical harmonics, and one exponential per receiver gives what all of them leave to be seen.
//!
//! Ren, Wang, Snyder, Zhou, Liu, Sun, Sloan, Bao, Peng and Guo, "Real-time Soft Shadows in Dynamic Scenes using Spherical
//! Harmonic Exponentiation" (SIGGRAPH 2006); Sun 2008, section 5.2.
//!
//! ```
//! use airglow_shadow::{Exponential, Sphere, reference};
//! use glam::DVec3;
//!
//! let spheres = [Sphere { center: DVec3::new(0.0, 2.0, 0.0), radius: 1.0 }];
//! let caps = reference::caps(&spheres, DVec3::ZERO);
//! let visibility = reference::Reference::new(4)?.visibility(Exponential::Operator, &caps)?;
//! let seen = reference::ambient(4, &visibility, DVec3::Y)?;
//! // A sphere of angular radius 30 degrees overhead takes sin^2 30 degrees of the light.
//! assert!((seen - 0.75).abs() < 0.01, "{seen}");
//! # Ok::<(), airglow_shadow::ShadowError>(())
//! ```
#![forbid(unsafe_code)]

pub mod bench;
mod blockers;
mod budget;
pub mod circle;
mod clusters;
mod counts;
mod declare;
mod eigen;
mod envelope;
mod error;
pub mod eval;
pub mod exponential;
pub mod families;
mod health;
pub mod kernels;
pub mod light;
mod linear;
mod logarithm;
mod mean;
mod order;
mod pixels;
mod polynomial;
mod preset;
pub mod reference;
mod settings;
mod shadow;
pub mod spheres;
mod table;

pub use bench::Bench;
pub use blockers::{Blockers, MAX_SPHERES};
pub use circle::{Cap, Sphere};
pub use clusters::{CLUSTER, NOBODY, slots};
pub use counts::Counts;
pub use declare::Shadowed;
pub use envelope::{Envelope, Pipelines};
pub use error::ShadowError;
pub use exponential::{Evaluator, Exponential};
pub use health::HEALTH;
pub use kernels::{PIXEL_BINDINGS, PixelConstants};
pub use light::{Disc, Products, SplitSettings};
pub use linear::Linear;
pub use logarithm::{CLIP, Logarithm};
pub use order::{MAX_ORDER, MIN_ORDER, check_order};
pub use pixels::{PIXEL_ACCESSES, PixelLight, PixelLights, PixelPicture, PixelShadow, PixelViews};
pub use settings::Settings;
pub use shadow::{ACCESSES, Bindings, Receivers, Shadow};
pub use table::Tables;
