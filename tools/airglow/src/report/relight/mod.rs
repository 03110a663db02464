//! The report on relighting: error against time and memory for each of its knobs, and the rivals it was chosen from.

pub mod curves;
pub mod errors;
pub mod rivals;
pub mod workload;
