//! The f64 truth of the pass: what its shaders are measured against. No GPU, no approximation but the stated.
//!
//! Everything is for a light of radiant intensity 1 W/sr and a scattering coefficient of 1/m, whose products with the
//! results are radiance, unless a function says otherwise.

pub mod airlight;
pub mod closed_form;
pub mod cone;
pub mod environment;
pub mod height;
pub mod multiple;
pub mod spread;
pub mod surface;
pub mod table;

#[cfg(test)]
mod extremes;
#[cfg(test)]
mod testing;
