//! What decides which shaders the passes of a frame have: the same words, the same permutations.

use std::collections::BTreeMap;

#[cfg(feature = "fog")]
use airglow_gpu::ash::vk;
use airglow_scene::Scene;

use super::relight;

/// The settings of every pass that has a step among `steps`, by the name of its room; and what the host's own draw is made for.
pub fn of_frame(scene: &Scene, steps: &[&str]) -> BTreeMap<&'static str, String> {
    let mut all = BTreeMap::from([("relight", format!("{:?}", relight::settings(scene)))]);
    #[cfg(feature = "fog")]
    all.insert("fog", format!("{:?}", super::fog::settings(scene, vk::Format::R32G32B32A32_SFLOAT)));
    #[cfg(feature = "radiance")]
    all.insert("radiance", format!("{:?}", super::near::settings(scene)));
    #[cfg(feature = "shadow")]
    all.insert("shadow", format!("{:?}", super::shadow::settings(scene)));
    all.retain(|room, _| steps.iter().any(|step| step.split(' ').next() == Some(room)));
    all.insert("scene draw", draw(scene, all.contains_key("relight")));
    all
}

/// Whether surfaces have light of their vertices, lights, a medium's light, and how many materials have a normal map.
fn draw(scene: &Scene, relit: bool) -> String {
    #[cfg(feature = "normals")]
    let maps = scene.materials.iter().filter(|material| super::needed::normal_map(scene, material)).count();
    #[cfg(not(feature = "normals"))]
    let maps = 0;
    let (lights, medium) = (!scene.lights.is_empty(), scene.medium.is_some());
    format!("relit: {relit}, lights: {lights}, in a medium: {medium}, materials with maps: {maps}")
}
