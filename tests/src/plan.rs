//! Compiling as every test does: with the independent checker looking at the plan.

pub use airglow_conformance::plan::{compile, compile_with};
