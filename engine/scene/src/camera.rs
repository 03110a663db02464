//! Cameras, and one that frames the scene when a file has none.

use glam::camera::rh::proj::vulkan;
use glam::{Mat4, Vec3};

/// Where the picture is taken from.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// The file's name, `camera N`, or what made it.
    pub name: String,
    /// World from camera: rigid, without scale. The camera looks down its -Z with +Y up.
    pub transform: Mat4,
    /// How it projects.
    pub projection: Projection,
}

/// How a [`Camera`] projects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// A pinhole.
    Perspective {
        /// Full vertical angle, radians, in (0, pi).
        vertical_angle: f32,
        /// Distance of the near plane, metres, positive.
        near: f32,
        /// Distance of the far plane, metres; `None` for infinitely far.
        far: Option<f32>,
        /// Width / height that the file asks for.
        aspect: Option<f32>,
    },
    /// Parallel rays.
    Orthographic {
        /// Half width, metres.
        half_width: f32,
        /// Half height, metres.
        half_height: f32,
        /// Distance of the near plane, metres, not negative.
        near: f32,
        /// Distance of the far plane, metres, beyond near.
        far: f32,
    },
}

impl Camera {
    /// Camera from world.
    pub fn view(&self) -> Mat4 {
        self.transform.inverse()
    }

    /// Position in the world, metres.
    pub fn position(&self) -> Vec3 {
        self.transform.w_axis.truncate()
    }

    /// Unit direction in which the camera looks.
    pub fn direction(&self) -> Vec3 {
        -self.transform.z_axis.truncate()
    }

    /// Clip from camera for Vulkan: y down, depth 0 at the near plane and 1 at the far one.
    ///
    /// `aspect` is width / height of the picture. A perspective camera keeps its vertical angle; an orthographic
    /// one keeps its half height and takes its half width from `aspect`.
    pub fn clip_from_view(&self, aspect: f32) -> Mat4 {
        match self.projection {
            Projection::Perspective { vertical_angle, near, far: Some(far), .. } => {
                vulkan::perspective(vertical_angle, aspect, near, far)
            }
            Projection::Perspective { vertical_angle, near, far: None, .. } => {
                vulkan::perspective_infinite(vertical_angle, aspect, near)
            }
            Projection::Orthographic { half_height, near, far, .. } => {
                let half_width = half_height * aspect;
                vulkan::orthographic(-half_width, half_width, -half_height, half_height, near, far)
            }
        }
    }

    /// A camera at `from` that looks at `to`. `None` if the two coincide or `up` is parallel to the view.
    pub fn look_at(name: &str, from: Vec3, to: Vec3, up: Vec3, projection: Projection) -> Option<Self> {
        Self::oriented(name, from, from - to, up, projection)
    }

    /// A camera at `from` with its +Z along `back` and its +Y as near to `up` as that allows. `None` if `back` is
    /// zero or `up` parallel to it.
    pub(crate) fn oriented(
        name: &str,
        from: Vec3,
        back: Vec3,
        up: Vec3,
        projection: Projection,
    ) -> Option<Self> {
        let back = back.try_normalize()?;
        let right = up.cross(back).try_normalize()?;
        Some(Self { name: name.into(), transform: rigid(right, back, from), projection })
    }

    /// A camera that has `sphere` whole in a picture at least as wide as high: 40 degrees high, seen from 20
    /// degrees above and 30 degrees to the right of the front (+Z).
    pub fn framing(sphere: Sphere) -> Self {
        let vertical_angle = 40.0_f32.to_radians();
        let (elevation, azimuth) = (20.0_f32.to_radians(), 30.0_f32.to_radians());
        let towards =
            Vec3::new(azimuth.sin() * elevation.cos(), elevation.sin(), azimuth.cos() * elevation.cos());
        let radius = if sphere.radius > 0.0 { sphere.radius } else { 1.0 };
        // Five percent of air around the sphere.
        let distance = 1.05 * radius / (0.5 * vertical_angle).sin();
        let right = Vec3::new(azimuth.cos(), 0.0, -azimuth.sin());
        let projection = Projection::Perspective {
            vertical_angle,
            near: 0.01 * distance,
            far: Some(distance + 4.0 * radius),
            aspect: None,
        };
        let from = Vec3::from(sphere.center) + towards * distance;
        Self { name: "framing the scene".into(), transform: rigid(right, towards, from), projection }
    }
}

/// World from camera, from two unit vectors at right angles.
fn rigid(right: Vec3, back: Vec3, position: Vec3) -> Mat4 {
    Mat4::from_cols(right.extend(0.0), back.cross(right).extend(0.0), back.extend(0.0), position.extend(1.0))
}

/// A sphere in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Metres.
    pub center: [f32; 3],
    /// Metres, not negative.
    pub radius: f32,
}
