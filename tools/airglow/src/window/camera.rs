//! The camera that mouse and keys move: around the scene, or through it.

use std::f32::consts::FRAC_PI_2;

use airglow_scene::{Camera, Projection};
use glam::{Mat4, Quat, Vec3};

/// Radians that a pixel of dragging turns.
const PER_PIXEL: f32 = 0.008;
/// Factor of the distance for a notch of the wheel.
const PER_NOTCH: f32 = 0.9;
/// The least and the greatest distance, in those of the start.
const DISTANCES: [f32; 2] = [0.1, 8.0];
/// The camera stays so far from looking straight up or down, radians.
const POLES: f32 = 0.05;
/// Distances of the start that are flown in a second.
const SPEED: f32 = 0.4;

/// A camera and where it started.
#[derive(Clone, Debug)]
pub struct Rig {
    home: Camera,
    center: Vec3,
    /// From where it starts to what it looks at.
    distance: f32,
    moved: Moved,
}

/// How it has moved; the default is the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Moved {
    /// About the vertical axis, radians.
    azimuth: f32,
    /// Above where it started, radians.
    elevation: f32,
    /// What it goes around, from where that was.
    offset: Vec3,
    /// Notches of the wheel, positive towards that.
    notches: f32,
}

impl Rig {
    /// A camera that starts as `home`, before a scene whose middle is `center`.
    pub fn new(home: Camera, center: Vec3) -> Self {
        let ahead = (center - home.position()).dot(home.direction());
        Self { home, center, distance: ahead.max(0.1), moved: Moved::default() }
    }

    /// Back to the start.
    pub fn reset(&mut self) {
        self.moved = Moved::default();
    }

    /// Goes around what it looks at, as the mouse was dragged by so many pixels, right and down.
    pub fn orbit(&mut self, [right, down]: [f32; 2]) {
        let above = (-self.home.direction().y).clamp(-1.0, 1.0).asin();
        let most = FRAC_PI_2 - POLES;
        let moved = &mut self.moved;
        moved.azimuth -= right * PER_PIXEL;
        let elevation = moved.elevation + down * PER_PIXEL;
        moved.elevation = elevation.clamp((-most - above).min(0.0), (most - above).max(0.0));
    }

    /// Looks around from where it stands.
    pub fn look(&mut self, dragged: [f32; 2]) {
        let before = self.camera().position();
        self.orbit(dragged);
        self.moved.offset += before - self.camera().position();
    }

    /// Moves by so many pixels to the right and down with what it looks at, as if that was dragged.
    pub fn pan(&mut self, [right, down]: [f32; 2], height: f32) {
        let camera = self.camera();
        let span = match camera.projection {
            Projection::Perspective { vertical_angle, .. } => {
                2.0 * self.reach() * (0.5 * vertical_angle).tan()
            }
            Projection::Orthographic { half_height, .. } => 2.0 * half_height,
        };
        let pixel = span / height.max(1.0);
        let axis = |column: glam::Vec4| column.truncate().normalize_or_zero();
        let (x, y) = (axis(camera.transform.x_axis), axis(camera.transform.y_axis));
        self.moved.offset += pixel * (down * y - right * x);
    }

    /// Flies for so many seconds: right, up and ahead, each from -1 to 1; `fast` 4 times as fast.
    pub fn fly(&mut self, [right, up, ahead]: [f32; 3], fast: bool, seconds: f32) {
        let camera = self.camera();
        let speed = self.distance * SPEED * if fast { 4.0 } else { 1.0 };
        let sideways = camera.transform.x_axis.truncate().normalize_or_zero();
        let way = right * sideways + up * Vec3::Y + ahead * camera.direction();
        self.moved.offset += speed * seconds * way.clamp_length_max(1.0);
    }

    /// The wheel was turned by so many notches towards the scene.
    pub fn zoom(&mut self, notches: f32) {
        let [nearest, farthest] = DISTANCES.map(|distance| distance.ln() / PER_NOTCH.ln());
        self.moved.notches = (self.moved.notches + notches).clamp(farthest, nearest);
    }

    /// From the camera to what it goes around, metres.
    fn reach(&self) -> f32 {
        self.distance * PER_NOTCH.powf(self.moved.notches)
    }

    /// Where the camera is now.
    pub fn camera(&self) -> Camera {
        let (home, moved) = (&self.home, &self.moved);
        if *moved == Moved::default() {
            return home.clone();
        }
        let (scale, rotation, from) = home.transform.to_scale_rotation_translation();
        let pivot = from + self.distance * home.direction();
        let orbit = Quat::from_rotation_y(moved.azimuth)
            * Quat::from_axis_angle(home.transform.x_axis.truncate().normalize(), -moved.elevation);
        let nearer = PER_NOTCH.powf(moved.notches);
        let position = pivot + moved.offset + orbit * (from - pivot) * nearer;
        // Flying through the scene needs a near plane that does not cut it open.
        let apart = position.distance(self.center) / from.distance(self.center).max(1e-6);
        Camera {
            transform: Mat4::from_scale_rotation_translation(scale, orbit * rotation, position),
            projection: zoomed(home.projection, nearer, apart),
            ..home.clone()
        }
    }
}

