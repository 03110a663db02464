//! The rows of the panel for each pass: switch, time as it is measured now, preset and knobs with what was measured of
//! them before.

use airglow_math::Preset;
use egui::collapsing_header::CollapsingState;
use egui::{Align, Layout, Slider, Ui};

use super::controls::Controls;
use super::interface::{Places, note};
use super::kept;
use super::style::{milliseconds, weak};
use super::told::Told;
use super::wish::{KNOBS, Wish};
use crate::report::presets::table;
use crate::scene_options::ROOMS;
use crate::text::bytes;

/// The passes in the order in which light travels.
const ORDER: [&str; 5] = ["radiance", "shadow", "relight", "normals", "fog"];

/// A row for each pass.
pub fn show(ui: &mut Ui, controls: &mut Controls, wish: &mut Wish, told: &Told<'_>, places: &mut Places) {
    for room in ORDER {
        let time = told.times.of(room);
        let open = told.present.contains(&room);
        let id = ui.make_persistent_id(("room", room));
        let state = CollapsingState::load_with_default_open(ui.ctx(), id, open);
        let header = state.show_header(ui, |ui| {
            let drawn = match room {
                "relight" => &mut controls.passes.relight,
                "shadow" => &mut controls.passes.shadow,
                "fog" => &mut controls.passes.fog,
                "radiance" => &mut wish.radiance,
                _ => &mut wish.normals,
            };
            note(places, room, &ui.checkbox(drawn, room));
            let said = match (time, room) {
                (Some(time), _) => milliseconds(time),
                (None, "normals") if open && wish.normals => "in the scene draw".to_owned(),
                _ if told.times.names().is_empty() => "not timed yet".to_owned(),
                _ => "not in the plan".to_owned(),
            };
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| weak(ui, &said));
        });
        header.body(|ui| {
            preset(ui, room, wish, told, places);
            for (place, knob) in KNOBS.iter().enumerate().filter(|(_, knob)| knob.room == room) {
                if let Some(value) = told.values[place] {
                    let label = format!("{} {}", knob.name, knob.unit);
                    turn(ui, room, (knob.name, &label), value, &mut wish.values[place], places);
                }
            }
            if room == "fog" && open {
                medium(ui, wish, told, places);
            }
        });
    }
}

/// The preset of a pass, and what was measured of it.
fn preset(ui: &mut Ui, room: &str, wish: &mut Wish, told: &Told<'_>, places: &mut Places) {
    let Some(place) = ROOMS.iter().position(|name| *name == room) else { return };
    let asked = wish.presets[place].or(told.presets.of(room));
    let present = asked.unwrap_or_default();
    let mut index = Preset::ALL.iter().position(|preset| *preset == present).unwrap_or(1);
    let name = |index: f64, _| Preset::ALL.get(index as usize).map_or(String::new(), Preset::to_string);
    let slider = Slider::new(&mut index, 0..=Preset::ALL.len() - 1).custom_formatter(name);
    let response = ui.add(slider.text("preset"));
    note(places, &format!("{room} preset"), &response);
    if response.changed() {
        wish.presets[place] = Preset::ALL.get(index).copied();
        // A preset says anew what knobs turned before.
        for (knob, value) in KNOBS.iter().zip(&mut wish.values) {
            if knob.room == room {
                *value = None;
            }
        }
        return;
    }
    match table::find(room, present, told.device) {
        _ if asked.is_none() && room == "radiance" => {
            drop(weak(ui, "of the scene: not measured as a preset"))
        }
        Some(row) => {
            let error = row.error.model.or(row.error.setting);
            let words = measured(error, Some(row.milliseconds), &row.device);
            let hint = format!("{}, {}\nError: {}\nTimed: {}", row.device, row.date, row.norm, row.timed);
            weak(ui, &format!("{words}, {}", bytes(row.bytes))).on_hover_text(hint);
        }
        None => drop(weak(ui, "not measured")),
    }
}

/// A knob, which stops at the values that were measured.
fn turn(
    ui: &mut Ui,
    room: &str,
    (name, label): (&str, &str),
    value: f64,
    asked: &mut Option<f64>,
    places: &mut Places,
) {
    let rows = kept::values(room, name);
    // Shadows and near emitters have kernels of 3 to 6 bands.
    let rows: Vec<_> = rows.into_iter().filter(|row| name != "order" || row.value >= 3.0).collect();
    let apart = |row: &&kept::Measured| (row.value.max(1e-9).ln() - value.max(1e-9).ln()).abs();
    let nearest = (0..rows.len()).min_by(|a, b| apart(&rows[*a]).total_cmp(&apart(&rows[*b])));
    let Some(mut index) = nearest else {
        weak(ui, &format!("{label}: {value}, not measured"));
        return;
    };
    let before = index;
    let text = |at: f64, _| match rows.get(at as usize) {
        Some(row) if at as usize != before => row.value.to_string(),
        _ => value.to_string(),
    };
    let slider = Slider::new(&mut index, 0..=rows.len() - 1).custom_formatter(text);
    let response = ui.add(slider.text(label));
    note(places, &format!("{room} {name}"), &response);
    if response.changed() {
        *asked = rows.get(index).map(|row| row.value);
        return;
    }
    match rows.get(index).filter(|row| (row.value - value).abs() <= 1e-6 * value.abs()) {
        Some(row) => {
            weak(ui, &measured(row.error, row.milliseconds, &row.device)).on_hover_text(&row.how);
        }
        None => drop(weak(ui, "not measured at this value")),
    }
}

/// The medium, of which nothing was measured: it is no quality.
fn medium(ui: &mut Ui, wish: &mut Wish, told: &Told<'_>, places: &mut Places) {
    let density = Slider::new(&mut wish.density, 0.05..=20.0).logarithmic(true).text("density, the scene's");
    note(places, "density", &ui.add(density));
    let mut anisotropy = wish.anisotropy.or(told.medium.map(|medium| medium.anisotropy)).unwrap_or_default();
    let slider = ui.add(Slider::new(&mut anisotropy, -0.95..=0.95).text("g of its phase function"));
    note(places, "anisotropy", &slider);
    if slider.changed() {
        wish.anisotropy = Some(anisotropy);
    }
}

/// What was measured, and on what device.
fn measured(error: Option<f64>, time: Option<f64>, device: &str) -> String {
    let device = device.split(" (").next().unwrap_or(device);
    let error = error.map_or("error not measured".to_owned(), |error| format!("error {error:.1e}"));
    let time = time.map_or("time not measured".to_owned(), |time| milliseconds(time as f32));
    format!("kept, {device}: {error}, {time}")
}
