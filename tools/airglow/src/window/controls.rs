//! What keys ask for, and the state that they, the mouse and the panel change.

use glam::DQuat;
use winit::keyboard::{Key, KeyCode, NamedKey, PhysicalKey};

/// For `airglow view --help`.
pub const HELP: &str = "\
Mouse and keys:
  drag, left button     a lamp or figure by its ring; else the camera goes around the scene, or looks around where it flies
  drag, middle button   the camera moves sideways
  drag, right button    the light turns
  wheel                 nearer, farther
  v                     around the scene, or fly: w a s d, e up, c down, shift faster
  Space                 stop and go on turning the light
  r f                   the relight pass, the fog pass on or off
  + -                   exposure, half a stop up or down
  p                     write a picture of the window
  h                     hide or show the panel
  Home                  camera, light, exposure, lamps and figures as at the start
  a file dropped        another scene (.toml, .gltf, .glb) or environment (.hdr, .exr)
  Escape                quit";

/// What a key asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// End the command.
    Quit,
    /// Stop or go on turning the light.
    Pause,
    /// Relight, or leave the pass out.
    Relight,
    /// Fog, or clear air.
    Fog,
    /// Half a stop up.
    Brighter,
    /// Half a stop down.
    Darker,
    /// Around the scene, or through it.
    Fly,
    /// Write a picture.
    Picture,
    /// Show or hide the panel.
    Panel,
    /// Back to the start.
    Home,
}

impl Action {
    /// The meaning of a key.
    pub fn of(key: &Key) -> Option<Self> {
        match key.as_ref() {
            Key::Named(NamedKey::Escape) => Some(Self::Quit),
            Key::Named(NamedKey::Space) => Some(Self::Pause),
            Key::Named(NamedKey::Home) => Some(Self::Home),
            Key::Character("r") => Some(Self::Relight),
            Key::Character("f") => Some(Self::Fog),
            Key::Character("v") => Some(Self::Fly),
            Key::Character("p") => Some(Self::Picture),
            Key::Character("h") => Some(Self::Panel),
            Key::Character("+" | "=") => Some(Self::Brighter),
            Key::Character("-") => Some(Self::Darker),
            _ => None,
        }
    }

    /// Whether it is done again and again while its key is held.
    pub fn repeats(self) -> bool {
        matches!(self, Self::Brighter | Self::Darker)
    }
}

/// Keys that are held to fly.
#[derive(Clone, Copy, Debug, Default)]
pub struct Held {
    /// Left and right, down and up, back and ahead.
    pairs: [[bool; 2]; 3],
    /// Faster.
    pub fast: bool,
}

impl Held {
    /// A key was pressed or let go.
    pub fn key(&mut self, key: PhysicalKey, held: bool) {
        let place = match key {
            PhysicalKey::Code(KeyCode::KeyA) => [0, 0],
            PhysicalKey::Code(KeyCode::KeyD) => [0, 1],
            PhysicalKey::Code(KeyCode::KeyC) => [1, 0],
            PhysicalKey::Code(KeyCode::KeyE) => [1, 1],
            PhysicalKey::Code(KeyCode::KeyS) => [2, 0],
            PhysicalKey::Code(KeyCode::KeyW) => [2, 1],
            PhysicalKey::Code(KeyCode::ShiftLeft | KeyCode::ShiftRight) => {
                self.fast = held;
                return;
            }
            _ => return,
        };
        self.pairs[place[0]][place[1]] = held;
    }

    /// Right, up and ahead, each -1, 0 or 1; `None` where nothing is held.
    pub fn way(&self) -> Option<[f32; 3]> {
        let way = self.pairs.map(|[less, more]| f32::from(i8::from(more) - i8::from(less)));
        (way != [0.0; 3]).then_some(way)
    }
}

/// What a drag moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drag {
    /// The camera, around the scene or its own axes.
    Camera,
    /// The camera, sideways.
    Pan,
    /// The light about the vertical axis.
    Light,
}

