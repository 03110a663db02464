//! Cube maps with Vulkan's faces and orientation (Vulkan specification, "Cube Map Face Selection"): face order
//! +X, -X, +Y, -Y, +Z, -Z; (u, v) in [0, 1]², u right and v down on each face as stored.

use glam::DVec3;

use crate::MathError;

/// The longest side of a face, in texels.
pub const MAX_SIDE: usize = 8192;

/// A face, its value the layer of the cube image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Face {
    /// Layer 0.
    PositiveX,
    /// Layer 1.
    NegativeX,
    /// Layer 2.
    PositiveY,
    /// Layer 3.
    NegativeY,
    /// Layer 4.
    PositiveZ,
    /// Layer 5.
    NegativeZ,
}

impl Face {
    /// All faces in the order of the layers.
    pub const ALL: [Self; 6] = [
        Self::PositiveX,
        Self::NegativeX,
        Self::PositiveY,
        Self::NegativeY,
        Self::PositiveZ,
        Self::NegativeZ,
    ];

    /// The directions in which the face's u and v grow, and its normal: `normal + (2u-1) right + (2v-1) down`
    /// is the point (u, v) on the cube of half-side 1.
    #[must_use]
    pub const fn axes(self) -> [DVec3; 3] {
        match self {
            Self::PositiveX => [DVec3::NEG_Z, DVec3::NEG_Y, DVec3::X],
            Self::NegativeX => [DVec3::Z, DVec3::NEG_Y, DVec3::NEG_X],
            Self::PositiveY => [DVec3::X, DVec3::Z, DVec3::Y],
            Self::NegativeY => [DVec3::X, DVec3::NEG_Z, DVec3::NEG_Y],
            Self::PositiveZ => [DVec3::X, DVec3::NEG_Y, DVec3::Z],
            Self::NegativeZ => [DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z],
        }
    }
}

/// Unit direction of the point (u, v) of a face. Texel (x, y) of a face of `size` has its centre at
/// `((x + 1/2) / size, (y + 1/2) / size)`.
#[must_use]
pub fn direction(face: Face, u: f64, v: f64) -> DVec3 {
    let [right, down, normal] = face.axes();
    (normal + (2.0 * u - 1.0) * right + (2.0 * v - 1.0) * down).normalize()
}

/// The face and point (u, v) that a direction of any length meets; on edges z wins over y, and y over x, as
/// Vulkan recommends. `None` for zero and for what is not finite.
#[must_use]
pub fn face_uv(direction: DVec3) -> Option<(Face, [f64; 2])> {
    let size = direction.abs();
    if !direction.is_finite() || size == DVec3::ZERO {
        return None;
    }
    let pick = |positive: bool, faces: [Face; 2]| faces[usize::from(!positive)];
    let face = if size.z >= size.x && size.z >= size.y {
        pick(direction.z > 0.0, [Face::PositiveZ, Face::NegativeZ])
    } else if size.y >= size.x {
        pick(direction.y > 0.0, [Face::PositiveY, Face::NegativeY])
    } else {
        pick(direction.x > 0.0, [Face::PositiveX, Face::NegativeX])
    };
    let [right, down, normal] = face.axes();
    let depth = direction.dot(normal);
    Some((face, [right, down].map(|axis| 0.5 * (direction.dot(axis) / depth + 1.0))))
}

/// Exact solid angle in steradians of texel (x, y) of a face of `size` by `size`: a difference of the angles
/// under which four corner rectangles are seen. Its absolute error is below 5e-16.
///
/// # Errors
/// [`MathError::Size`] unless `size` is 1 to [`MAX_SIDE`]; [`MathError::Index`] for a texel outside.
pub fn texel_solid_angle(size: usize, x: usize, y: usize) -> Result<f64, MathError> {
    check_size(size)?;
    check_index("column", x, size)?;
    check_index("row", y, size)?;
    Ok(solid_angle(size, x, y))
}

fn solid_angle(size: usize, x: usize, y: usize) -> f64 {
    let edge = |i: usize| (2.0 * i as f64 - size as f64) / size as f64;
    let corner = |a: f64, b: f64| (a * b).atan2((a * a + b * b + 1.0).sqrt());
    let (left, right, top, bottom) = (edge(x), edge(x + 1), edge(y), edge(y + 1));
    corner(right, bottom) - corner(left, bottom) - corner(right, top) + corner(left, top)
}

/// The solid angles of a face's texels, one quadrant stored: ⌈size/2⌉² numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidAngles {
    size: usize,
    quadrant: Vec<f64>,
}

impl SolidAngles {
    /// Computes the table of a face of `size` by `size`.
    ///
    /// # Errors
    /// [`MathError::Size`] unless `size` is 1 to [`MAX_SIDE`].
    pub fn new(size: usize) -> Result<Self, MathError> {
        check_size(size)?;
        let half = size.div_ceil(2);
        let quadrant = (0..half * half).map(|i| solid_angle(size, i % half, i / half)).collect();
        Ok(Self { size, quadrant })
    }

    /// Texels along one side.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }

    /// The stored quadrant, of texels with x and y below ⌈size/2⌉, row-major.
    #[must_use]
    pub fn quadrant(&self) -> &[f64] {
        &self.quadrant
    }

