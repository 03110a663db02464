//! Directions along a host's axes.

use glam::DVec3;

/// One of the six directions along a host's axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    /// +X.
    PlusX,
    /// -X.
    MinusX,
    /// +Y.
    PlusY,
    /// -Y.
    MinusY,
    /// +Z.
    PlusZ,
    /// -Z.
    MinusZ,
}

impl Axis {
    /// The unit vector in the host's components.
    #[must_use]
    pub const fn vector(self) -> DVec3 {
        match self {
            Self::PlusX => DVec3::X,
            Self::MinusX => DVec3::NEG_X,
            Self::PlusY => DVec3::Y,
            Self::MinusY => DVec3::NEG_Y,
            Self::PlusZ => DVec3::Z,
            Self::MinusZ => DVec3::NEG_Z,
        }
    }
}
