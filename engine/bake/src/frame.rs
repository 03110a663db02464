//! The frame of a vertex's normal, and the rotation of its vectors into the space baked in.
//!
//! By Euler angles: a turn by `twist` about +Z, a tilt about +Y, a turn about +Z. Turns about Z mix only m and -m;
//! the tilt is a turn about Z between two constant quarter turns about X (Kautz, Sloan, Snyder 2002). For one
//! vector per rotation this is cheaper than building the rotation's matrices.

use airglow_math::MathError;
use airglow_math::sh::rotation::Rotation;
use glam::{DMat3, DQuat, DVec2, DVec3};

use crate::directions::MAX_COEFFICIENTS;

/// Cosine and sine of the three angles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    twist: DVec2,
    tilt: DVec2,
    turn: DVec2,
}

impl Frame {
    /// The frame whose +Z is the unit `normal`, turned about it by `twist` radians.
    pub(crate) fn new(normal: DVec3, twist: f64) -> Self {
        let across = DVec2::new(normal.x, normal.y);
        Self {
            twist: DVec2::from_angle(twist),
            tilt: DVec2::new(normal.z, across.length()),
            turn: across.try_normalize().unwrap_or(DVec2::X),
        }
    }

    /// From the frame to the space baked in.
    pub(crate) fn matrix(&self) -> DMat3 {
        let about_z =
            |a: DVec2| DMat3::from_cols(DVec3::new(a.x, a.y, 0.0), DVec3::new(-a.y, a.x, 0.0), DVec3::Z);
        let tilt = DMat3::from_cols(
            DVec3::new(self.tilt.x, 0.0, -self.tilt.y),
            DVec3::Y,
            DVec3::new(self.tilt.y, 0.0, self.tilt.x),
        );
        about_z(self.turn) * tilt * about_z(self.twist)
    }
}

/// The constant quarter turns of an order.
pub(crate) struct FrameRotation {
    y_to_z: Rotation,
    z_to_y: Rotation,
}

impl FrameRotation {
    pub(crate) fn new(order: usize) -> Result<Self, MathError> {
        let y_to_z = Rotation::from_quaternion(order, DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2))?;
        Ok(Self { z_to_y: y_to_z.inverse(), y_to_z })
    }

    /// Rotates a vector from the frame to the space baked in.
    pub(crate) fn apply(&self, frame: &Frame, vector: &mut [f64]) -> Result<(), MathError> {
        let mut buffer = [0.0; MAX_COEFFICIENTS];
        let buffer = &mut buffer[..vector.len()];
        let order = self.y_to_z.order();
        turn_about_z(order, frame.twist, vector);
        self.y_to_z.apply(vector, buffer)?;
        turn_about_z(order, frame.tilt, buffer);
        self.z_to_y.apply(buffer, vector)?;
        turn_about_z(order, frame.turn, vector);
        Ok(())
    }
}

/// Coefficients (l, m) and (l, -m) turn by m times the angle, as cos(mφ) and sin(mφ) do.
fn turn_about_z(order: usize, angle: DVec2, vector: &mut [f64]) {
    let mut multiple = DVec2::X;
    for m in 1..order {
        multiple = angle.rotate(multiple);
        for l in m..order {
            let middle = l * (l + 1);
            let (cosine, sine) = (vector[middle + m], vector[middle - m]);
            vector[middle + m] = multiple.x * cosine - multiple.y * sine;
            vector[middle - m] = multiple.y * cosine + multiple.x * sine;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn agrees_with_the_rotation_matrices(
            f in proptest::collection::vec(-1.0..1.0_f64, 36),
            normal in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
            twist in -7.0..7.0_f64,
        ) {
            let frame = Frame::new(DVec3::from(normal).normalize_or(DVec3::NEG_Z), twist);
            let mut expected = vec![0.0; 36];
            let rotation = Rotation::from_quaternion(6, DQuat::from_mat3(&frame.matrix())).unwrap();
            rotation.apply(&f, &mut expected).unwrap();
            let mut actual = f.clone();
            FrameRotation::new(6).unwrap().apply(&frame, &mut actual).unwrap();
            for (a, e) in actual.iter().zip(&expected) {
                prop_assert!((a - e).abs() < 1e-12, "{a} for {e}");
            }
        }
    }

    #[test]
    fn the_frame_carries_z_to_the_normal() {
        for normal in
            [DVec3::Z, DVec3::NEG_Z, DVec3::X, DVec3::new(0.6, -0.48, 0.64), DVec3::new(1e-200, 0.0, 1.0)]
        {
            let matrix = Frame::new(normal, 1.0).matrix();
            assert!((matrix * DVec3::Z - normal).length() < 1e-15, "{matrix} for {normal}");
            assert!((matrix.determinant() - 1.0).abs() < 1e-14, "{matrix}");
        }
    }
}