    /// Solid angle of texel (x, y) in steradians.
    ///
    /// # Errors
    /// [`MathError::Index`] for a texel outside the face.
    pub fn get(&self, x: usize, y: usize) -> Result<f64, MathError> {
        check_index("column", x, self.size)?;
        check_index("row", y, self.size)?;
        let [x, y] = [x, y].map(|i| i.min(self.size - 1 - i));
        Ok(self.quadrant[y * self.size.div_ceil(2) + x])
    }
}

fn check_size(size: usize) -> Result<(), MathError> {
    if (1..=MAX_SIDE).contains(&size) {
        return Ok(());
    }
    Err(MathError::Size { what: "a cube face", width: size, height: size, limit: MAX_SIDE })
}

fn check_index(what: &'static str, index: usize, count: usize) -> Result<(), MathError> {
    if index < count { Ok(()) } else { Err(MathError::Index { what, index, count }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::gauss_legendre;
    use crate::testing::{assert_close, direction as any_direction};
    use proptest::prelude::*;
    use std::f64::consts::PI;

    /// The corners of the table in the Vulkan specification: s_c and t_c of each face.
    #[test]
    fn faces_lie_as_vulkan_says() {
        type Coordinates = fn(DVec3) -> [f64; 2];
        let table: [(Face, Coordinates); 6] = [
            (Face::PositiveX, |r| [-r.z, -r.y]),
            (Face::NegativeX, |r| [r.z, -r.y]),
            (Face::PositiveY, |r| [r.x, r.z]),
            (Face::NegativeY, |r| [r.x, -r.z]),
            (Face::PositiveZ, |r| [r.x, -r.y]),
            (Face::NegativeZ, |r| [-r.x, -r.y]),
        ];
        for (layer, (face, coordinates)) in table.into_iter().enumerate() {
            assert_eq!(Face::ALL[layer], face);
            assert_eq!(face as usize, layer);
            for (u, v) in [(0.1, 0.2), (0.9, 0.3), (0.5, 0.5), (0.2, 0.8)] {
                let d = direction(face, u, v);
                let expected = coordinates(d).map(|c| 0.5 * (c / d.abs().max_element() + 1.0));
                assert_close("u", u, expected[0], 1e-15);
                assert_close("v", v, expected[1], 1e-15);
            }
        }
    }

    proptest! {
        #[test]
        fn face_uv_inverts_direction(d in any_direction()) {
            let (face, [u, v]) = face_uv(0.01 * d).unwrap();
            prop_assert!((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v), "({u}, {v})");
            let again = direction(face, u, v);
            prop_assert!(again.distance(d) < 1e-15, "{again} instead of {d}");
        }

        #[test]
        fn the_quadrant_is_the_whole_face(size in 1..40_usize, x in 0..40_usize, y in 0..40_usize) {
            prop_assume!(x < size && y < size);
            let table = SolidAngles::new(size).unwrap();
            assert_close("texel", table.get(x, y).unwrap(), texel_solid_angle(size, x, y).unwrap(), 2e-15);
        }
    }

    #[test]
    fn edges_go_to_the_later_axis() {
        assert_eq!(face_uv(DVec3::ONE).unwrap(), (Face::PositiveZ, [1.0, 0.0]));
        assert_eq!(face_uv(DVec3::new(1.0, -1.0, 0.0)).unwrap().0, Face::NegativeY);
        assert_eq!(face_uv(DVec3::ZERO), None);
        assert_eq!(face_uv(DVec3::new(f64::NAN, 1.0, 0.0)), None);
        assert_eq!(face_uv(DVec3::new(f64::INFINITY, 1.0, 0.0)), None);
    }

    #[test]
    fn texels_fill_a_sixth_of_the_sphere() {
        for size in [1, 2, 3, 64, 257] {
            let table = SolidAngles::new(size).unwrap();
            let texels = (0..size * size).map(|i| table.get(i % size, i / size).unwrap());
            assert_close(&format!("size {size}"), texels.sum(), 4.0 * PI / 6.0, 1e-11);
        }
    }

    #[test]
    fn one_texel_is_a_sixth_of_the_sphere() {
        assert_close("size 1", texel_solid_angle(1, 0, 0).unwrap(), 2.0 * PI / 3.0, 1e-15);
    }

    #[test]
    fn a_texel_agrees_with_quadrature() {
        let rule = gauss_legendre(60).unwrap();
        for (size, x, y) in [(4, 0, 0), (4, 1, 2), (64, 63, 10), (4096, 0, 0), (4096, 2047, 1000)] {
            let side = 2.0 / size as f64;
            let at = |i: usize, node: f64| (i as f64 + 0.5 + 0.5 * node) * side - 1.0;
            let mut sum = 0.0;
            for (a, weight_a) in &rule {
                for (b, weight_b) in &rule {
                    let square = 1.0 + at(x, *a).powi(2) + at(y, *b).powi(2);
                    sum += weight_a * weight_b * 0.25 * side * side * square.powf(-1.5);
                }
            }
            assert_close("solid angle", texel_solid_angle(size, x, y).unwrap(), sum, 5e-16);
        }
    }

    #[test]
    fn refuses_what_is_no_face() {
        assert!(matches!(SolidAngles::new(0), Err(MathError::Size { .. })));
        assert!(matches!(SolidAngles::new(MAX_SIDE + 1), Err(MathError::Size { .. })));
        assert!(matches!(texel_solid_angle(4, 4, 0), Err(MathError::Index { .. })));
        assert!(matches!(SolidAngles::new(3).unwrap().get(0, 3), Err(MathError::Index { .. })));
    }
}
