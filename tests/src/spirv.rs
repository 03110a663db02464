//! Committed SPIR-V, for tests that make pipelines of it.

use crate::reflect::spirv_root;

/// The words of `shaders/spirv/<name>.spv`, such as `test/rectangle`.
///
/// # Panics
/// If there is no such module, or its length is no multiple of 4.
pub fn words(name: &str) -> Vec<u32> {
    let path = spirv_root().join(format!("{name}.spv"));
    let bytes = std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert!(bytes.len().is_multiple_of(4), "{} is cut short", path.display());
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
}
