//! One file for each command: its arguments, and what it does with the rooms of the library.

pub mod bake;
pub mod compare;
#[cfg(feature = "relight")]
pub mod debug;
pub mod devices;
#[cfg(feature = "relight")]
pub mod eval;
#[cfg(feature = "relight")]
pub mod explain;
#[cfg(all(feature = "relight", feature = "shadow"))]
pub mod film;
#[cfg(all(feature = "normals", feature = "relight"))]
pub mod maps;
#[cfg(all(feature = "normals", feature = "relight"))]
pub mod maps_baked;
#[cfg(feature = "relight")]
pub mod plan;
#[cfg(feature = "relight")]
pub mod render;
#[cfg(feature = "relight")]
pub mod report;
pub mod requirements;
#[cfg(all(feature = "relight", feature = "shadow"))]
pub mod spheres;
#[cfg(feature = "relight")]
pub mod stability;
#[cfg(all(feature = "view", feature = "relight"))]
pub mod view;
#[cfg(feature = "relight")]
pub mod what_if;
#[cfg(feature = "relight")]
pub mod without;
