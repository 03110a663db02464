//! The orders this room has tables and kernels for.

use crate::ShadowError;

/// The fewest bands.
pub const MIN_ORDER: usize = 3;
/// The most bands.
pub const MAX_ORDER: usize = 6;

/// Accepts [`MIN_ORDER`] to [`MAX_ORDER`].
///
/// # Errors
/// [`ShadowError::Order`].
pub fn check_order(order: usize) -> Result<(), ShadowError> {
    if (MIN_ORDER..=MAX_ORDER).contains(&order) { Ok(()) } else { Err(ShadowError::Order { order }) }
}
