//! What is drawn over the picture to see how the passes work: samples as dots, spheres as circles, and what can be dragged.

use egui::{Align2, Color32, Context, FontId, LayerId, Painter, Pos2, Stroke, pos2, vec2};
use glam::{Vec2, Vec3};

use super::grab::{HANDLE, Handle};
use super::projection::Projection;
use super::style::SERIES;

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
