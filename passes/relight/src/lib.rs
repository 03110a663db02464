//! Relighting by precomputed radiance transfer in spherical harmonics, rendered to a vertex array.
//!
//! Sloan, Kautz and Snyder, "Precomputed Radiance Transfer for Real-Time Rendering in Dynamic, Low-Frequency
//! Lighting Environments" (SIGGRAPH 2002): a bake gives each vertex p a transfer vector t_p, the SH projection of
//! its visibility times the cosine over pi; then the colour of a white diffuse surface under light l is
//! ```text
//! B_p = t_p . l                      one dot product a vertex and channel
//! B_p = <t_p, l, v> = v^T M_l t_p    with a dynamic visibility vector v
//! L_p = M_l v                        the incident radiance itself, for shaders that need direction
//! ```
//! A mesh without a bake, or with a skin, has the transfer of an unshadowed surface about its current normal instead.
//! M_l is the SH product matrix of the light (Sun 2008, eqs. 5.8-5.10). The light is projected exactly from
//! an equirectangular environment, each texel constant, and rotated on the GPU.
//!
//! ```no_run
//! use airglow_graph::{Access, Graph, ImageDesc, Limits};
//! use airglow_gpu::ash::vk::{Format, ImageUsageFlags};
//! use airglow_gpu::{Context, Execution, Image, Imports};
//! use airglow_relight::{Environment, Frame, Instance, Light, Relight, Settings};
//! use glam::DQuat;
//!
//! # fn host(context: &Context, sky: &Image, transfer: &[f32]) -> Result<(), Box<dyn std::error::Error>> {
//! let mut relight = Relight::new(context, Settings::default())?;
//! let mesh = relight.add_mesh(context, "teapot", transfer.len() as u32 / 16, Some(transfer))?;
//! let (mut graph, mut imports) = (Graph::new(), Imports::new());
//! let image = graph.import_image("sky", *sky.desc(), Access::FragmentSampled, Access::FragmentSampled);
//! imports.image(&image, sky);
//! let environment = Environment { image, width: 1024, height: 512, revision: 1, rotation: DQuat::IDENTITY };
//! let frame = Frame { light: Light::Environment(environment), instances: vec![Instance::new(mesh)], target: None };
//! let relit = relight.add(context, &mut graph, &mut imports, &frame)?;
//! // … the host's draw reads relit.results at Access::VertexBuffer from byte relit.ranges[0].offset on …
//! let execution = Execution::prepare(context, graph.compile(&Limits::default())?)?;
//! # Ok(())
//! # }
//! ```
#![forbid(unsafe_code)]

mod bench;
mod builder;
mod constants;
mod control;
pub mod curve;
mod declare;
mod envelope;
mod error;
pub mod eval;
mod frame;
pub mod kernels;
mod mesh;
mod order;
pub mod pack;
mod prepare;
mod preset;
mod record;
pub mod reference;
mod relight;
mod resident;
pub mod rivals;
mod rotation;
mod settings;
mod shown;
pub mod stability;
mod stage;
mod tables;
mod vertices;

pub use bench::{Bench, Case, CaseLight, Run, Texels};
pub use control::Rotations;
pub use declare::GraphFrame;
pub use envelope::{Envelope, Pipelines};
pub use error::RelightError;
pub use frame::{Environment, Frame, Instance, Light, Relit, ResultRange};
pub use mesh::MeshId;
pub use order::MAX_ORDER;
pub use record::Bindings;
pub use relight::{HEALTH, Relight};
pub use rotation::{Orientation, instance_rotation, object_space};
pub use settings::{LightKind, Method, Output, Settings, Storage};
pub use shown::Shown;
pub use stage::{Need, Prepared, Resource, Stage, Use};
pub use tables::check_environment;
