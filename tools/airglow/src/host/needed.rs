//! What of a scene each pass has to do, decided from the scene alone: what nothing needs is not made.

#[cfg(feature = "radiance")]
use airglow_scene::Emitter;
use airglow_scene::Scene;
#[cfg(feature = "normals")]
use airglow_scene::{Material, MaterialClass};

/// Bands that samples of near emitters can have.
#[cfg(feature = "radiance")]
pub const NEAR_ORDERS: std::ops::RangeInclusive<u32> = 3..=6;

/// Bands that the draw of a normal map reads of each vertex.
#[cfg(feature = "normals")]
const INCIDENT_BANDS: u32 = 3;

/// Whether a scene has light for the relight pass.
pub fn relighting(scene: &Scene) -> bool {
    #[cfg(feature = "radiance")]
    let near = near_light(scene);
    #[cfg(not(feature = "radiance"))]
    let near = false;
    scene.environment.is_some() || near
}

/// Whether near emitters light a scene.
#[cfg(feature = "radiance")]
pub fn near_light(scene: &Scene) -> bool {
    glows(scene) && NEAR_ORDERS.contains(&scene.quality.order)
}

/// Whether a scene has a near emitter that gives light.
#[cfg(feature = "radiance")]
pub fn glows(scene: &Scene) -> bool {
    let glows = |emitter: &Emitter| emitter.radiance.iter().any(|x| *x > 0.0);
    scene.emitters.iter().any(glows)
}

/// Whether light from all around can be told to the normals of a scene's surfaces.
#[cfg(feature = "normals")]
pub fn incident(scene: &Scene) -> bool {
    relighting(scene) && scene.quality.order >= INCIDENT_BANDS
}

/// Whether the normal map of a material is drawn: the scene's own lights shine on it, or light from all around.
#[cfg(feature = "normals")]
pub fn normal_map(scene: &Scene, material: &Material) -> bool {
    let lit = !scene.lights.is_empty() || incident(scene);
    lit && material.class != MaterialClass::Unlit && material.normal_texture.is_some()
}

/// The same of an instance: a mesh without texture coordinates has no tangents, and nothing to look its map up by.
#[cfg(feature = "normals")]
pub fn normal_map_on(scene: &Scene, instance: usize) -> bool {
    let instance = &scene.instances[instance];
    normal_map(scene, &scene.materials[instance.material]) && !scene.meshes[instance.mesh].tangents.is_empty()
}

/// Whether that map reflects light from all around.
#[cfg(feature = "normals")]
pub fn incident_on(scene: &Scene, instance: usize) -> bool {
    incident(scene) && normal_map_on(scene, instance)
}
