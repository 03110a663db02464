//! Real-time lighting passes for Vulkan that an engine embeds in its own device.
//!
//! One room, one feature of the same name. What the rooms share is re-exported beside them: the graph a frame is
//! declared in, the layer over the host's device, the bake and the mathematics.
#![forbid(unsafe_code)]

pub use airglow_bake as bake;
#[cfg(feature = "fog")]
pub use airglow_fog as fog;
pub use airglow_gpu as gpu;
pub use airglow_graph as graph;
pub use airglow_math as math;
#[cfg(feature = "normals")]
pub use airglow_normals as normals;
#[cfg(feature = "radiance")]
pub use airglow_radiance as radiance;
#[cfg(feature = "relight")]
pub use airglow_relight as relight;
#[cfg(feature = "shadow")]
pub use airglow_shadow as shadow;

/// The host code of the front page compiles.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;

/// That of the guide does.
#[cfg(all(doctest, feature = "fog", feature = "radiance", feature = "shadow"))]
#[doc = include_str!("../../docs/integration.md")]
struct Guide;
