//! The pass on a device, and what it says before there is one.

#![expect(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

mod budget;
mod envelope;
mod eval;
mod filter;
mod graph;
mod host;
mod kernels;
mod mirror;
mod normals;
mod stability;
mod vertices;
