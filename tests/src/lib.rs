//! Test support shared by the rooms: device fixture, comparison, golden files, data; and contract tests across rooms.

/// Reflection of committed shaders.
pub mod reflect;
