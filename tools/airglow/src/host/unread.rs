//! What a scene holds that this host does not draw: said in a warning and in the plan, never silently dropped.

use airglow_graph::LeftOut;
use airglow_scene::Scene;

/// One record for each kind of content that no pass of this frame uses.
pub fn unread(scene: &Scene) -> Vec<LeftOut> {
    let normal_textures = scene.materials.iter().filter(|material| material.normal_texture.is_some()).count();
    let kinds = [
        (scene.lights.len(), "point, spot and directional lights", "a pass that lights by them"),
        (usize::from(scene.medium.is_some()), "media", "a pass that draws fog"),
        (scene.emitters.len(), "near emitters", "a pass that samples their radiance"),
        (scene.blockers.len(), "blockers", "a pass that casts their shadows"),
        (normal_textures, "normal textures", "a pass that filters and shades them"),
        (scene.skins.len(), "skins (drawn in their bind pose)", "a host that moves their vertices"),
        (scene.animations.len(), "animations", "a host that plays them"),
    ];
    let present = kinds.into_iter().filter(|(count, ..)| *count > 0);
    present
        .map(|(count, what, would_return)| LeftOut {
            what: format!("{count} {what}"),
            why: "no pass of this frame uses them".to_owned(),
            bytes: 0,
            time: None,
            would_return: would_return.to_owned(),
        })
        .collect()
}

/// The same for people.
pub fn warnings(scene: &Scene) -> impl Iterator<Item = String> {
    unread(scene).into_iter().map(|left_out| format!("left out: {}; {}", left_out.what, left_out.why))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lights_of_a_file_are_named() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/mesh/lights_room.glb");
        let scene = airglow_scene::load(file.as_ref()).unwrap();
        let found: Vec<String> = unread(&scene).into_iter().map(|left_out| left_out.what).collect();
        assert_eq!(found, ["3 point, spot and directional lights"]);
    }
}
