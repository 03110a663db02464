//! Debug views: what passes hold and decide, drawn over the scene in false colours.
//!
//! A view has a value for each vertex or pixel. It is read back from the passes themselves or computed from what they read
//! back, and drawn by the host's own draw in a frame of its own, so that a frame without a debug view has nothing of it.

mod canvas;
#[cfg(feature = "fog")]
mod fog;
#[cfg(feature = "normals")]
mod normals;
mod probe;
#[cfg(feature = "radiance")]
mod radiance;
mod relight;
#[cfg(feature = "shadow")]
mod shadow;

use airglow_scene::Scene;

use super::device::Device;
use super::renderer::Renderer;
use super::settings::Settings;
use super::source::Source;
use crate::compare::legend::Values;
use crate::failure::{Failure, Outcome};

/// A debug view.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// The room, a hyphen, and what is shown.
    pub name: &'static str,
    /// In words, with the unit, for the legend.
    pub title: &'static str,
    /// The value of the brightest colour; `None` for the largest in the picture.
    pub high: Option<f32>,
}

/// All views of the rooms that are there.
pub fn views() -> Vec<View> {
    #[cfg_attr(
        not(any(feature = "fog", feature = "normals", feature = "radiance", feature = "shadow")),
        expect(unused_mut, reason = "other rooms add to it")
    )]
    let mut views: Vec<View> = relight::VIEWS.into();
    #[cfg(feature = "fog")]
    views.extend(fog::VIEWS);
    #[cfg(feature = "radiance")]
    views.extend(radiance::VIEWS);
    #[cfg(feature = "normals")]
    views.extend(normals::VIEWS);
    #[cfg(feature = "shadow")]
    views.extend(shadow::VIEWS);
    views
}

/// What views are drawn from.
struct Shown<'a> {
    device: &'a Device<'a>,
    scene: &'a Scene,
    source: &'a Source,
    settings: Settings,
}

/// The values of a view of a scene.
pub fn values(
    view: &View,
    device: &Device<'_>,
    scene: &Scene,
    source: &Source,
    settings: Settings,
) -> Outcome<Values> {
    let shown = Shown { device, scene, source, settings };
    match view.name.split('-').next() {
        Some("relight") => relight::values(&shown, view.name),
        #[cfg(feature = "fog")]
        Some("fog") => fog::values(&shown, view.name),
        #[cfg(feature = "radiance")]
        Some("radiance") => radiance::values(&shown, view.name),
        #[cfg(feature = "normals")]
        Some("normals") => normals::values(&shown, view.name),
        #[cfg(feature = "shadow")]
        Some("shadow") => shadow::values(&shown, view.name),
        _ => Err(Failure::usage(format!("there is no view {}", view.name))),
    }
}

impl<'a> Shown<'a> {
    /// The renderer of the scene itself.
    fn renderer(&self) -> Outcome<Renderer<'a>> {
        Renderer::new(self.device, self.scene, self.source, self.settings.size)
    }
}
