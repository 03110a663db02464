//! What passes do and take: counts beside times, what measuring costs, and all of it on a time line.

pub mod health;
#[cfg(feature = "fog")]
pub mod lights;
#[cfg(all(feature = "radiance", feature = "relight"))]
pub mod near;
pub mod pass;
pub mod profiler;
#[cfg(feature = "shadow")]
pub mod shadow;
pub mod stat;
pub mod trace;
