//! How two images differ: error statistics, the perceived difference (FLIP), and a signed-difference picture.

pub mod difference;
pub mod flip;
pub mod glyphs;
pub mod legend;
pub mod picture;
pub mod statistics;

#[cfg(test)]
mod flip_tests;
