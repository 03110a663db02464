//! Working coordinates of the rays.

use glam::Vec3A;

/// Multiplies by a power of two, which rounds nothing: obvhs drops boxes that a ray leaves within an absolute
/// 1e-4, so a scene must never be small in the units it sees, nor so large that areas overflow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scale(f64);

/// The largest coordinate becomes 2^16 to 2^17: 1e-4 is then far below f32's resolution.
const WORKING_EXPONENT: i32 = 16;

impl Scale {
    /// From a scene's largest absolute coordinate.
    pub(crate) fn to_working_size(largest: f32) -> Self {
        if largest > 0.0 {
            let exponent = f64::from(largest).log2().floor() as i32;
            Self(2f64.powi(WORKING_EXPONENT - exponent))
        } else {
            Self(1.0)
        }
    }

    /// A point in working coordinates.
    pub(crate) fn apply(self, point: [f32; 3]) -> Vec3A {
        Vec3A::from(point.map(|x| (f64::from(x) * self.0) as f32))
    }

    /// A length in working units.
    pub(crate) fn length(self, length: f32) -> f32 {
        (f64::from(length) * self.0) as f32
    }
}
