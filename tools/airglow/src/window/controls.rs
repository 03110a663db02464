//! What mouse and keys change: the camera's orbit, the turn of the light, the exposure.

use std::f32::consts::FRAC_PI_2;

use airglow_scene::{Camera, Projection};
use glam::{DQuat, Quat, Vec3};
use winit::keyboard::{Key, NamedKey};

/// For `airglow show --help`.
pub const HELP: &str = "\
Mouse and keys:
  drag, left button     the camera goes around the scene
  drag, right button    the light turns
  wheel                 nearer, farther
  Space                 stop and go on turning the light
  r f                   the relight pass, the fog pass on or off
  + -                   exposure, half a stop up or down
  Home                  everything as at the start
  Escape q              quit";

/// Radians that a pixel of dragging turns.
const PER_PIXEL: f32 = 0.008;
/// Factor of the distance for a notch of the wheel.
const PER_NOTCH: f32 = 0.9;
/// The least and the greatest distance, in those of the start.
const DISTANCES: [f32; 2] = [0.1, 8.0];
/// The camera stays so far from looking straight up or down, radians.
const POLES: f32 = 0.05;

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
    /// Back to the start.
    Home,
}

impl Action {
    /// The meaning of a key.
    pub fn of(key: &Key) -> Option<Self> {
        match key.as_ref() {
            Key::Named(NamedKey::Escape) | Key::Character("q") => Some(Self::Quit),
            Key::Named(NamedKey::Space) => Some(Self::Pause),
            Key::Named(NamedKey::Home) => Some(Self::Home),
            Key::Character("r") => Some(Self::Relight),
            Key::Character("f") => Some(Self::Fog),
            Key::Character("+" | "=") => Some(Self::Brighter),
            Key::Character("-") => Some(Self::Darker),
            _ => None,
        }
    }
}

/// What a drag moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drag {
    /// The camera around the scene.
    Camera,
    /// The light about the vertical axis.
    Light,
}

/// The state that input leaves; the default is the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Controls {
    /// Of the camera about the vertical axis through the scene, radians.
    azimuth: f32,
    /// Of the camera above where it started, radians.
    elevation: f32,
    /// Notches of the wheel, positive towards the scene.
    notches: f32,
    /// Of the light about the vertical axis, radians.
    turn: f64,
    /// Exposure in half stops.
    half_stops: i8,
    /// Whether the light stands still.
    pub paused: bool,
    /// Whether the relight pass is left out.
    pub without_relight: bool,
    /// Whether the fog pass is left out.
    pub without_fog: bool,
}

impl Controls {
    /// Does what a key asks for, but for quitting.
    pub fn act(&mut self, action: Action) {
        match action {
            Action::Quit => {}
            Action::Pause => self.paused = !self.paused,
            Action::Relight => self.without_relight = !self.without_relight,
            Action::Fog => self.without_fog = !self.without_fog,
            Action::Brighter => self.half_stops = (self.half_stops + 1).min(40),
            Action::Darker => self.half_stops = (self.half_stops - 1).max(-40),
            Action::Home => *self = Self { paused: self.paused, ..Self::default() },
        }
    }

    /// The mouse was dragged by so many pixels, right and down.
    pub fn drag(&mut self, drag: Drag, [right, down]: [f32; 2]) {
        match drag {
            Drag::Camera => {
                self.azimuth -= right * PER_PIXEL;
                self.elevation += down * PER_PIXEL;
            }
            Drag::Light => self.turn += f64::from(right * PER_PIXEL),
        }
    }

    /// The wheel was turned by so many notches towards the scene.
    pub fn zoom(&mut self, notches: f32) {
        let [nearest, farthest] = DISTANCES.map(|distance| distance.ln() / PER_NOTCH.ln());
        self.notches = (self.notches + notches).clamp(farthest, nearest);
    }

    /// Time goes by: the light turns by `angle` radians unless it is paused.
    pub fn advance(&mut self, angle: f64) {
        if !self.paused {
            self.turn += angle;
        }
    }

    /// What turns the environment on top of the scene's own rotation.
    pub fn turn(&self) -> DQuat {
        DQuat::from_rotation_y(self.turn)
    }

    /// Factor of the exposure.
    pub fn exposure(&self) -> f32 {
        (0.5 * f32::from(self.half_stops)).exp2()
    }

