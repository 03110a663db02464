//! Normal maps filtered as distributions of normals, so that a far surface looks like the average of its near self.
//!
//! Han, Sun, Ramamoorthi and Grinspun, "Frequency Domain Normal Map Filtering" (SIGGRAPH 2007); Sun 2008, section 5.1.
//! The mean radiance of the normals under a texel is the BRDF convolved with their distribution (eq. 5.6). This crate holds
//! the truth, [`reference::radiance`], and on the CPU what may be kept of a distribution: a [`Mixture`] of lobes,
//! [`Harmonics`], and the [`rivals`]. [`Bench`] runs the kernels that fit mixtures to every level of a map and shade them.
//!
//! ```
//! use airglow_normals::{Brdf, Directions, FitSettings, NormalMap, fit, reference, shade};
//! use glam::DVec3;
//!
//! let groove: Vec<[f32; 3]> = (0..16).map(|i| [if i % 2 == 0 { 0.6 } else { -0.6 }, 0.0, 0.8]).collect();
//! let map = NormalMap::from_vectors(4, 4, &groove)?;
//! let footprint = map.footprint(2, 0, 0)?;
//! let mixture = fit(&footprint, &FitSettings { lobes: 2, ..Default::default() })?;
//! let directions = Directions::new(DVec3::new(1.0, 0.0, 1.0), DVec3::new(0.3, 0.1, 1.0))?;
//! let brdf = Brdf::Ggx { alpha: 0.3 };
//! let (ours, truth) = (shade::radiance(&mixture, brdf, directions), reference::radiance(&footprint, brdf, directions));
//! assert!((ours / truth - 1.0).abs() < 0.01, "{ours} against {truth}");
//! # Ok::<(), airglow_normals::NormalsError>(())
//! ```
#![forbid(unsafe_code)]

pub mod averages;
pub mod bench;
pub mod blocks;
mod brdf;
mod build;
pub mod cache;
pub mod chain;
mod choice;
pub mod cost;
mod declare;
mod envelope;
mod error;
pub mod eval;
mod fit;
pub mod ggx;
mod harmonics;
mod health;
pub mod kernels;
pub mod ktx2;
mod map;
mod method;
mod mixture;
mod normals;
pub mod octahedral;
mod ordered;
mod preset;
pub mod reference;
pub mod rivals;
mod settings;
pub mod shade;
pub mod stability;
mod stage;
mod storage;
pub mod vmf;
pub mod zonal;

pub use bench::Bench;
pub use brdf::{Brdf, Directions};
pub use build::{Build, LobeTexture, Progress};
pub use choice::{Choice, choose};
pub use envelope::{Envelope, Pipelines};
pub use error::NormalsError;
pub use fit::{FitSettings, fit, fit_from};
pub use harmonics::{Harmonics, band_factors};
pub use health::HEALTH;
pub use map::{NormalMap, Sample};
pub use method::Method;
pub use mixture::{MAX_LOBES, Mixture, WeightedLobe};
pub use normals::Normals;
pub use settings::Settings;
pub use stage::{Resource, Stage};
pub use storage::Storage;
