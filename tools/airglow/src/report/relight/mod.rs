//! The report on relighting: error against time and memory for each of its knobs, and the rivals it was chosen from.

pub mod baker;
pub mod choice;
pub mod curves;
pub mod effort;
pub mod errors;
mod presets;
mod rays;
pub mod rivals;
pub mod scaling;
pub mod subset;
pub mod truth;
mod vectors;
pub mod workload;
