//! The panel: what is drawn, what it takes, and what can be changed.

use egui::{
    CollapsingHeader, Context, ProgressBar, RichText, ScrollArea, SidePanel, Slider, TopBottomPanel, Ui,
};

use super::controls::Controls;
use super::graph;
use super::interface::{Places, note};
use super::rooms;
use super::style::{WRONG, weak};
use super::told::Told;
use super::wish::Wish;

/// Points that the panel is wide at first.
const WIDTH: f32 = 318.0;

/// What the panel asks for beyond changes of the controls.
#[derive(Clone, Copy, Debug, Default)]
pub struct Asked {
    /// A picture of the window.
    pub picture: bool,
    /// Camera, light, exposure, lamps and figures as at the start.
    pub home: bool,
}

/// Lays out the panel.
pub fn show(
    context: &Context,
    controls: &mut Controls,
    wish: &mut Wish,
    told: &Told<'_>,
    places: &mut Places,
) -> Asked {
    let mut asked = Asked::default();
    if controls.bare {
        return asked;
    }
    SidePanel::left("panel").default_width(WIDTH).show(context, |ui| {
        ui.add_space(4.0);
        ui.label(RichText::new(format!("{:.1} frames/s", told.rate)).strong().size(15.0));
        let [width, height] = told.size;
        weak(ui, &format!("{width} x {height}, {}", told.device));
        graph::show(ui, told.times);
        TopBottomPanel::bottom("happened").show_inside(ui, |ui| happened(ui, told));
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            section(ui, "Light and camera", true, |ui| asked = light(ui, controls, places));
            section(ui, "Passes", true, |ui| rooms::show(ui, controls, wish, told, places));
            section(ui, "Show", true, |ui| overlays(ui, controls, places));
            section(ui, "Device time", true, |ui| graph::rows(ui, told.times));
            section(ui, "Left out", false, |ui| left_out(ui, told));
        });
    });
    asked
}

/// What is being done, what was done last, what went wrong.
fn happened(ui: &mut Ui, told: &Told<'_>) {
    match (&told.busy, told.status) {
        (Some((words, part)), _) => {
            let bar = ProgressBar::new(part.unwrap_or(0.0)).text(RichText::new(words).small());
            ui.add(if part.is_none() { bar.animate(true) } else { bar });
        }
        (None, Ok(said)) => drop(weak(ui, said)),
        (None, Err(wrong)) => drop(ui.label(RichText::new(wrong).small().color(WRONG))),
    }
}

/// A part of the panel under a heading that folds.
fn section(ui: &mut Ui, title: &str, open: bool, body: impl FnOnce(&mut Ui)) {
    CollapsingHeader::new(RichText::new(title).strong()).default_open(open).show(ui, body);
}

fn light(ui: &mut Ui, controls: &mut Controls, places: &mut Places) -> Asked {
    let degrees = |value, range| Slider::new(value, range).suffix(" deg").fixed_decimals(0);
    let turn = ui.add(degrees(&mut controls.turn, -180.0..=180.0).text("environment"));
    note(places, "environment", &turn);
    ui.add(degrees(&mut controls.spin, -90.0..=90.0).text("a second"));
    ui.horizontal(|ui| {
        note(places, "stopped", &ui.checkbox(&mut controls.paused, "light stands still"));
        note(places, "walks", &ui.checkbox(&mut controls.walks, "figures walk"));
    });
    let exposure = ui.add(Slider::new(&mut controls.stops, -8.0..=8.0).suffix(" stops").text("exposure"));
    note(places, "exposure", &exposure);
    ui.horizontal(|ui| {
        ui.label("camera");
        note(places, "orbit", &ui.selectable_value(&mut controls.flies, false, "around"));
        note(places, "fly", &ui.selectable_value(&mut controls.flies, true, "fly"));
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

fn overlays(ui: &mut Ui, controls: &mut Controls, places: &mut Places) {
    let shown = &mut controls.shown;
    note(places, "handles", &ui.checkbox(&mut shown.handles, "lamps and figures to drag"));
    note(places, "samples", &ui.checkbox(&mut shown.samples, "samples of near emitters"));
    note(places, "spheres", &ui.checkbox(&mut shown.spheres, "spheres that cast shadows"));
}

fn left_out(ui: &mut Ui, told: &Told<'_>) {
    for left_out in told.left_out {
        ui.label(&left_out.what);
        weak(ui, &left_out.why);
    }
}
