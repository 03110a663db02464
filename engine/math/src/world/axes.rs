//! Which of a host's axes point to the right, up and forward, and what that makes of directions and turns.

use glam::{DMat3, DQuat, DVec3};

use crate::MathError;
use crate::axis::Axis;

/// Whether a host's axes are an ordinary right hand or its mirror image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Handedness {
    /// X cross Y is Z as the eye sees it, as in airglow's own axes.
    Right,
    /// The mirror image.
    Left,
}

/// A host's axes, by where an upright viewer who looks forward sees them. Handedness follows from the three.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Axes {
    right: Axis,
    up: Axis,
    forward: Axis,
}

impl Axes {
    /// X right, Y up, -Z forward, right-handed: airglow's own, glTF, OpenGL.
    pub const Y_UP_RIGHT_HANDED: Self = Self { right: Axis::PlusX, up: Axis::PlusY, forward: Axis::MinusZ };
    /// X right, Y up, Z forward, left-handed: Unity, Direct3D.
    pub const Y_UP_LEFT_HANDED: Self = Self { right: Axis::PlusX, up: Axis::PlusY, forward: Axis::PlusZ };
    /// X right, Y forward, Z up, right-handed: Blender.
    pub const Z_UP_RIGHT_HANDED: Self = Self { right: Axis::PlusX, up: Axis::PlusZ, forward: Axis::PlusY };
    /// X forward, Y right, Z up, left-handed: Unreal.
    pub const Z_UP_LEFT_HANDED: Self = Self { right: Axis::PlusY, up: Axis::PlusZ, forward: Axis::PlusX };
    /// X right, Y down, Z forward, right-handed: Vulkan's clip space, computer vision.
    pub const Y_DOWN_RIGHT_HANDED: Self = Self { right: Axis::PlusX, up: Axis::MinusY, forward: Axis::PlusZ };

    /// Axes by what points where.
    ///
    /// # Errors
    /// [`MathError::Axes`] when two of them lie along the same line.
    pub fn new(right: Axis, up: Axis, forward: Axis) -> Result<Self, MathError> {
        let axes = Self { right, up, forward };
        if axes.determinant() == 0.0 { Err(MathError::Axes { right, up, forward }) } else { Ok(axes) }
    }

    /// Airglow's components from the host's: an orthogonal matrix, a reflection for left-handed axes.
    #[must_use]
    pub fn airglow_from_host(&self) -> DMat3 {
        DMat3::from_cols(self.right.vector(), self.up.vector(), -self.forward.vector()).transpose()
    }

    /// The host's components from airglow's.
    #[must_use]
    pub fn host_from_airglow(&self) -> DMat3 {
        self.airglow_from_host().transpose()
    }

    /// What hand the axes are.
    #[must_use]
    pub fn handedness(&self) -> Handedness {
        if self.determinant() > 0.0 { Handedness::Right } else { Handedness::Left }
    }

    /// 1 for right-handed axes, -1 for left-handed ones: the determinant of
    /// [`airglow_from_host`](Self::airglow_from_host).
    #[must_use]
    pub fn determinant(&self) -> f64 {
        self.airglow_from_host().determinant()
    }

    /// The quaternion in airglow's axes that turns what `host` turns in the host's: a reflection keeps the angle, and
    /// turns the axis round.
    #[must_use]
    pub fn rotation(&self, host: DQuat) -> DQuat {
        self.turned(self.airglow_from_host(), host)
    }

    /// The opposite of [`rotation`](Self::rotation).
    #[must_use]
    pub fn host_rotation(&self, airglow: DQuat) -> DQuat {
        self.turned(self.host_from_airglow(), airglow)
    }

    fn turned(&self, to: DMat3, q: DQuat) -> DQuat {
        let axis = self.determinant() * (to * DVec3::new(q.x, q.y, q.z));
        DQuat::from_xyzw(axis.x, axis.y, axis.z, q.w)
    }
}

impl Default for Axes {
    fn default() -> Self {
        Self::Y_UP_RIGHT_HANDED
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Axis; 6] = [Axis::PlusX, Axis::MinusX, Axis::PlusY, Axis::MinusY, Axis::PlusZ, Axis::MinusZ];

    /// The 48 ways to lay out three axes.
    fn all_axes() -> Vec<Axes> {
        let triples = ALL.into_iter().flat_map(|right| {
            ALL.into_iter()
                .flat_map(move |up| ALL.into_iter().map(move |forward| Axes::new(right, up, forward)))
        });
        triples.flatten().collect()
    }

    #[test]
    fn half_of_the_48_layouts_are_left_handed() {
        let axes = all_axes();
        assert_eq!(axes.len(), 48);
        assert_eq!(axes.iter().filter(|axes| axes.handedness() == Handedness::Left).count(), 24);
        for (axes, handedness) in [
            (Axes::Y_UP_RIGHT_HANDED, Handedness::Right),
            (Axes::Y_UP_LEFT_HANDED, Handedness::Left),
            (Axes::Z_UP_RIGHT_HANDED, Handedness::Right),
            (Axes::Z_UP_LEFT_HANDED, Handedness::Left),
            (Axes::Y_DOWN_RIGHT_HANDED, Handedness::Right),
        ] {
            assert_eq!(axes.handedness(), handedness, "{axes:?}");
        }
        let error = Axes::new(Axis::PlusX, Axis::MinusX, Axis::PlusZ).unwrap_err().to_string();
        assert!(error.contains("PlusX") && error.contains("MinusX"), "{error}");
    }

    #[test]
    fn right_up_and_forward_become_airglow_s() {
        for axes in all_axes() {
            let to = axes.airglow_from_host();
            let found = [axes.right, axes.up, axes.forward].map(|axis| to * axis.vector());
            assert_eq!(found, [DVec3::X, DVec3::Y, DVec3::NEG_Z], "{axes:?}");
            assert_eq!(axes.host_from_airglow() * to, DMat3::IDENTITY, "{axes:?}");
        }
    }

    #[test]
    fn a_turned_direction_is_the_direction_turned() {
        let q = DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 1.1);
        let d = DVec3::new(0.3, 0.7, -1.9);
        for axes in all_axes() {
            let to = axes.airglow_from_host();
            let (found, expected) = (axes.rotation(q) * (to * d), to * (q * d));
            assert!((found - expected).length() < 1e-14, "{axes:?}: {found} instead of {expected}");
            assert_eq!(axes.host_rotation(axes.rotation(q)), q, "{axes:?}");
        }
    }
}
