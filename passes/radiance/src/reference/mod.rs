//! Incident radiance in f64: what everything else is measured against.

mod cube;
mod polygon;
mod sphere;
#[cfg(test)]
mod tests;

pub use cube::Cube;
pub use polygon::{polygon, triangles};
pub use sphere::sphere;
