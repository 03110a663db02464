//! The first host: it opens its own device, then uses only what any engine would.
//!
//! From below: `device` opens and adopts a device; `needed` says which passes a scene has work for. `bake` computes on the
//! CPU what is computed once (`transfer`, `spheres`, `near_tree`), and `source` says what lights the vertices. `scene` and
//! `upload` bring arrays to the device, `shaders`, `surface`, `sky`, `depth_first` and `draw` hold the host's own draws. Each pass has a
//! file or two: `relight`, `incident`, `near`, `shadow`, `fog`, `mapped`; `lighting` holds those that light vertices.
//! `renderer` owns it all, `frame` declares a whole frame in one function, and `picture` compiles and draws it; `moving`,
//! `remake` and `told` change it between frames and say what passes counted. `truth` computes on the CPU, by rays, what the
//! passes approximate.

#[cfg(all(feature = "fog", feature = "relight"))]
pub mod airs;
#[cfg(feature = "relight")]
pub mod average;
pub mod bake;
pub mod ball;
#[cfg(all(feature = "fog", feature = "relight"))]
pub mod complete;
#[cfg(feature = "relight")]
pub mod counted;
#[cfg(feature = "relight")]
pub mod debug;
#[cfg(feature = "relight")]
pub mod depth_first;
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
pub mod fog_frame;
#[cfg(all(feature = "fog", feature = "relight"))]
pub mod fog_sky;
#[cfg(feature = "relight")]
pub mod formats;
#[cfg(feature = "relight")]
pub mod frame;
pub mod holes;
#[cfg(all(feature = "normals", feature = "relight"))]
pub mod incident;
#[cfg(feature = "relight")]
pub mod kept;
#[cfg(feature = "relight")]
pub mod lighting;
pub mod lights;
pub mod machine;
#[cfg(all(feature = "normals", feature = "relight"))]
pub mod mapped;
#[cfg(feature = "relight")]
pub mod moving;
#[cfg(all(feature = "radiance", feature = "relight"))]
pub mod near;
#[cfg(all(feature = "radiance", feature = "relight"))]
pub mod near_tree;
#[cfg(feature = "relight")]
pub mod needed;
#[cfg(feature = "relight")]
pub mod over;
#[cfg(feature = "relight")]
pub mod permutations;
#[cfg(feature = "relight")]
pub mod picture;
#[cfg(all(feature = "radiance", feature = "relight"))]
pub mod placed;
#[cfg(feature = "relight")]
pub mod relight;
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
#[cfg(feature = "relight")]
pub mod source;
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
#[cfg(feature = "relight")]
pub mod told;
pub mod transfer;
pub mod truth;
pub mod unread;
pub mod upload;
pub mod view;
#[cfg(feature = "relight")]
pub mod work;
