//! Orders of spherical harmonics, which are numbers of bands.

/// The largest supported order (number of bands): bands 0 to 7, 64 coefficients.
pub const MAX_ORDER: usize = 8;

/// Number of coefficients of an order: `order²`.
#[must_use]
pub const fn coefficient_count(order: usize) -> usize {
    order * order
}