/// A projection that still holds the scene from elsewhere; parallel rays show it larger or smaller.
fn zoomed(projection: Projection, nearer: f32, apart: f32) -> Projection {
    let (closest, farthest) = (nearer.min(apart).clamp(0.02, 1.0), nearer.max(apart).max(1.0));
    match projection {
        Projection::Perspective { vertical_angle, near, far, aspect } => Projection::Perspective {
            vertical_angle,
            near: near * closest,
            far: far.map(|far| far * farthest),
            aspect,
        },
        Projection::Orthographic { half_width, half_height, near, far } => Projection::Orthographic {
            half_width: half_width * nearer,
            half_height: half_height * nearer,
            near: near * closest,
            far: far * farthest,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use airglow_scene::Sphere;

    const CENTER: Vec3 = Vec3::new(1.0, 2.0, 3.0);

    fn rig() -> Rig {
        Rig::new(Camera::framing(Sphere { center: CENTER.to_array(), radius: 1.5 }), CENTER)
    }

    #[test]
    fn the_camera_stays_on_its_orbit_and_looks_at_the_scene() {
        let mut rig = rig();
        let home = rig.home.clone();
        assert_eq!(rig.camera(), home, "nothing was moved");
        let distance = home.position().distance(CENTER);
        for dragged in [[100.0, 0.0], [-30.0, 70.0], [0.0, 1e4], [11.0, -1e5]] {
            rig.orbit(dragged);
            let camera = rig.camera();
            let found = camera.position().distance(CENTER);
            assert!((found - distance).abs() < 1e-4 * distance, "distance {found} instead of {distance}");
            let ahead = camera.direction().dot((CENTER - camera.position()).normalize());
            assert!(ahead > 1.0 - 1e-5, "the cosine to the scene is {ahead}");
            let (up, side) = (camera.transform.y_axis.y, camera.transform.x_axis.y);
            assert!(up > 0.0 && side.abs() < 1e-5, "up has y {up}, right has y {side}");
        }
        rig.reset();
        assert_eq!(rig.camera(), home);
    }

    #[test]
    fn dragging_right_shows_the_scene_from_its_left() {
        let mut rig = rig();
        let home = rig.home.clone();
        rig.orbit([10.0, 0.0]);
        let moved = rig.camera().position() - home.position();
        let along = moved.dot(home.transform.x_axis.truncate());
        assert!(along < 0.0, "the camera moved {along} m to the right");
        rig.reset();
        rig.orbit([0.0, 10.0]);
        let moved = rig.camera().position() - home.position();
        assert!(moved.y > 0.0, "dragging down raised the camera by {} m", moved.y);
    }

    #[test]
    fn the_wheel_keeps_within_reach() {
        let mut rig = rig();
        let distance = rig.home.position().distance(CENTER);
        for (notches, expected) in [(1.0, 0.9), (1e6, DISTANCES[0]), (-1e6, DISTANCES[1])] {
            rig.zoom(notches);
            let found = rig.camera().position().distance(CENTER) / distance;
            assert!((found / expected - 1.0).abs() < 1e-4, "{found} instead of {expected}");
        }
    }

    #[test]
    fn flying_goes_where_the_camera_looks_and_looking_around_stays() {
        let mut rig = rig();
        let start = rig.camera();
        rig.fly([0.0, 0.0, 1.0], false, 1.0);
        let flown = rig.camera().position() - start.position();
        let expected = SPEED * rig.distance * start.direction();
        assert!(flown.abs_diff_eq(expected, 1e-4), "{flown} instead of {expected}");
        let before = rig.camera();
        rig.look([200.0, -30.0]);
        let after = rig.camera();
        let moved = after.position().distance(before.position());
        assert!(moved < 1e-4, "looking around moved the camera by {moved} m");
        assert!(after.direction().dot(before.direction()) < 0.9);
    }

    #[test]
    fn panning_drags_what_is_in_the_middle() {
        let mut rig = rig();
        let height = 480.0;
        rig.pan([60.0, -25.0], height);
        let camera = rig.camera();
        let clip = camera.clip_from_view(1.0) * camera.view() * CENTER.extend(1.0);
        let pixels = [0.5 * height * clip.x / clip.w, 0.5 * height * clip.y / clip.w];
        assert!((pixels[0] - 60.0).abs() < 0.1 && (pixels[1] + 25.0).abs() < 0.1, "{pixels:?}");
    }
}
