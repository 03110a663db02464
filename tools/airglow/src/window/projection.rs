//! From the world to pixels of the picture, and back.

use airglow_scene::Camera;
use glam::{Mat4, Vec2, Vec3};

/// A camera over the pixels of its picture.
#[derive(Clone, Copy, Debug)]
pub struct Projection {
    clip_from_world: Mat4,
    /// Pixels that a metre at depth 1 is high.
    focal: f32,
    size: Vec2,
}

impl Projection {
    /// Of a camera in a picture of that size.
    pub fn new(camera: &Camera, [width, height]: [u32; 2]) -> Self {
        let clip_from_view = camera.clip_from_view(width as f32 / height.max(1) as f32);
        Self {
            clip_from_world: clip_from_view * camera.view(),
            focal: 0.5 * height as f32 * clip_from_view.y_axis.y.abs(),
            size: Vec2::new(width as f32, height as f32),
        }
    }

    /// The pixel of a point before the camera, and pixels a metre there.
    pub fn pixel(&self, point: Vec3) -> Option<(Vec2, f32)> {
        let clip = self.clip_from_world * point.extend(1.0);
        let inside = clip.w > 1e-4 && clip.z >= 0.0;
        let place = clip.truncate().truncate() / clip.w;
        inside.then(|| (0.5 * (place + 1.0) * self.size, self.focal / clip.w))
    }

    /// The point at a pixel that is as deep in the picture as another.
    pub fn beside(&self, point: Vec3, pixel: Vec2) -> Option<Vec3> {
        let clip = self.clip_from_world * point.extend(1.0);
        self.at(pixel, clip.z / clip.w)
    }

    /// The point at a pixel that is as high in the world as another.
    pub fn level(&self, point: Vec3, pixel: Vec2) -> Option<Vec3> {
        let (near, far) = (self.at(pixel, 0.0)?, self.at(pixel, 0.999)?);
        let part = (point.y - near.y) / (far.y - near.y);
        (part.is_finite() && part > 0.0).then(|| near + part * (far - near))
    }

    fn at(&self, pixel: Vec2, depth: f32) -> Option<Vec3> {
        let place = 2.0 * pixel / self.size - 1.0;
        let point = self.clip_from_world.inverse() * place.extend(depth).extend(1.0);
        let point = point.truncate() / point.w;
        point.is_finite().then_some(point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use airglow_scene::Sphere;

    #[test]
    fn pixels_lead_back_to_points() {
        let camera = Camera::framing(Sphere { center: [1.0, 2.0, 3.0], radius: 1.5 });
        let projection = Projection::new(&camera, [640, 480]);
        let point = Vec3::new(1.3, 1.6, 2.7);
        let (pixel, metre) = projection.pixel(point).unwrap();
        for found in [projection.beside(point, pixel), projection.level(point, pixel)] {
            let found = found.unwrap();
            assert!(found.distance(point) < 1e-3, "{found} instead of {point}");
        }
        let right = camera.transform.x_axis.truncate();
        let (beside, _) = projection.pixel(point + 0.1 * right).unwrap();
        assert!((beside.x - pixel.x - 0.1 * metre).abs() < 0.1, "{beside} {pixel} {metre}");
        let higher = projection.pixel(point + 0.1 * Vec3::Y).unwrap().0;
        assert!(higher.y < pixel.y, "up is up in the picture");
        assert!(projection.pixel(camera.position() - camera.direction()).is_none());
        let lower = projection.level(point, pixel + Vec2::new(0.0, 9.0)).unwrap();
        assert!((lower.y - point.y).abs() < 1e-3 && lower.distance(point) > 0.01, "{lower}");
    }
}
