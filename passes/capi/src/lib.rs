//! airglow for hosts in C and C++: opaque handles, size-versioned structures, one generated header.
//!
//! `include/airglow.h` is made from this source by `cargo run -p xtask -- header`; its comments are the documentation.
//! Every exported function checks what it is given as far as a pointer can be checked, catches panics, and says what
//! went wrong in the caller's [`AirglowError`](status::AirglowError).
#![deny(clippy::missing_safety_doc, clippy::undocumented_unsafe_blocks)]

pub mod access;
pub mod allocator;
pub mod bake;
pub mod binding;
#[cfg(any(test, feature = "conformance"))]
mod checks;
#[cfg(any(test, feature = "conformance"))]
pub mod conformance;
pub mod context;
#[cfg(feature = "fog")]
pub mod fog;
pub mod health;
mod input;
pub mod needs;
#[cfg(feature = "normals")]
pub mod normals;
mod pass;
pub mod physical;
pub mod plan;
pub mod prepared;
#[cfg(feature = "radiance")]
pub mod radiance;
#[cfg(feature = "relight")]
pub mod relight;
pub mod requirements;
#[cfg(feature = "shadow")]
pub mod shadow;
pub mod status;
#[cfg(test)]
mod testing;
pub mod text;
#[cfg(any(test, feature = "conformance"))]
mod through_c;
pub mod world;

/// The version of the library: major in the highest 10 bits, minor in the next 10, patch in the lowest 12.
#[unsafe(no_mangle)]
pub extern "C" fn airglow_version() -> u32 {
    let number = |text: &str| text.parse::<u32>().unwrap_or_default();
    number(env!("CARGO_PKG_VERSION_MAJOR")) << 22
        | number(env!("CARGO_PKG_VERSION_MINOR")) << 12
        | number(env!("CARGO_PKG_VERSION_PATCH"))
}
