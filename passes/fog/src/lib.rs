//! Fog: single scattering from point and spot lights inside a medium, in closed paths and without a march.
//!
//! Sun, Ramamoorthi, Narasimhan and Nayar, "A Practical Analytic Single Scattering Model for Real Time Rendering"
//! (SIGGRAPH 2005); Sun 2008, chapter 3. What reaches the eye along a ray of length D through a medium of extinction b
//! and phase function p is
//! ```text
//! L = exp(-b D) L_surface + sum over the lights of  b_s I  Integral 0..D  p(cos a) exp(-b (x + d)) / d^2 dx
//! ```
//! with d the distance of the light from the point at x. The integral is not looked up and not marched: it has a
//! variable in which a few points of Gauss and Legendre's rule give it to 1e-3 or 1e-5 for any distances.
//!
//! ```no_run
//! use airglow_fog::{Camera, Fog, Frame, Light, Medium, Settings, View};
//! use airglow_gpu::{Context, Record};
//! use airglow_graph::{Graph, Handle, Image};
//! use airglow_math::World;
//! use glam::DVec3;
//!
//! # fn host(context: &Context, graph: &mut Graph<Record>, surface: Handle<Image>, depth: Handle<Image>)
//! # -> Result<(), airglow_fog::FogError> {
//! let fog = Fog::new(context, Settings::default())?;
//! let camera = Camera {
//!     position: DVec3::new(0.0, 1.7, 8.0),
//!     right: DVec3::X,
//!     up: DVec3::Y,
//!     forward: DVec3::NEG_Z,
//!     edges: [-0.8, 0.8, -0.45, 0.45],
//! };
//! let lamp = Light { radius: 0.1, ..Light::point(DVec3::new(0.0, 4.0, 0.0), [40.0, 30.0, 15.0]) };
//! let medium = Medium::with_visibility(60.0);
//! let view = View { world: World::default(), camera, medium, lights: vec![lamp], environment: None };
//! let fogged = fog.add(graph, &Frame { size: [1280, 720], surface, depth, target: None, view })?;
//! // … the tone map reads fogged.colour …
//! # Ok(())
//! # }
//! ```
#![forbid(unsafe_code)]

mod background;
mod beam;
pub mod bench;
mod camera;
mod control;
mod declare;
mod distant;
mod envelope;
mod environment;
mod error;
pub mod eval;
pub mod evaluator;
mod fog;
mod frame;
mod health;
mod kernels;
mod light;
mod limits;
mod lobes;
mod medium;
mod pack;
mod preset;
mod reach;
pub mod reference;
pub mod rivals;
mod settings;
pub mod stability;
mod tiles;
mod view;

pub use background::{Asked, Background, Seen};
pub use bench::Bench;
pub use camera::Camera;
pub use control::{Control, Counts};
pub use distant::Distant;
pub use envelope::{Envelope, Pipelines};
pub use environment::{ENVIRONMENT_ORDER, Environment};
pub use error::FogError;
pub use fog::{ACCESSES, Bindings, Fog, Pass, Prepared};
pub use frame::{Fogged, Frame};
pub use health::{COUNTED, InputHealth};
pub use kernels::{BACKGROUND_BINDINGS, BINDINGS, HEALTH_BINDINGS, LOBE_BINDINGS};
pub use light::{Bounds, Cone, Light};
pub use limits::MAX_LIGHTS;
pub use lobes::{Lobe, LobeTables, MAX_EXPONENT};
pub use medium::{MAX_G, Medium, Phase, PhaseKind, Thinning, VISIBILITY_CONTRAST};
pub use pack::{FrameConstants, LightConstants};
pub use settings::{Preset, Settings};
pub use tiles::TILE;
pub use view::View;
