//! The demo host's own SPIR-V, as `cargo run -p xtask -- shaders` makes it.

#[cfg(feature = "normals")]
use super::filter::{Filter, Under};
#[cfg(feature = "normals")]
use super::scene::Look;

/// Modules by `room/entry`.
#[cfg(feature = "view")]
pub type Modules = std::collections::BTreeMap<String, Vec<u32>>;

/// Those that stand in for modules built in.
#[cfg(feature = "view")]
static REPLACED: std::sync::Mutex<Modules> = std::sync::Mutex::new(Modules::new());

/// Has these modules stand in for those of their names that are built in; returns those that did so before.
#[cfg(feature = "view")]
pub fn replace(modules: Modules) -> Modules {
    let mut replaced = REPLACED.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    std::mem::replace(&mut *replaced, modules)
}

/// The same beside those that do so already, which go on but for those of the same names.
#[cfg(feature = "view")]
pub fn replace_more(modules: Modules) -> Modules {
    let mut replaced = REPLACED.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let before = replaced.clone();
    replaced.extend(modules);
    before
}

/// The words of a module, which are built in unless others stand in for them.
#[cfg_attr(not(feature = "view"), expect(unused_variables, reason = "all are built in"))]
fn words(name: &str, built_in: &[u8]) -> Vec<u32> {
    #[cfg(feature = "view")]
    if let Some(words) = REPLACED.lock().unwrap_or_else(std::sync::PoisonError::into_inner).get(name) {
        return words.clone();
    }
    bytemuck::pod_collect_to_vec(built_in)
}

/// The words of a module in `shaders/spirv/host`, or in a room's folder.
macro_rules! module {
    ($name:literal) => {
        module!("host/", $name)
    };
    ($room:literal, $name:expr) => {
        words(
            concat!($room, $name),
            include_bytes!(concat!(
                env!("CARGO_MANIFEST_DIR"),
                "/../../shaders/spirv/",
                $room,
                $name,
                ".spv"
            )),
        )
    };
}

/// The vertex stage of the forward draw of surfaces with normal maps.
#[cfg(feature = "normals")]
pub fn mapped_vertex(relight: bool) -> Vec<u32> {
    match relight {
        false => module!("scene_vertex.HOST_LIGHTS.HOST_TANGENTS"),
        true => module!("scene_vertex.AIRGLOW_RELIGHT.HOST_LIGHTS.HOST_TANGENTS"),
    }
}

/// The same with the incident radiance of the vertices.
#[cfg(feature = "normals")]
pub fn incident_vertex() -> Vec<u32> {
    module!("scene_vertex.AIRGLOW_RELIGHT.HOST_INCIDENT.HOST_LIGHTS.HOST_TANGENTS")
}

/// The module of a fragment stage of surfaces with normal maps: in clear air or in fog, under the scene's lights or also
/// under light from all around.
#[cfg(feature = "normals")]
macro_rules! mapped {
    ($under:expr, $name:literal, $filter:literal, $layers:literal) => {
        match $under {
            Under { fogged: false, incident: false } => {
                module!("normals/", concat!("scene", $name, $filter, $layers))
            }
            Under { fogged: false, incident: true } => {
                module!("normals/", concat!("scene", $name, $filter, ".HOST_INCIDENT", $layers))
            }
            #[cfg(feature = "fog")]
            Under { fogged: true, incident: false } => {
                module!("fog/", concat!("mapped", $name, $filter, $layers))
            }
            #[cfg(feature = "fog")]
            Under { fogged: true, incident: true } => {
                module!("fog/", concat!("mapped", $name, $filter, ".HOST_INCIDENT", $layers))
            }
            #[cfg(not(feature = "fog"))]
            Under { fogged: true, .. } => Vec::new(),
        }
    };
}

