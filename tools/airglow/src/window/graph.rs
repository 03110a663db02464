//! The graph of device times: frames from left to right, passes one above another.

use egui::epaint::{Mesh, Shape};
use egui::{Color32, FontId, Rect, RichText, Sense, Ui, pos2, vec2};

use super::style::{SERIES, WEAK, milliseconds};
use super::times::Times;

/// Points that the graph is high.
const HEIGHT: f32 = 56.0;
/// Frames that it is wide.
const FRAMES: usize = 240;

/// Draws the graph.
pub fn show(ui: &mut Ui, times: &Times) {
    let (response, painter) = ui.allocate_painter(vec2(ui.available_width(), HEIGHT), Sense::hover());
    let area = response.rect;
    painter.rect_filled(area, 2.0, Color32::from_rgb(12, 13, 16));
    let top = scale(times);
    painter.add(Shape::mesh(bars(times, area, top)));
    let font = FontId::proportional(10.0);
    painter.text(area.left_top() + vec2(3.0, 1.0), egui::Align2::LEFT_TOP, milliseconds(top), font, WEAK);
}

/// Each pass with the colour that it has in the graph, and its time.
pub fn rows(ui: &mut Ui, times: &Times) {
    let medians = times.medians();
    for &(place, time) in &medians {
        row(ui, Some(colour(place)), &times.names()[place], time);
    }
    if !medians.is_empty() {
        row(ui, None, "all", medians.iter().map(|(_, time)| time).sum());
    }
}

fn row(ui: &mut Ui, colour: Option<Color32>, name: &str, time: f32) {
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(8.0, 8.0), Sense::hover());
        if let Some(colour) = colour {
            ui.painter().rect_filled(rect, 1.0, colour);
        }
        ui.label(RichText::new(name).small());
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.label(RichText::new(milliseconds(time)).monospace().size(10.5));
        });
    });
}

fn colour(place: usize) -> Color32 {
    SERIES[place % SERIES.len()]
}

/// Milliseconds of the graph's upper edge: 1, 2 or 5 times a power of ten that no more than a few frames exceed.
fn scale(times: &Times) -> f32 {
    let mut sums: Vec<f32> = times.frames().map(|frame| frame.iter().map(|(_, time)| time).sum()).collect();
    sums.sort_by(f32::total_cmp);
    let high = sums.get(sums.len() * 19 / 20).copied().unwrap_or(1.0).max(1e-3);
    let power = 10.0_f32.powf(high.log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|step| step * power).into_iter().find(|top| *top >= high).unwrap_or(high)
}

/// A bar for each frame, the newest at the right edge.
fn bars(times: &Times, area: Rect, top: f32) -> Mesh {
    let mut mesh = Mesh::default();
    let width = area.width() / FRAMES as f32;
    for (age, frame) in times.frames().rev().take(FRAMES).enumerate() {
        let right = area.right() - width * age as f32;
        let mut below = area.bottom();
        for &(place, time) in frame {
            let above = (below - area.height() * time / top).max(area.top());
            let bar = Rect::from_min_max(pos2(right - width, above), pos2(right, below));
            mesh.add_colored_rect(bar, colour(place));
            below = above;
        }
    }
    mesh
}
