//! Measurements as data, and what a reader makes of them: tables, plots, fronts and comparisons.

#[cfg(feature = "relight")]
pub mod bench;
pub mod date;
#[cfg(all(feature = "fog", feature = "relight"))]
pub mod fog;
pub mod frame;
pub mod html;
pub mod interleave;
pub mod labels;
pub mod lines;
pub mod model;
#[cfg(all(feature = "normals", feature = "relight"))]
pub mod normals;
pub mod pareto;
#[cfg(feature = "relight")]
pub mod pass;
pub mod plot;
pub mod presets;
#[cfg(all(feature = "radiance", feature = "relight"))]
pub mod radiance;
pub mod ranking;
#[cfg(feature = "relight")]
pub mod relight;
#[cfg(all(feature = "relight", feature = "shadow"))]
pub mod shadow;
#[cfg(all(feature = "relight", feature = "shadow"))]
pub mod steadiness;
pub mod sweep;
pub mod table;
#[cfg(all(any(feature = "fog", feature = "normals", feature = "radiance"), feature = "relight"))]
pub mod timed_plan;
pub mod write;
