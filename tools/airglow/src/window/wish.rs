//! What of the passes' settings the panel changes.

use airglow_math::Preset;
use airglow_scene::{Quality, Scene};

use crate::scene_options::ROOMS;

/// A setting that is turned alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knob {
    /// Of which pass.
    pub room: &'static str,
    /// Its name in the reports of the pass.
    pub name: &'static str,
    /// What its values are.
    pub unit: &'static str,
}

/// The bands of light transport, which are baked anew for another number.
pub const ORDER: usize = 0;
/// Radiance below which a light is left out of a pixel of fog.
pub const FOG_BOUND: usize = 1;
/// Error of a colour that samples of near emitters aim at.
pub const RADIANCE_BOUND: usize = 2;
/// Share of the sky below which spheres are left out.
pub const REACH: usize = 3;
/// Share of the sky below which nodes stand for what they hold.
pub const CUT: usize = 4;
/// Deringing of shadows.
pub const WINDOW: usize = 5;

/// All of them.
pub const KNOBS: [Knob; 6] = [
    Knob { room: "relight", name: "order", unit: "bands" },
    Knob { room: "fog", name: "light bound", unit: "W/sr/m2" },
    Knob { room: "radiance", name: "bound", unit: "W/sr/m2" },
    Knob { room: "shadow", name: "reach", unit: "of the sky" },
    Knob { room: "shadow", name: "cut", unit: "of the sky" },
    Knob { room: "shadow", name: "window", unit: "" },
];

/// What is asked of the passes.
#[derive(Clone, Debug, PartialEq)]
pub struct Wish {
    /// Of each of [`ROOMS`]; `None` as the scene says.
    pub presets: [Option<Preset>; 5],
    /// Of each of [`KNOBS`]; `None` as the preset says.
    pub values: [Option<f64>; 6],
    /// Whether near emitters give light.
    pub radiance: bool,
    /// Whether normal maps are drawn.
    pub normals: bool,
    /// Extinction of the medium, in that of the scene.
    pub density: f32,
    /// Mean cosine of its phase function; `None` as the scene says.
    pub anisotropy: Option<f32>,
}

impl Default for Wish {
    fn default() -> Self {
        Self {
            presets: [None; 5],
            values: [None; 6],
            radiance: true,
            normals: true,
            density: 1.0,
            anisotropy: None,
        }
    }
}

/// What must be made anew for another wish.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Remade {
    /// Light transport, and all that follows from it.
    pub transport: bool,
    /// Every pass, with the transport there is.
    pub all: bool,
    /// The shadow pass.
    pub shadow: bool,
    /// The radiance pass.
    pub radiance: bool,
    /// The fog pass.
    pub fog: bool,
}

impl Wish {
    /// What another wish than `made` needs.
    pub fn remade(&self, made: &Self) -> Remade {
        let preset = |room: &str| {
            let place = ROOMS.iter().position(|name| *name == room);
            place.is_some_and(|place| self.presets[place] != made.presets[place])
        };
        let value = |knob: usize| self.values[knob] != made.values[knob];
        Remade {
            transport: preset("relight") || value(ORDER),
            all: self.radiance != made.radiance || self.normals != made.normals || preset("normals"),
            shadow: preset("shadow") || [REACH, CUT, WINDOW].into_iter().any(value),
            radiance: preset("radiance") || value(RADIANCE_BOUND),
            fog: preset("fog")
                || value(FOG_BOUND)
                || self.density != made.density
                || self.anisotropy != made.anisotropy,
        }
    }

    /// The scene as it is wished, of one as it was loaded.
    pub fn apply(&self, loaded: &Scene) -> Scene {
        let mut scene = loaded.clone();
        for (room, preset) in ROOMS.into_iter().zip(self.presets) {
            if let Some(preset) = preset {
                scene.presets.rooms.insert(room.to_owned(), preset);
            }
        }
        if let Some(preset) = self.preset("relight") {
            scene.quality = Quality { shadow: scene.quality.shadow, ..preset.into() };
        }
        if let Some(order) = self.values[ORDER] {
            scene.quality.order = order as u32;
        }
        if !self.radiance {
            scene.emitters.iter_mut().for_each(|emitter| emitter.radiance = [0.0; 3]);
        }
        if !self.normals {
            scene.materials.iter_mut().for_each(|material| material.normal_texture = None);
        }
        if let Some(medium) = &mut scene.medium {
            medium.extinction = medium.extinction.map(|extinction| extinction * self.density);
            medium.anisotropy = self.anisotropy.unwrap_or(medium.anisotropy);
        }
        scene
    }

    /// What is asked of a room.
    pub fn preset(&self, room: &str) -> Option<Preset> {
        let place = ROOMS.iter().position(|name| *name == room)?;
        self.presets[place]
    }
}

impl Remade {
    /// Whether nothing is.
    pub fn nothing(self) -> bool {
        self == Self::default()
    }

    /// In words.
    pub fn words(self) -> String {
        let parts = [
            (self.transport, "light transport"),
            (self.all, "all passes"),
            (self.shadow, "shadow"),
            (self.radiance, "radiance"),
            (self.fog, "fog"),
        ];
        let parts: Vec<&str> = parts.into_iter().filter(|(is, _)| *is).map(|(_, name)| name).collect();
        parts.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_changed_is_made_anew() {
        let made = Wish::default();
        assert!(made.remade(&made).nothing());
        let mut wish = Wish::default();
        wish.values[CUT] = Some(0.1);
        assert_eq!(wish.remade(&made), Remade { shadow: true, ..Remade::default() });
        wish.density = 2.0;
        assert_eq!(wish.remade(&made).words(), "shadow, fog");
        let mut wish = Wish::default();
        wish.presets[0] = Some(Preset::High);
        assert_eq!(wish.remade(&made), Remade { transport: true, ..Remade::default() });
        let scene = wish.apply(&Scene::default());
        assert_eq!(scene.quality.order, Preset::High.order() as u32);
    }
}
