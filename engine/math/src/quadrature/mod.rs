//! Numerical integration: Gauss-Legendre, a product rule on the sphere, adaptive Gauss-Kronrod.

mod gauss_legendre;
mod kronrod;

pub use gauss_legendre::{MAX_POINTS, gauss_legendre, sphere};
pub use kronrod::{Integral, adaptive};
