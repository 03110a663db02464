//! Test support shared by the rooms: device fixture, comparison, golden files, data; and contract tests across rooms.
#![expect(clippy::panic, reason = "helpers of tests fail the test they are called from")]

pub mod chain;
pub mod colours;
pub mod compare;
pub mod conformance;
pub mod data;
pub mod device;
pub mod golden;
pub mod heap;
pub mod hosts;
pub mod narrow;
pub mod plan;
pub mod reflect;
pub mod shim;
pub mod spirv;
mod turn;
pub mod workload;
