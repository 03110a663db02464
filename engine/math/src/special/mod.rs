//! Special functions: the exponential integral, scaled and in the complex plane.

mod exponential_integral;

pub use exponential_integral::{Scaled, exponential_integral, scaled_exponential_integral};
