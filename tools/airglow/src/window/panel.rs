//! The panel: what is drawn, what it takes, and what can be changed.

use airglow_graph::LeftOut;
use egui::{CollapsingHeader, Context, RichText, ScrollArea, SidePanel, Slider, Ui};

use super::controls::Controls;
use super::graph;
use super::interface::{Places, note};
use super::style;
use super::times::Times;

/// Points that the panel is wide at first.
const WIDTH: f32 = 292.0;

/// What the panel tells.
pub struct Told<'a> {
    /// The device.
    pub device: &'a str,
    /// Frames in the last second.
    pub rate: f64,
    /// Pixels of the picture.
    pub size: [u32; 2],
    /// Device times.
    pub times: &'a Times,
    /// What was left out of the plan, and why.
    pub left_out: &'a [LeftOut],
    /// What happened last.
    pub status: &'a str,
}

/// What the panel asks for beyond changes of the controls.
#[derive(Clone, Copy, Debug, Default)]
pub struct Asked {
    /// A picture of the window.
    pub picture: bool,
    /// Camera, light and exposure as at the start.
    pub home: bool,
}

/// Lays out the panel.
pub fn show(context: &Context, controls: &mut Controls, told: &Told<'_>, places: &mut Places) -> Asked {
    let mut asked = Asked::default();
    if controls.bare {
        return asked;
    }
    SidePanel::left("panel").default_width(WIDTH).show(context, |ui| {
        ui.add_space(4.0);
        ui.label(RichText::new(format!("{:.1} frames/s", told.rate)).strong().size(15.0));
        let [width, height] = told.size;
        weak(ui, &format!("{width} x {height}, {}", told.device));
        ui.separator();
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            passes(ui, controls, told, places);
            section(ui, "Device time", |ui| graph::show(ui, told.times));
            section(ui, "Light and camera", |ui| asked = light(ui, controls, places));
            left_out(ui, told);
            if !told.status.is_empty() {
                ui.separator();
                ui.label(told.status);
            }
        });
    });
    asked
}

/// A part of the panel under a heading that folds.
fn section(ui: &mut Ui, title: &str, body: impl FnOnce(&mut Ui)) {
    CollapsingHeader::new(RichText::new(title).strong()).default_open(true).show(ui, body);
}

/// Text that explains.
fn weak(ui: &mut Ui, text: &str) {
    ui.label(RichText::new(text).color(style::WEAK).small());
}

fn passes(ui: &mut Ui, controls: &mut Controls, told: &Told<'_>, places: &mut Places) {
    section(ui, "Passes", |ui| {
        let passes = &mut controls.passes;
        let rows =
            [("relight", &mut passes.relight), ("shadow", &mut passes.shadow), ("fog", &mut passes.fog)];
        for (name, drawn) in rows {
            ui.horizontal(|ui| {
                note(places, name, &ui.checkbox(drawn, name));
                let time = told.times.of(name).map_or("not in the plan".to_owned(), milliseconds);
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| weak(ui, &time));
            });
        }
    });
}

fn light(ui: &mut Ui, controls: &mut Controls, places: &mut Places) -> Asked {
    let degrees = |value, range| Slider::new(value, range).suffix(" deg").fixed_decimals(0);
    let turn = ui.add(degrees(&mut controls.turn, -180.0..=180.0).text("environment"));
    note(places, "environment", &turn);
    ui.add(degrees(&mut controls.spin, -90.0..=90.0).text("a second"));
    note(places, "stopped", &ui.checkbox(&mut controls.paused, "stopped"));
    let exposure = ui.add(Slider::new(&mut controls.stops, -8.0..=8.0).suffix(" stops").text("exposure"));
    note(places, "exposure", &exposure);
    ui.horizontal(|ui| {
        note(places, "orbit", &ui.selectable_label(!controls.flies, "around the scene"));
        let flies = ui.selectable_label(controls.flies, "fly");
        note(places, "fly", &flies);
        if flies.clicked() {
            controls.flies = true;
        }
    });
    let mut asked = Asked::default();
    ui.horizontal(|ui| {
        let home = ui.button("as at the start");
        let picture = ui.button("picture");
        note(places, "home", &home);
        note(places, "picture", &picture);
        asked = Asked { picture: picture.clicked(), home: home.clicked() };
    });
    asked
}

fn left_out(ui: &mut Ui, told: &Told<'_>) {
    if told.left_out.is_empty() {
        return;
    }
    let header = CollapsingHeader::new(RichText::new("Left out").strong()).default_open(false);
    header.show(ui, |ui| {
        for left_out in told.left_out {
            ui.label(&left_out.what);
            weak(ui, &left_out.why);
        }
    });
}

/// A time as the panel writes it.
pub fn milliseconds(time: f32) -> String {
    if time < 10.0 { format!("{time:.2} ms") } else { format!("{time:.1} ms") }
}
