//! What a scene holds that this host does not draw: said in a warning and in the plan, never silently dropped.

use airglow_graph::LeftOut;
use airglow_scene::{Instance, Material, Scene};

use super::lights::MAX_LIGHTS;
#[cfg(feature = "relight")]
use super::source::Source;

/// One record for each kind of content that no pass of this frame uses.
pub fn unread(scene: &Scene) -> Vec<LeftOut> {
    #[cfg(all(feature = "normals", feature = "relight"))]
    let drawn = |material: &Material| super::needed::normal_map(scene, material);
    #[cfg(not(all(feature = "normals", feature = "relight")))]
    let drawn = |_: &Material| false;
    let unread = |material: &&Material| material.normal_texture.is_some() && !drawn(material);
    let normal_textures = scene.materials.iter().filter(unread).count();
    // A room that is there says itself why it has nothing to do.
    let near = cfg!(all(feature = "radiance", feature = "relight"));
    let moving = cfg!(all(feature = "shadow", feature = "relight"));
    let is_still = |(number, instance): &(usize, &Instance)| instance.skin.is_some() && !scene.moves(*number);
    let still = scene.instances.iter().enumerate().filter(is_still).count();
    let played = scene.figures.iter().filter(|figure| figure.animation.is_some()).count();
    let unplayed = scene.animations.len().saturating_sub(played);
    let kinds = [
        (scene.lights.len().saturating_sub(MAX_LIGHTS), "further lights", "fewer lights: a draw takes 64"),
        (usize::from(scene.medium.is_some() && !cfg!(feature = "fog")), "media", "the room of the fog pass"),
        (if near { 0 } else { scene.emitters.len() }, "near emitters", "the room of the radiance pass"),
        (if moving { 0 } else { scene.blockers.len() }, "blockers", "the room of the shadow pass"),
        (normal_textures, "normal textures", "lights of the scene's own, and the room of normal maps"),
        (still, "skins (drawn in their bind pose)", "a [[figure]] of their file"),
        (unplayed, "animations", "a [[figure]] of their file"),
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

/// The same, and which rooms have nothing to do for a scene that `source` lights.
#[cfg(feature = "relight")]
pub fn of_frame(scene: &Scene, source: &Source) -> Vec<LeftOut> {
    #[cfg(feature = "radiance")]
    let idle = super::near::left_out(scene, !matches!(source, Source::Relight(_)));
    #[cfg(not(feature = "radiance"))]
    let (idle, _) = (None, source);
    unread(scene).into_iter().chain(idle).collect()
}

/// The same as [`unread`] for people.
pub fn warnings(scene: &Scene) -> impl Iterator<Item = String> {
    unread(scene).into_iter().map(|left_out| format!("left out: {}; {}", left_out.what, left_out.why))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lights_beyond_what_a_draw_takes_are_named() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/mesh/lights_room.glb");
        let mut scene = airglow_scene::load(file.as_ref()).unwrap();
        let found =
            |scene: &Scene| unread(scene).into_iter().map(|left_out| left_out.what).collect::<Vec<_>>();
        assert!(found(&scene).is_empty());
        let light = scene.lights[0].clone();
        scene.lights.resize(MAX_LIGHTS + 3, light);
        assert_eq!(found(&scene), ["3 further lights"]);
    }
}
