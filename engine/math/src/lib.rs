//! Spherical harmonics, sphere and cube maps, quadrature, sequences, error statistics and hosts' conventions; f64
//! truth and f32 use, no GPU.
//!
//! Conventions, stated once for the whole room:
//!
//! - Right-handed axes, +Y up, cameras look down -Z; angles in radians.
//! - Real orthonormal spherical harmonics, polar axis +Z, index `i = l(l+1)+m`, the Condon-Shortley factor
//!   `(-1)^m` kept for every m: `Y_1,-1 = -sqrt(3/4pi) y`, `Y_1,0 = sqrt(3/4pi) z`, `Y_1,1 = -sqrt(3/4pi) x`.
//! - "Order n" means n bands, so n² coefficients; orders 1 to [`sh::MAX_ORDER`] are accepted.
//! - A host with other axes, units or depth states them as a [`World`].
//! - Equirectangular and cube maps: see [`sphere::equirect`] and [`sphere::cube`].
//!
//! ```
//! use airglow_math::sh;
//! use glam::DVec3;
//!
//! let mut basis = [0.0; sh::coefficient_count(2)];
//! sh::evaluate(2, DVec3::Z, &mut basis)?;
//! assert!((basis[sh::index(1, 0)] - (0.75 / std::f64::consts::PI).sqrt()).abs() < 1e-15);
//! # Ok::<(), airglow_math::MathError>(())
//! ```
#![forbid(unsafe_code)]

mod axis;
mod error;
mod order;
mod preset;
pub mod quadrature;
pub mod sequence;
pub mod sh;
pub mod special;
pub mod sphere;
pub mod statistics;
#[cfg(test)]
mod testing;
pub mod world;

pub use error::MathError;
pub use preset::Preset;
pub use world::World;
