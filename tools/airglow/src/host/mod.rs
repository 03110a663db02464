//! The first host: it opens its own device, then uses only what any engine would.
//!
//! `device` opens and adopts; `transfer` bakes on the CPU; `lighting` holds the pass, or why it is not there; `scene`
//! and `upload` bring arrays to the device; `frame` declares a whole frame in one function; `draw` holds the host's own
//! draws, `surface` their pipelines, `lights`, `fog`, `incident`, `mapped` and `near` what they take of the scene's lights, medium, normal maps and near `emitters`;
//! `renderer` owns it all.
//! `truth` computes on the CPU, by rays, what the pass approximates.

#[cfg(all(feature = "fog", feature = "relight"))]
pub mod airs;
#[cfg(feature = "relight")]
pub mod average;
pub mod ball;
#[cfg(all(feature = "fog", feature = "relight"))]
pub mod complete;
#[cfg(feature = "relight")]
pub mod counted;
#[cfg(feature = "relight")]
pub mod debug;
#[cfg(all(feature = "fog", feature = "relight"))]
pub mod depth_fog;
pub mod device;
#[cfg(feature = "relight")]
pub mod draw;
#[cfg(all(feature = "radiance", feature = "relight"))]
pub mod emitters;
pub mod environment_samples;
#[cfg(feature = "relight")]
pub mod filter;
#[cfg(all(feature = "fog", feature = "relight"))]
pub mod fog;
#[cfg(all(feature = "fog", feature = "relight"))]
pub mod fog_sky;
#[cfg(feature = "relight")]
pub mod frame;
pub mod holes;
#[cfg(all(feature = "normals", feature = "relight"))]
pub mod incident;
#[cfg(feature = "relight")]
pub mod kept;
#[cfg(feature = "relight")]
pub mod lighting;
#[cfg(feature = "relight")]
pub mod lights;
#[cfg(all(feature = "normals", feature = "relight"))]
pub mod mapped;
#[cfg(feature = "relight")]
pub mod moving;
#[cfg(all(feature = "radiance", feature = "relight"))]
pub mod near;
#[cfg(all(feature = "radiance", feature = "relight"))]
pub mod near_tree;
#[cfg(feature = "relight")]
pub mod over;
#[cfg(feature = "relight")]
pub mod permutations;
#[cfg(all(feature = "view", feature = "relight"))]
pub mod remake;
#[cfg(feature = "relight")]
pub mod renderer;
pub mod scene;
#[cfg(feature = "relight")]
pub mod settings;
#[cfg(feature = "relight")]
pub mod shaders;
#[cfg(all(feature = "shadow", feature = "relight"))]
pub mod shadow;
#[cfg(feature = "relight")]
pub mod skin;
#[cfg(feature = "relight")]
pub mod sky;
#[cfg(all(feature = "shadow", feature = "relight"))]
pub mod sphere_mesh;
#[cfg(all(feature = "shadow", feature = "relight"))]
pub mod spheres;
#[cfg(feature = "relight")]
pub mod split;
#[cfg(all(feature = "relight", any(feature = "fog", feature = "radiance", feature = "shadow")))]
pub mod strip;
#[cfg(feature = "relight")]
pub mod surface;
pub mod texture;
pub mod transfer;
pub mod truth;
pub mod unread;
pub mod upload;
pub mod view;
