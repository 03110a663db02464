//! Files as they come: sound, unusual, damaged.

#![expect(clippy::unwrap_used, clippy::panic, reason = "tests fail by panicking")]

mod assets;
mod gltf;
mod hostile;
mod images;
mod scene_file;
mod support;
