//! How the panel looks: dark, so that the picture beside it is judged by itself, and a little transparent.

use egui::{Color32, CornerRadius, Response, RichText, Ui, Visuals};

/// Behind the panel.
pub const BACKGROUND: Color32 = Color32::from_rgba_premultiplied(20, 22, 26, 232);
/// Text that explains.
pub const WEAK: Color32 = Color32::from_rgb(150, 156, 165);

/// What went wrong.
pub const WRONG: Color32 = Color32::from_rgb(255, 120, 100);

/// The colours of passes in the graph, told apart by people who see colours differently (Okabe and Ito 2008).
pub const SERIES: [Color32; 8] = [
    Color32::from_rgb(86, 180, 233),
    Color32::from_rgb(230, 159, 0),
    Color32::from_rgb(0, 158, 115),
    Color32::from_rgb(240, 228, 66),
    Color32::from_rgb(213, 94, 0),
    Color32::from_rgb(204, 121, 167),
    Color32::from_rgb(0, 114, 178),
    Color32::from_rgb(160, 160, 160),
];

/// Colours of the panel and what is in it.
pub fn visuals() -> Visuals {
    let mut visuals = Visuals::dark();
    visuals.panel_fill = BACKGROUND;
    visuals.override_text_color = Some(Color32::from_rgb(225, 228, 232));
    visuals.selection.bg_fill = Color32::from_rgb(0, 92, 128);
    visuals.window_corner_radius = CornerRadius::same(3);
    visuals
}

/// Text that explains.
pub fn weak(ui: &mut Ui, text: &str) -> Response {
    ui.label(RichText::new(text).color(WEAK).small())
}

/// A time as the panel writes it.
pub fn milliseconds(time: f32) -> String {
    if time < 10.0 { format!("{time:.2} ms") } else { format!("{time:.1} ms") }
}
