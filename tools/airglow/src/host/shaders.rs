//! The demo host's own SPIR-V, as `cargo run -p xtask -- shaders` makes it.

/// The words of a module in `shaders/spirv/host`.
macro_rules! module {
    ($name:literal) => {
        bytemuck::pod_collect_to_vec::<u8, u32>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../shaders/spirv/host/",
            $name,
            ".spv"
        )))
    };
}

/// The vertex stage of the forward draw; with `relight` it reads the vertex array that the pass renders to.
pub fn scene_vertex(relight: bool) -> Vec<u32> {
    if relight { module!("scene_vertex.AIRGLOW_RELIGHT") } else { module!("scene_vertex") }
}

/// The fragment stage of the forward draw.
pub fn scene_fragment() -> Vec<u32> {
    module!("scene_fragment")
}

/// The vertex stage of the background.
pub fn sky_vertex() -> Vec<u32> {
    module!("sky_vertex")
}

/// The fragment stage of the background.
pub fn sky_fragment() -> Vec<u32> {
    module!("sky_fragment")
}

/// Samples to picture.
pub fn develop() -> Vec<u32> {
    module!("develop")
}
