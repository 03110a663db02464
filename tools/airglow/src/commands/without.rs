//! `--without`: passes that a host leaves out, of a scene and of what a plan says.

use airglow_graph::LeftOut;
use airglow_scene::Scene;
use clap::{Args, ValueEnum};

#[cfg(feature = "normals")]
use crate::host::mapped;
use crate::host::renderer::Renderer;
#[cfg(feature = "shadow")]
use crate::host::shadow;
#[cfg(feature = "radiance")]
use crate::host::{emitters, near};

/// What is left out of a frame.
#[derive(Clone, Debug, Default, Args)]
pub struct Without {
    /// Leave a pass out: the picture shows what it adds. Without relight, light comes evenly from everywhere. May be given
    /// several times.
    #[arg(long, value_enum, value_name = "PASS")]
    pub without: Vec<PassName>,
}

/// Passes that a host can leave out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PassName {
    /// Relighting by precomputed radiance transfer.
    Relight,
    /// Scattering in the scene's medium; without it the air is clear.
    Fog,
    /// Soft shadows of what moves; without it figures cast none.
    Shadow,
    /// Light of near emitters; without it they are not there.
    Radiance,
    /// Normal maps; without it surfaces are as smooth as their meshes.
    Normals,
}

impl Without {
    /// Whether a pass is left out.
    pub fn has(&self, pass: PassName) -> bool {
        self.without.contains(&pass)
    }

    /// What the passes that stay need of a scene.
    #[cfg_attr(
        not(any(feature = "fog", feature = "shadow", feature = "radiance", feature = "normals")),
        expect(unused_mut, reason = "the passes that stay need all of it")
    )]
    pub fn scene(&self, mut scene: Scene) -> Scene {
        #[cfg(feature = "fog")]
        if self.has(PassName::Fog) {
            scene.medium = None;
        }
        #[cfg(feature = "shadow")]
        if self.has(PassName::Shadow) {
            scene = shadow::without(scene);
        }
        #[cfg(feature = "radiance")]
        if self.has(PassName::Radiance) {
            emitters::remove(&mut scene);
        }
        #[cfg(feature = "normals")]
        if self.has(PassName::Normals) {
            scene.materials.iter_mut().for_each(|material| material.normal_texture = None);
        }
        scene
    }

    /// Has plans say that it was the host who left passes out of `whole`.
    pub fn say(&self, renderer: &mut Renderer<'_>, whole: &Scene) {
        let mut say = |pass: PassName, what: &str, there: bool, bytes: u64| {
            if self.has(pass) && there {
                renderer.say_left_out(LeftOut {
                    what: what.to_owned(),
                    why: format!("the host was asked to leave it out (--without {what})"),
                    bytes,
                    time: None,
                    would_return: format!("a frame without --without {what}"),
                });
            }
        };
        #[cfg(feature = "fog")]
        say(PassName::Fog, "fog", whole.medium.is_some(), 0);
        #[cfg(feature = "radiance")]
        say(PassName::Radiance, "radiance", near::bytes(whole) > 0, near::bytes(whole));
        #[cfg(feature = "normals")]
        say(PassName::Normals, "normals", mapped::bytes(whole) > 0, mapped::bytes(whole));
        #[cfg(not(any(feature = "fog", feature = "radiance", feature = "normals")))]
        let _ = (&mut say, whole);
    }
}
