//! From where the picture is taken.

use airglow_math::World;
use glam::DVec3;

use crate::FogError;
use crate::error::check;

/// The camera of a view, in the host's axes and units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The eye.
    pub position: DVec3,
    /// Unit vector to the right of the picture.
    pub right: DVec3,
    /// Unit vector up the picture.
    pub up: DVec3,
    /// Unit vector into the picture.
    pub forward: DVec3,
    /// Left, right, lower and upper edge of the picture at distance 1, along `right` and `up`: tangents of the angles
    /// from `forward`; for an orthographic view the edges themselves. Left and lower edge of an even view are negative.
    pub edges: [f64; 4],
}

/// Start and direction of the view rays, linear in the place in the picture: at the upper left, and the change to the
/// right and to the lower edge. Airglow's axes, metres, relative to the eye.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rays {
    pub start: [DVec3; 3],
    pub direction: [DVec3; 3],
}

impl Camera {
    /// Refuses vectors that make no picture.
    pub(crate) fn check(&self) -> Result<(), FogError> {
        let named =
            [("position", self.position), ("right", self.right), ("up", self.up), ("forward", self.forward)];
        for (name, vector) in named {
            let worst = vector.to_array().into_iter().find(|x| !x.is_finite()).unwrap_or(0.0);
            check(|| format!("camera.{name}"), worst, worst.is_finite(), "finite coordinates")?;
        }
        let volume = self.right.cross(self.up).dot(self.forward).abs();
        let unit = (volume - 1.0).abs() < 1e-3;
        check(
            || "the volume of camera.right, up and forward".to_owned(),
            volume,
            unit,
            "unit vectors at right angles",
        )?;
        let [left, right, low, high] = self.edges;
        let size = (right - left).abs().min((high - low).abs());
        let sound = size > 0.0 && self.edges.iter().all(|edge| edge.is_finite());
        check(|| "the size of camera.edges".to_owned(), size, sound, "edges of a picture that is not flat")
    }

    /// Its rays in a picture of `size` pixels.
    pub(crate) fn rays(&self, world: &World, size: [u32; 2]) -> Rays {
        let [left, right, low, high] = self.edges;
        let [across, down] = [right - left, low - high];
        // The projection shifts the picture; a pixel then shows what lies as far the other way.
        let shifted =
            |at: f64, by: f64, pixels: u32, extent: f64| at - by / f64::from(pixels.max(1)) * extent;
        let corner =
            [shifted(left, world.jitter[0], size[0], across), shifted(high, world.jitter[1], size[1], down)];
        let [x, y, z] = [self.right, self.up, self.forward].map(|vector| world.direction(vector));
        let plane = [corner[0] * x + corner[1] * y, across * x, down * y];
        if world.depth.orthographic {
            let start = plane.map(|vector| world.distance(1.0) * vector);
            return Rays { start, direction: [z, DVec3::ZERO, DVec3::ZERO] };
        }
        Rays { start: [DVec3::ZERO; 3], direction: [plane[0] + z, plane[1], plane[2]] }
    }
}
