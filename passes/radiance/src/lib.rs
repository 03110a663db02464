//! Incident radiance of emitters that are near: light vectors that differ from vertex to vertex.
//!
//! Yu-Hsian Sun, "Effective Sampling and Reconstruction of Incident Radiance for Spherical Harmonic Lighting" (2005). At
//! few points, chosen by a tree over the vertices and an oracle, light is sampled by cube maps and projected; vertices take
//! it from the samples whose domains hold them:
//! ```text
//! l_k = Integral L(x_k, s) Y(s) ds            a sample at x_k
//! l_p = sum w_k (l_k + G_k (p - x_k)) / sum w_k    a vertex at p; G_k the gradients of the sample
//! B_p = t_p . l_p                             its colour, by the relight pass
//! ```
//!
//! ```no_run
//! use airglow_gpu::{Context, Imports, Record};
//! use airglow_graph::Graph;
//! use airglow_radiance::{Hierarchy, Lights, Part, PassSettings, Radiance, Receiver, Triangle};
//! use std::ops::ControlFlow;
//!
//! # fn host(context: &Context, graph: &mut Graph<Record>, imports: &mut Imports, positions: &[[f32; 3]],
//! #     transfer: &[f32], lamp: &[Triangle]) -> Result<(), airglow_radiance::RadianceError> {
//! let settings = PassSettings::default();
//! let tree = Hierarchy::build(positions, transfer, &mut |_, _| ControlFlow::Continue(()))?;
//! let part = Part { vertices: 0..positions.len() as u32, turn: None };
//! let receiver = Receiver::new(context, settings, &tree, positions, &[part])?;
//! let radiance = Radiance::new(context, settings)?;
//! let lit = radiance.add(graph, imports, &receiver, &Lights { emitters: lamp, ..Lights::default() })?;
//! // … relight reads lit.light[0] as the light of each vertex; lit.control moves the lamp …
//! # Ok(())
//! # }
//! ```
#![forbid(unsafe_code)]

mod budget;
mod control;
mod declare;
mod emitter;
mod envelope;
mod error;
pub mod eval;
mod glow;
pub mod gpu;
mod health;
mod hierarchy;
mod incident;
mod kept;
mod lights;
mod octree;
mod oracle;
mod part;
mod pass_settings;
mod picture;
mod preset;
mod radiance;
mod read;
mod receiver;
mod reconstruct;
pub mod reference;
mod refine;
mod resource;
pub mod rivals;
mod shown;
pub mod stability;
mod stage;
#[cfg(test)]
mod testing;

pub use control::Control;
pub use declare::Lit;
pub use emitter::{Sphere, Triangle, check, check_spheres};
pub use envelope::{Envelope, Pipelines};
pub use error::RadianceError;
pub use glow::Glow;
pub use health::HEALTH;
pub use hierarchy::{Hierarchy, MAX_VERTICES, Node};
pub use incident::Incident;
pub use lights::Lights;
pub use octree::{LEVELS, Octree};
pub use oracle::Oracle;
pub use part::Part;
pub use pass_settings::PassSettings;
pub use picture::Picture;
pub use radiance::Radiance;
pub use receiver::Receiver;
pub use reconstruct::{DARK, OVERLAP, Reconstruction, TRUST, Weights};
pub use refine::{HIDDEN, Refined, Sample, Sampler, Settings, refine};
pub use resource::Resource;
pub use shown::Shown;
pub use stage::{Bindings, Prepared, Stage};
