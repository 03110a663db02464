//! What a whole frame of a scene takes: every pass by preset, memory, what was left out, and how time grows with size.

pub mod page;
#[cfg(feature = "relight")]
pub mod stages;
#[cfg(feature = "relight")]
pub mod sweeps;
