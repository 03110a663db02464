//! What the layer over a device promises to a host, checked on one.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail the test they are called from")]

mod canaries;
mod command_state;
mod common_shaders;
mod device_contract;
mod faults;
mod health;
mod histories;
mod host_allocator;
mod instruments;
mod kit;
mod recorder;
mod vertex_array;