    /// Where the camera that started as `home` is now: on its orbit around the point before it that is next to
    /// `center`. Elevations beyond the poles are cut here and in the state.
    pub fn camera(&mut self, home: &Camera, center: Vec3) -> Camera {
        let above = (-home.direction().y).clamp(-1.0, 1.0).asin();
        let most = FRAC_PI_2 - POLES;
        self.elevation = self.elevation.clamp((-most - above).min(0.0), (most - above).max(0.0));
        if (self.azimuth, self.elevation, self.notches) == (0.0, 0.0, 0.0) {
            return home.clone();
        }
        let ahead = (center - home.position()).dot(home.direction());
        let pivot = home.position() + home.direction() * ahead.max(0.0);
        let (scale, rotation, from) = home.transform.to_scale_rotation_translation();
        let orbit = Quat::from_rotation_y(self.azimuth)
            * Quat::from_axis_angle(home.transform.x_axis.truncate().normalize(), -self.elevation);
        let distance = PER_NOTCH.powf(self.notches);
        let position = pivot + orbit * (from - pivot) * distance;
        Camera {
            transform: glam::Mat4::from_scale_rotation_translation(scale, orbit * rotation, position),
            projection: zoomed(home.projection, distance),
            ..home.clone()
        }
    }
}

/// A projection that still holds the scene at another distance; parallel rays show it larger or smaller.
fn zoomed(projection: Projection, distance: f32) -> Projection {
    let (nearer, farther) = (distance.min(1.0), distance.max(1.0));
    match projection {
        Projection::Perspective { vertical_angle, near, far, aspect } => Projection::Perspective {
            vertical_angle,
            near: near * nearer,
            far: far.map(|far| far * farther),
            aspect,
        },
        Projection::Orthographic { half_width, half_height, near, far } => Projection::Orthographic {
            half_width: half_width * distance,
            half_height: half_height * distance,
            near: near * nearer,
            far: far * farther,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use airglow_scene::Sphere;

    const CENTER: Vec3 = Vec3::new(1.0, 2.0, 3.0);

    fn home() -> Camera {
        Camera::framing(Sphere { center: CENTER.to_array(), radius: 1.5 })
    }

    #[test]
    fn the_camera_stays_on_its_orbit_and_looks_at_the_scene() {
        let (home, mut controls) = (home(), Controls::default());
        assert_eq!(controls.camera(&home, CENTER), home, "nothing was moved");
        let distance = home.position().distance(CENTER);
        for [right, down] in [[100.0, 0.0], [-30.0, 70.0], [0.0, 1e4], [11.0, -1e5]] {
            controls.drag(Drag::Camera, [right, down]);
            let camera = controls.camera(&home, CENTER);
            let found = camera.position().distance(CENTER);
            assert!((found - distance).abs() < 1e-4 * distance, "distance {found} instead of {distance}");
            let ahead = camera.direction().dot((CENTER - camera.position()).normalize());
            assert!(ahead > 1.0 - 1e-5, "the cosine to the scene is {ahead}");
            let (up, side) = (camera.transform.y_axis.y, camera.transform.x_axis.y);
            assert!(up > 0.0 && side.abs() < 1e-5, "up has y {up}, right has y {side}");
        }
        controls.act(Action::Home);
        assert_eq!(controls.camera(&home, CENTER), home);
    }

    #[test]
    fn dragging_right_shows_the_scene_from_its_left() {
        let (home, mut controls) = (home(), Controls::default());
        controls.drag(Drag::Camera, [10.0, 0.0]);
        let moved = controls.camera(&home, CENTER).position() - home.position();
        let along = moved.dot(home.transform.x_axis.truncate());
        assert!(along < 0.0, "the camera moved {along} m to the right");
        controls.act(Action::Home);
        controls.drag(Drag::Camera, [0.0, 10.0]);
        let moved = controls.camera(&home, CENTER).position() - home.position();
        assert!(moved.y > 0.0, "dragging down raised the camera by {} m", moved.y);
    }

    #[test]
    fn the_wheel_keeps_within_reach() {
        let (home, mut controls) = (home(), Controls::default());
        let distance = home.position().distance(CENTER);
        for (notches, expected) in [(1.0, 0.9), (1e6, DISTANCES[0]), (-1e6, DISTANCES[1])] {
            controls.zoom(notches);
            let found = controls.camera(&home, CENTER).position().distance(CENTER) / distance;
            assert!((found / expected - 1.0).abs() < 1e-4, "{found} instead of {expected}");
        }
    }

    #[test]
    fn the_light_turns_unless_it_is_paused() {
        let mut controls = Controls::default();
        controls.advance(0.5);
        controls.act(Action::Pause);
        controls.advance(0.5);
        assert_eq!(controls.turn(), DQuat::from_rotation_y(0.5));
        controls.act(Action::Brighter);
        controls.act(Action::Brighter);
        assert_eq!(controls.exposure(), 2.0);
        assert_eq!(Action::of(&Key::Character("+".into())), Some(Action::Brighter));
        assert_eq!(Action::of(&Key::Character("x".into())), None);
    }
}
