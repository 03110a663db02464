//! A host's conventions, stated once, and the way from them to airglow's and back.
//!
//! Airglow computes in metres, right-handed, +Y up, -Z forward (see the crate's own documentation). A pass takes a
//! [`World`] and converts at its border; nothing within knows of the host's axes.

mod axes;
mod depth;

use glam::{DMat3, DVec3};

pub use axes::{Axes, Handedness};
pub use depth::Depth;

pub use crate::axis::Axis;

use crate::MathError;
use crate::sh::rotation::Rotation;

/// How a triangle's front winds in the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Winding {
    /// Counter-clockwise: airglow's own, glTF.
    #[default]
    CounterClockwise,
    /// Clockwise.
    Clockwise,
}

/// Where green points in the host's normal maps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum NormalMapGreen {
    /// Up the texture, against v: airglow's own, glTF, OpenGL.
    #[default]
    Up,
    /// Down the texture, along v: Direct3D, Unreal.
    Down,
}

/// A host's conventions. The default is airglow's own. Everything but axes and units may change from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct World {
    /// Which axes point where, and so which hand they are.
    pub axes: Axes,
    /// Length of the host's unit in metres: above 0.
    pub metres_per_unit: f64,
    /// How front faces wind.
    pub front_face: Winding,
    /// Where green points in normal maps.
    pub normal_map_green: NormalMapGreen,
    /// What depth values stand for.
    pub depth: Depth,
    /// Pixels by which the projection shifts the picture in this frame, right and down; 0 without.
    pub jitter: [f64; 2],
    /// What the host multiplies its colours with before they are stored: above 0. Radiance that comes in is not
    /// multiplied yet, radiance that goes out is.
    pub pre_exposure: f64,
    /// Where the zero of the positions that the host gives lies in its world, in its axes and units: the camera's place
    /// for a host whose positions are relative to it, 0 for one whose positions are not.
    pub origin: DVec3,
    /// Views of a frame: at least 1.
    pub views: u32,
}

impl Default for World {
    fn default() -> Self {
        Self {
            axes: Axes::default(),
            metres_per_unit: 1.0,
            front_face: Winding::default(),
            normal_map_green: NormalMapGreen::default(),
            depth: Depth::default(),
            jitter: [0.0; 2],
            pre_exposure: 1.0,
            origin: DVec3::ZERO,
            views: 1,
        }
    }
}

impl World {
    /// Refuses what no host can mean.
    ///
    /// # Errors
    /// [`MathError::Range`] naming the first that is out of range.
    pub fn check(&self) -> Result<(), MathError> {
        let refuse = |what, value, range| Err(MathError::Range { what, value, range });
        let positive = |value: f64| value.is_finite() && value > 0.0;
        if !positive(self.metres_per_unit) {
            return refuse("metres per unit", self.metres_per_unit, "a finite length above 0");
        }
        if !positive(self.pre_exposure) {
            return refuse("the pre-exposure", self.pre_exposure, "a finite factor above 0");
        }
        let wrong = |value: &f64| !value.is_finite();
        if let Some(value) = self.origin.to_array().into_iter().chain(self.jitter).find(wrong) {
            return refuse("the origin or the jitter", value, "finite numbers");
        }
        if self.views == 0 {
            return refuse("the number of views", 0.0, "at least 1");
        }
        self.depth.check()
    }

    /// A direction of the host's in airglow's axes; its length stays.
    #[must_use]
    pub fn direction(&self, host: DVec3) -> DVec3 {
        self.axes.airglow_from_host() * host
    }

    /// The opposite of [`direction`](Self::direction).
    #[must_use]
    pub fn host_direction(&self, airglow: DVec3) -> DVec3 {
        self.axes.host_from_airglow() * airglow
    }

    /// A position as the host gives it, in airglow's axes, in metres from the zero of the host's world.
    #[must_use]
    pub fn position(&self, host: DVec3) -> DVec3 {
        self.metres_per_unit * self.direction(host + self.origin)
    }

    /// The opposite of [`position`](Self::position).
    #[must_use]
    pub fn host_position(&self, airglow: DVec3) -> DVec3 {
        self.host_direction(airglow) / self.metres_per_unit - self.origin
    }

    /// A length of the host's in metres.
    #[must_use]
    pub fn distance(&self, host: f64) -> f64 {
        self.metres_per_unit * host
    }

    /// The upper left of an instance's matrix, from object space to the host's axes, as one to airglow's axes. Object
    /// space stays as it is: nothing is asked of its axes.
    #[must_use]
    pub fn instance_matrix(&self, host: DMat3) -> DMat3 {
        self.axes.airglow_from_host() * host
    }

    /// What turns spherical harmonics about the host's axes into those about airglow's; for left-handed axes a
    /// reflection.
    ///
    /// # Errors
    /// [`MathError::Order`].
    pub fn harmonics(&self, order: usize) -> Result<Rotation, MathError> {
        Rotation::from_matrix(order, self.axes.airglow_from_host())
    }

    /// 1 when `cross(b - a, c - a)` of a triangle in the host's components points out of its front, -1 when it points
    /// into it: both winding and hand decide.
    #[must_use]
    pub fn face_sign(&self) -> f64 {
        match self.front_face {
            Winding::CounterClockwise => self.axes.determinant(),
            Winding::Clockwise => -self.axes.determinant(),
        }
    }

    /// What the green of the host's normal maps, decoded to -1..=1, is multiplied with for green that points up.
    #[must_use]
    pub fn green_sign(&self) -> f64 {
        match self.normal_map_green {
            NormalMapGreen::Up => 1.0,
            NormalMapGreen::Down => -1.0,
        }
    }

    /// [`Depth::coefficients`] for metres.
    #[must_use]
    pub fn depth_coefficients(&self) -> [f64; 4] {
        self.depth.coefficients(self.metres_per_unit)
    }
}

#[cfg(test)]
mod tests;
