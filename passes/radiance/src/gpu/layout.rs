//! What the kernels of this room read and write: `radiance/sample.glsl`, seen from the host.

use bytemuck::{Pod, Zeroable};
use glam::{DMat3, DVec3, Vec3};

use crate::{Incident, RadianceError, Sphere, Triangle};

/// The samples that one dispatch takes: `count` of them from `first` on. The first three words are the arguments of an
/// indirect dispatch, a workgroup for each sample, so that kernels may decide where to sample next.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct Batch {
    /// Number of samples; 0 takes none.
    pub count: u32,
    /// 1.
    pub height: u32,
    /// 1.
    pub depth: u32,
    /// The first sample, in points and lights.
    pub first: u32,
}

impl Batch {
    /// `count` samples from `first` on.
    #[must_use]
    pub const fn new(first: u32, count: u32) -> Self {
        Self { count, height: 1, depth: 1, first }
    }
}

/// A triangle as kernels read it, in the receiver's object space: corners in metres, and in their fourth components red,
/// green and blue radiance, W/sr/m2.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct EmitterTriangle {
    /// Corners and radiance.
    pub corners: [[f32; 4]; 3],
}

impl From<&Triangle> for EmitterTriangle {
    fn from(triangle: &Triangle) -> Self {
        let corner = |i: usize| triangle.corners[i].extend(triangle.radiance[i]).as_vec4().to_array();
        Self { corners: [corner(0), corner(1), corner(2)] }
    }
}

impl EmitterTriangle {
    /// Its corners, metres.
    pub(crate) fn positions(&self) -> [Vec3; 3] {
        self.corners.map(|[x, y, z, _]| Vec3::new(x, y, z))
    }

    /// Its radiance, W/sr/m2.
    pub(crate) fn radiance(&self) -> Vec3 {
        let [a, b, c] = self.corners;
        Vec3::new(a[3], b[3], c[3])
    }
}

/// A sphere as kernels read it, in the same space.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct EmitterSphere {
    /// Centre and radius, metres.
    pub place: [f32; 4],
    /// Radiance, W/sr/m2, and 0.
    pub radiance: [f32; 4],
}

impl From<&Sphere> for EmitterSphere {
    fn from(sphere: &Sphere) -> Self {
        Self {
            place: sphere.centre.extend(sphere.radius).as_vec4().to_array(),
            radiance: sphere.radiance.extend(0.0).as_vec4().to_array(),
        }
    }
}

/// How large a sample's light is in memory.
///
/// `lights`: [`stride`](Self::stride) vec4 a sample, coefficients first (RGB, 0), then (solid angle, nearness, 1 where they
/// are closed forms, and 2 more where they were kept from an earlier frame, what they may have changed by since), then
/// (slope RGB, 0). `gradients`, if there: [`gradient_stride`](Self::gradient_stride) vec4 a sample, d/dx, d/dy and d/dz of
/// the first coefficient (RGB, 0), then of the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LightShape {
    /// Bands, 3 to 6.
    pub order: usize,
    /// Whether samples hold gradients.
    pub gradients: bool,
}

impl LightShape {
    /// Coefficients of a light vector.
    #[must_use]
    pub const fn coefficients(self) -> usize {
        self.order * self.order
    }

    /// vec4 of a sample in `lights`.
    #[must_use]
    pub const fn stride(self) -> usize {
        self.coefficients() + 2
    }

    /// vec4 of a sample in `gradients`; 0 without.
    #[must_use]
    pub const fn gradient_stride(self) -> usize {
        if self.gradients { 3 * self.coefficients() } else { 0 }
    }

    /// Bytes of the lights of so many samples.
    #[must_use]
    pub const fn light_bytes(self, samples: usize) -> u64 {
        (samples * self.stride() * 16) as u64
    }

    /// Bytes of the gradients of so many samples; of one vec4 where there are none, since a buffer cannot be empty.
    #[must_use]
    pub const fn gradient_bytes(self, samples: usize) -> u64 {
        let words = samples * self.gradient_stride();
        (if words == 0 { 16 } else { words * 16 }) as u64
    }

    /// One sample as a device left it.
    ///
    /// # Errors
    /// [`RadianceError::Length`] for slices of other lengths than the strides.
    pub fn incident(self, light: &[[f32; 4]], gradients: &[[f32; 4]]) -> Result<Incident, RadianceError> {
        for (what, expected, actual) in [
            ("a sample's light", self.stride(), light.len()),
            ("a sample's gradients", self.gradient_stride(), gradients.len()),
        ] {
            if expected != actual {
                return Err(RadianceError::Length { what, expected, actual });
            }
        }
        let rgb = |v: &[f32; 4]| DVec3::new(v[0].into(), v[1].into(), v[2].into());
        let (coefficients, record) = light.split_at(self.coefficients());
        let gradient =
            |columns: &[[f32; 4]]| DMat3::from_cols(rgb(&columns[0]), rgb(&columns[1]), rgb(&columns[2]));
        Ok(Incident {
            coefficients: coefficients.iter().map(rgb).collect(),
            solid_angle: record[0][0].into(),
            nearness: record[0][1].into(),
            slope: rgb(&record[1]),
            gradients: gradients.chunks_exact(3).map(gradient).collect(),
        })
    }
}
