//! Real orthonormal spherical harmonics up to order [`MAX_ORDER`]: evaluation, projection, zonal kernels,
//! rotation and products.

mod basis;
pub mod product;
mod projection;
pub mod rotation;
pub mod zonal;

pub use basis::{evaluate, evaluate_f32};
pub use projection::{project, project_samples, reconstruct};

pub use crate::order::{MAX_ORDER, coefficient_count};

use crate::MathError;

/// Position `l(l+1)+m` of band `l`, degree `m` in a coefficient array; meant for `|m| <= l`.
#[must_use]
pub const fn index(l: usize, m: isize) -> usize {
    (l * (l + 1)).saturating_add_signed(m)
}

/// Accepts orders 1 to [`MAX_ORDER`].
///
/// # Errors
/// [`MathError::Order`] for any other.
pub const fn check_order(order: usize) -> Result<(), MathError> {
    if order >= 1 && order <= MAX_ORDER { Ok(()) } else { Err(MathError::Order { order }) }
}