/// The fragment stage of the forward draw of surfaces with normal maps.
#[cfg(feature = "normals")]
pub fn mapped_fragment(filter: Filter, look: Look, under: Under) -> Vec<u32> {
    match (filter, look) {
        (_, Look::Harmonics) => mapped!(under, "", ".harmonics", ""),
        (Filter::Lobes, Look::Quarters) => mapped!(under, "_parts", "", ""),
        (Filter::Lobes, Look::Layers(1)) => mapped!(under, "", ".lobes", ".MAPPED_LAYERS1"),
        (Filter::Lobes, Look::Layers(2)) => mapped!(under, "", ".lobes", ".MAPPED_LAYERS2"),
        (Filter::Lobes, Look::Layers(4)) => mapped!(under, "", ".lobes", ".MAPPED_LAYERS4"),
        (Filter::Lobes, _) => mapped!(under, "", ".lobes", ".MAPPED_LAYERS6"),
        (Filter::Octahedral, Look::Layers(1)) => mapped!(under, "_octahedral", "", ".MAPPED_LAYERS1"),
        (Filter::Octahedral, Look::Layers(2)) => mapped!(under, "_octahedral", "", ".MAPPED_LAYERS2"),
        (Filter::Octahedral, Look::Layers(6)) => mapped!(under, "_octahedral", "", ".MAPPED_LAYERS6"),
        (Filter::Octahedral, _) => mapped!(under, "_octahedral", "", ".MAPPED_LAYERS4"),
        (Filter::Toksvig, _) => mapped!(under, "", ".toksvig", ""),
        (Filter::Lean, _) => mapped!(under, "", ".lean", ""),
        (Filter::Mip | Filter::Harmonics, _) => mapped!(under, "", ".mip", ""),
        (Filter::Texels, _) => mapped!(under, "", ".texels", ""),
    }
}

/// The vertex stage of the forward draw; with `relight` it reads the vertex array that the pass renders to, with
/// `lights` the normals.
pub fn scene_vertex(relight: bool, lights: bool) -> Vec<u32> {
    match (relight, lights) {
        (false, false) => module!("scene_vertex"),
        (true, false) => module!("scene_vertex.AIRGLOW_RELIGHT"),
        (false, true) => module!("scene_vertex.HOST_LIGHTS"),
        (true, true) => module!("scene_vertex.AIRGLOW_RELIGHT.HOST_LIGHTS"),
    }
}

/// The fragment stage of the forward draw, without or with the scene's lights.
pub fn scene_fragment(lights: bool) -> Vec<u32> {
    if lights { module!("scene_fragment.HOST_LIGHTS") } else { module!("scene_fragment") }
}

/// The fragment stage of the forward draw with the scene's lights in fog.
#[cfg(feature = "fog")]
pub fn scene_fragment_in_fog() -> Vec<u32> {
    module!("fog/", "scene")
}

/// The fragment stage of the forward draw of the complete model, evaluated there or at the vertices.
#[cfg(feature = "fog")]
pub fn complete_fragment(vertices: bool) -> Vec<u32> {
    if vertices {
        module!("fog/", "complete.FOG_COMPLETE2")
    } else {
        module!("fog/", "complete.FOG_COMPLETE1")
    }
}

/// The vertex stage that evaluates it.
#[cfg(feature = "fog")]
pub fn complete_vertex(relight: bool) -> Vec<u32> {
    match relight {
        false => module!("fog/", "complete_vertex"),
        true => module!("fog/", "complete_vertex.AIRGLOW_RELIGHT"),
    }
}

/// The fragment stage of its airlight behind the surfaces.
#[cfg(feature = "fog")]
pub fn complete_sky() -> Vec<u32> {
    module!("fog/", "complete_sky")
}

/// The vertex stage of the background.
pub fn sky_vertex() -> Vec<u32> {
    module!("sky_vertex")
}

/// The fragment stage of the background; with `glow` seen through a medium.
pub fn sky_fragment(glow: bool) -> Vec<u32> {
    if glow { module!("sky_fragment.HOST_GLOW") } else { module!("sky_fragment") }
}

/// One triangle over a whole target.
#[cfg(feature = "fog")]
pub fn rectangle_vertex() -> Vec<u32> {
    module!("rectangle")
}

/// The fragment stage of depth fog.
#[cfg(feature = "fog")]
pub fn depth_fog_fragment() -> Vec<u32> {
    module!("depth_fog")
}

/// Vertices into the pose of their joints.
pub fn skin() -> Vec<u32> {
    module!("skin")
}

/// The vertex stage of what a window draws over its picture.
#[cfg(feature = "view")]
pub fn interface_vertex() -> Vec<u32> {
    module!("interface_vertex")
}

/// Its fragment stage.
#[cfg(feature = "view")]
pub fn interface_fragment() -> Vec<u32> {
    module!("interface_fragment")
}

/// Samples to picture.
pub fn develop() -> Vec<u32> {
    module!("develop")
}