/// What keys, mouse and panel have changed; the default is the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controls {
    /// Passes that are drawn, where the scene has something for them.
    pub passes: Passes,
    /// Exposure, stops from that of the start.
    pub stops: f32,
    /// Of the light about the vertical axis, degrees.
    pub turn: f64,
    /// Degrees that it turns further in a second.
    pub spin: f64,
    /// Whether the light stands still.
    pub paused: bool,
    /// Whether the camera flies.
    pub flies: bool,
    /// Whether the panel is hidden.
    pub bare: bool,
    /// Whether figures walk.
    pub walks: bool,
    /// Seconds that they have walked.
    pub walked: f64,
    /// What is drawn over the picture.
    pub shown: Shown,
}

/// What is drawn over the picture, where the panel is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    /// What can be dragged.
    pub handles: bool,
    /// Where the radiance pass sampled.
    pub samples: bool,
    /// The spheres that cast shadows.
    pub spheres: bool,
}

/// Passes that are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Passes {
    /// Relighting; without it light comes evenly from everywhere.
    pub relight: bool,
    /// Soft shadows of what moves.
    pub shadow: bool,
    /// The medium.
    pub fog: bool,
}

impl Controls {
    /// The start, with the light turning by so many degrees in a second.
    pub fn new(spin: f64) -> Self {
        let passes = Passes { relight: true, shadow: true, fog: true };
        let shown = Shown { handles: true, samples: false, spheres: false };
        Self {
            passes,
            stops: 0.0,
            turn: 0.0,
            spin,
            paused: false,
            flies: false,
            bare: false,
            walks: true,
            walked: 0.0,
            shown,
        }
    }

    /// Does what a key asks for, where that is no more than a change of this.
    pub fn act(&mut self, action: Action) {
        match action {
            Action::Quit | Action::Picture => {}
            Action::Pause => self.paused = !self.paused,
            Action::Relight => self.passes.relight = !self.passes.relight,
            Action::Fog => self.passes.fog = !self.passes.fog,
            Action::Brighter => self.stops = (self.stops + 0.5).min(20.0),
            Action::Darker => self.stops = (self.stops - 0.5).max(-20.0),
            Action::Fly => self.flies = !self.flies,
            Action::Panel => self.bare = !self.bare,
            Action::Home => (self.stops, self.turn, self.walked) = (0.0, 0.0, 0.0),
        }
    }

    /// The light was dragged by so many pixels to the right.
    pub fn drag_light(&mut self, right: f32) {
        self.turn = wrapped(self.turn + 0.5 * f64::from(right));
    }

    /// So many seconds go by: the light turns unless it is paused, and figures walk.
    pub fn advance(&mut self, seconds: f64) {
        if self.walks {
            self.walked += seconds;
        }
        if !self.paused {
            self.turn = wrapped(self.turn + self.spin * seconds);
        }
    }

    /// What turns the environment on top of the scene's own rotation.
    pub fn rotation(&self) -> DQuat {
        DQuat::from_rotation_y(self.turn.to_radians())
    }

    /// Factor of the exposure.
    pub fn exposure(&self) -> f32 {
        self.stops.exp2()
    }
}

/// Degrees from -180 on to below 180.
fn wrapped(degrees: f64) -> f64 {
    if (-180.0..180.0).contains(&degrees) { degrees } else { (degrees + 180.0).rem_euclid(360.0) - 180.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_light_turns_unless_it_is_paused() {
        let mut controls = Controls::new(30.0);
        controls.advance(0.5);
        controls.act(Action::Pause);
        controls.advance(0.5);
        assert_eq!(controls.turn, 15.0);
        controls.act(Action::Brighter);
        controls.act(Action::Brighter);
        assert_eq!(controls.exposure(), 2.0);
        assert_eq!(Action::of(&Key::Character("+".into())), Some(Action::Brighter));
        assert_eq!(Action::of(&Key::Character("x".into())), None);
        assert_eq!([wrapped(190.0), wrapped(-180.0), wrapped(-190.0)], [-170.0, -180.0, 170.0]);
    }

    #[test]
    fn keys_that_are_held_add_up() {
        let mut held = Held::default();
        assert_eq!(held.way(), None);
        for key in [KeyCode::KeyW, KeyCode::KeyA, KeyCode::KeyD] {
            held.key(PhysicalKey::Code(key), true);
        }
        assert_eq!(held.way(), Some([0.0, 0.0, 1.0]));
        held.key(PhysicalKey::Code(KeyCode::KeyD), false);
        assert_eq!(held.way(), Some([-1.0, 0.0, 1.0]));
    }
}
