//! What is drawn over the picture to see how the passes work: samples as dots, spheres as circles, and what can be dragged.

use airglow_scene::Camera;
use egui::{Align2, Color32, Context, FontId, LayerId, Painter, Pos2, Stroke, pos2, vec2};
use glam::{Mat4, Vec2, Vec3};

use super::grab::Handle;
use super::style::SERIES;

/// Points of a handle's radius.
pub const HANDLE: f32 = 7.0;

/// From the world to pixels of the picture, and back.
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

/// What is drawn.
pub struct Overlay<'a> {
    /// Where the radiance pass sampled.
    pub samples: &'a [Vec3],
    /// Centre and radius of the spheres that cast shadows.
    pub spheres: &'a [(Vec3, f32)],
    /// What can be dragged.
    pub handles: &'a [Handle],
    /// The one that is dragged or under the mouse.
    pub held: Option<usize>,
}

/// Draws it below all panels.
pub fn show(context: &Context, projection: &Projection, overlay: &Overlay<'_>) {
    let painter = context.layer_painter(LayerId::background());
    let scale = context.pixels_per_point();
    let place = |pixel: Vec2| pos2(pixel.x / scale, pixel.y / scale);
    for &(center, radius) in overlay.spheres {
        if let Some((pixel, metre)) = projection.pixel(center) {
            let stroke = Stroke::new(1.0, SERIES[0].gamma_multiply(0.8));
            painter.circle_stroke(place(pixel), radius * metre / scale, stroke);
        }
    }
    for &point in overlay.samples {
        if let Some((pixel, _)) = projection.pixel(point) {
            painter.circle_filled(place(pixel), 2.4, Color32::from_black_alpha(160));
            painter.circle_filled(place(pixel), 1.6, SERIES[3]);
        }
    }
    for (number, handle) in overlay.handles.iter().enumerate() {
        if let Some((pixel, _)) = projection.pixel(handle.at) {
            draw_handle(&painter, place(pixel), &handle.name, overlay.held == Some(number));
        }
    }
}

fn draw_handle(painter: &Painter, at: Pos2, name: &str, held: bool) {
    painter.circle_stroke(at, HANDLE, Stroke::new(3.0, Color32::from_black_alpha(150)));
    painter.circle_stroke(at, HANDLE, Stroke::new(1.5, if held { SERIES[3] } else { Color32::WHITE }));
    if held {
        let font = FontId::proportional(12.0);
        let beside = at + vec2(HANDLE + 4.0, 0.0);
        let galley = painter.layout_no_wrap(name.to_owned(), font, Color32::WHITE);
        let text = Align2::LEFT_CENTER.anchor_size(beside, galley.size());
        painter.rect_filled(text.expand(2.0), 2.0, Color32::from_black_alpha(170));
        painter.galley(text.min, galley, Color32::WHITE);
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
