//! `airglow explain`: why a scene is lit with the settings it is lit with.

use airglow::math::Preset;
use airglow::relight::{Relight, Settings};
use airglow_graph::LeftOut;
use airglow_scene::{Quality, Scene, Shadow, Storage};
use clap::Args;
use serde::Serialize;

use crate::failure::Outcome;
use crate::global::Global;
use crate::host::machine::Machine;
use crate::host::{device, relight};
use crate::output::Output;
use crate::report::model::{Curve, Point};
use crate::report::pass::Pass;
use crate::report::presets::table::{self, Row};
use crate::report::relight::curves::Measurement;
use crate::report::relight::effort::Effort;
use crate::report::relight::workload::Workload;
use crate::scene_options::SceneOptions;
use crate::text::bytes;

/// Explain a pass's settings for a scene: what was chosen, its rivals, and the line of the curve that decided.
///
/// The curves are measured anew on this device with the scene's largest mesh, quickly; `airglow report` measures them
/// with care. Where the pass has nothing to do, it says what was left out, why, and what would bring it back.
#[derive(Debug, Args)]
#[command(after_help = "Example:
  airglow explain relight assets/scenes/spot.toml
  airglow explain fog assets/scenes/street.toml
  airglow explain normals assets/scenes/weave.toml
  airglow explain radiance assets/scenes/blocks.toml
  airglow explain shadow assets/scenes/walkers.toml")]
pub struct Arguments {
    /// The pass.
    #[arg(value_enum)]
    pass: Pass,
    #[command(flatten)]
    scene: SceneOptions,
}

#[derive(Serialize)]
struct Explanation {
    machine: Machine,
    workload: String,
    knobs: Vec<Knob>,
    /// As they were measured on the scene that shows the pass, on this device or the nearest that was.
    presets: Vec<Row>,
}

impl Explanation {
    fn new(pass: Pass, machine: Machine, workload: String, knobs: Vec<Knob>) -> Self {
        let row = |preset| table::find(pass.name(), preset, &machine.device).cloned();
        let presets = Preset::ALL.into_iter().filter_map(row).collect();
        Self { machine, workload, knobs, presets }
    }
}

/// A knob: the scene's setting, what the curve would choose, and the curve.
#[derive(Serialize)]
struct Knob {
    name: String,
    setting: String,
    source: String,
    /// What the times and bytes are of.
    timed: String,
    /// How errors are measured, and what their floor is.
    norm: String,
    /// What the curve asks, and the rule by which it chooses.
    question: String,
    curve_chooses: String,
    because: String,
    rivals: Vec<Rival>,
}

#[derive(Serialize)]
struct Rival {
    setting: String,
    milliseconds: Option<f64>,
    /// What the setting holds, bytes.
    memory: u64,
    /// What one frame moves, bytes.
    moved: u64,
    error_setting: Option<f64>,
    error_model: Option<f64>,
    error_model_p95: Option<f64>,
}

/// Runs the command.
pub fn run(arguments: &Arguments, global: &Global, output: &Output) -> Outcome {
    let scene = arguments.scene.load(output)?;
    #[cfg(feature = "fog")]
    if arguments.pass == Pass::Fog {
        return fog(&scene, global, output);
    }
    #[cfg(feature = "radiance")]
    if arguments.pass == Pass::Radiance {
        return radiance(&scene, &arguments.scene.cache, global, output);
    }
    #[cfg(feature = "normals")]
    if arguments.pass == Pass::Normals {
        return normals(scene, global, output);
    }
    #[cfg(feature = "shadow")]
    if arguments.pass == Pass::Shadow {
        return shadow(&scene, global, output);
    }
    if scene.environment.is_none() {
        let left_out = relight::no_environment(relight::bytes(&scene), None);
        return output.result(&left_out, left_out_text);
    }
    let effort = Effort::new(true);
    let workload = Workload::new(&scene, &effort, output)?;
    let requirements = Relight::requirements(&Settings { order: 6, ..Settings::default() });
    let explanation = device::with(global, &requirements, |device| {
        let measurement = Measurement { device, workload: &workload, effort: &effort, output };
        let quality = &scene.quality;
        let knobs = vec![
            knob(measurement.order()?, quality.order.to_string(), stated(&scene, arguments, "order")),
            knob(measurement.rays()?, format!("{} rays", quality.rays), stated(&scene, arguments, "rays")),
            knob(measurement.storage()?, storage_name(quality), stated(&scene, arguments, "storage")),
            knob(measurement.method()?, "compute".to_owned(), "the pass's default".to_owned()),
        ];
        Ok(Explanation::new(Pass::Relight, device.machine(), workload.description.clone(), knobs))
    })?;
    output.result(&explanation, |explanation| text(explanation, Some(scene.quality.shadow)))
}

/// The knobs of fog, none of which a scene file names.
#[cfg(feature = "fog")]
fn fog(scene: &Scene, global: &Global, output: &Output) -> Outcome {
    use crate::report::fog::{Effort, Measurement};
    let settings = airglow::fog::Settings::default();
    if scene.medium.is_none() {
        let left_out = crate::host::fog::no_medium();
        return output.result(&left_out, left_out_text);
    }
    let explanation = device::with(global, &airglow::fog::Fog::requirements(&settings), |device| {
        let (workload, curves) = Measurement { device, effort: Effort::new(true), output }.explain(scene)?;
        let shipped =
            |curve: &Curve| curve.chosen.as_ref().map_or(String::new(), |chosen| chosen.setting.clone());
        let knobs = curves.into_iter().map(|curve| {
            let setting = shipped(&curve);
            knob(curve, setting, "the pass's default".to_owned())
        });
        Ok(Explanation::new(Pass::Fog, device.machine(), workload, knobs.collect()))
    })?;
    output.result(&explanation, |explanation| text(explanation, None))
}

/// The knobs of near emitters, none of which a scene file names but the order.
#[cfg(feature = "radiance")]
fn radiance(scene: &Scene, cache: &std::path::Path, global: &Global, output: &Output) -> Outcome {
    use crate::host::near;
    use crate::report::radiance::{Effort, Measurement, Workload};
    if let Some(left_out) = near::left_out(scene, false) {
        return output.result(&left_out, left_out_text);
    }
    let explanation = device::with(global, &near::measured_requirements(), |device| {
        let workload = Workload::new(device, scene, cache, output)?;
        let measurement = Measurement { device, workload: &workload, effort: Effort::new(true), output };
        let shipped =
            |curve: &Curve| curve.chosen.as_ref().map_or(String::new(), |chosen| chosen.setting.clone());
        let knobs = measurement.knobs()?.into_iter().map(|curve| {
            let setting = shipped(&curve);
            knob(curve, setting, "the pass's default".to_owned())
        });
        let (machine, workload) = (device.machine(), workload.description.clone());
        Ok(Explanation::new(Pass::Radiance, machine, workload, knobs.collect()))
    })?;
    output.result(&explanation, |explanation| text(explanation, Some(scene.quality.shadow)))
}

/// What is kept of each normal map, chosen by its material.
#[cfg(feature = "normals")]
fn normals(scene: Scene, global: &Global, output: &Output) -> Outcome {
    use crate::report::normals::{Effort, Map, Measurement, requirements};
    let maps = Map::of_scenes(&[scene])?;
    let explanation = device::with(global, &requirements(), |device| {
        let curves = Measurement { device, effort: Effort::new(true), output }.explain(&maps)?;
        let knobs = curves.into_iter().map(|curve| {
            let setting = curve.chosen.as_ref().map_or(String::new(), |chosen| chosen.setting.clone());
            knob(curve, setting, "the map and its material".to_owned())
        });
        let workload = maps.iter().map(Map::words).collect::<Vec<_>>().join(", ");
        Ok(Explanation::new(Pass::Normals, device.machine(), workload, knobs.collect()))
    })?;
    output.result(&explanation, |explanation| text(explanation, None))
}

/// The knobs of shadows, none of which a scene file names but the order.
#[cfg(feature = "shadow")]
fn shadow(scene: &Scene, global: &Global, output: &Output) -> Outcome {
    use crate::report::shadow::{Effort, Measurement};
    if !crate::host::shadow::is_drawn(scene) {
        let left_out = crate::host::shadow::left_out(scene);
        return output.result(&left_out, left_out_text);
    }
    let explanation = device::with(global, &airglow::shadow::Shadow::requirements(), |device| {
        let (workload, curves) = Measurement { device, effort: Effort::new(true), output }.explain(scene)?;
        let knobs = curves.into_iter().map(|curve| match curve.knob.as_str() {
            "order" => {
                let is_default = scene.quality.order == Quality::default().order;
                let source = if is_default { "the default" } else { "the scene file or the command line" };
                knob(curve, format!("order {}", scene.quality.order), source.to_owned())
            }
            _ => {
                let setting = curve.chosen.as_ref().map_or(String::new(), |chosen| chosen.setting.clone());
                knob(curve, setting, "the pass's default".to_owned())
            }
        });
        Ok(Explanation::new(Pass::Shadow, device.machine(), workload, knobs.collect()))
    })?;
    output.result(&explanation, |explanation| text(explanation, None))
}

fn left_out_text(left_out: &LeftOut) -> String {
    format!(
        "{} is left out: {}.\nThat saves {} of device memory; nothing is baked and nothing runs.\nIt returns with {}.\n",
        left_out.what,
        left_out.why,
        bytes(left_out.bytes),
        left_out.would_return
    )
}

fn storage_name(quality: &Quality) -> String {
    if quality.storage == Storage::F16 { "f16" } else { "f32" }.to_owned()
}

/// Who chose a setting: the command line, the scene, or nobody.
fn stated(scene: &Scene, arguments: &Arguments, knob: &str) -> String {
    let options = &arguments.scene;
    let (default, quality) = (Quality::default(), &scene.quality);
    let (on_command_line, is_default) = match knob {
        "order" => (options.order.is_some(), quality.order == default.order),
        "rays" => (options.rays.is_some(), quality.rays == default.rays),
        _ => (options.storage.is_some(), quality.storage == default.storage),
    };
    match (on_command_line, is_default) {
        (true, _) => "the command line",
        (false, true) => "the default",
        (false, false) => "the scene file",
    }
    .to_owned()
}

fn knob(curve: Curve, setting: String, source: String) -> Knob {
    let (curve_chooses, because) = curve
        .chosen
        .map_or(("nothing".to_owned(), "the curve has no model error".to_owned()), |c| (c.setting, c.reason));
    let rivals = curve.points.iter().map(rival).collect();
    let Curve { knob: name, timed, norm, question, .. } = curve;
    Knob { name, setting, source, timed, norm, question, curve_chooses, because, rivals }
}

fn rival(point: &Point) -> Rival {
    Rival {
        setting: point.setting.clone(),
        milliseconds: point.time().map(|time| time.median),
        memory: point.memory,
        moved: point.counts.bytes,
        error_setting: point.error.setting,
        error_model: point.error.model,
        error_model_p95: point.error.model_p95,
    }
}

fn text(explanation: &Explanation, shadow: Option<Shadow>) -> String {
    let machine = &explanation.machine;
    let mut text = format!("{}\n{} ({})\n", explanation.workload, machine.device, machine.driver);
    if machine.software {
        text.push_str("This device computes on the CPU: the order of rivals may differ on a GPU.\n");
    }
    if let Some(shadow) = shadow {
        text.push_str(&format!("shadows: {shadow:?}\n"));
    }
    for knob in &explanation.knobs {
        let Knob { name, setting, source, timed, norm, question, curve_chooses, because, rivals } = knob;
        text.push_str(&format!("\n{name}: {setting}, chosen by {source}\n"));
        text.push_str(&format!("  the curve chooses {curve_chooses}: {because}\n"));
        text.push_str(&format!("  {question}\n  timed: {timed}\n  error: {norm}\n"));
        text.push_str("  setting          median ms        held  moved a frame  setting error  model error    model p95\n");
        for rival in rivals {
            let number = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.2e}"));
            let mark = if rival.setting == *setting { "*" } else { " " };
            text.push_str(&format!(
                "{mark} {:14} {:>11} {:>11} {:>14} {:>14} {:>12} {:>12}\n",
                rival.setting,
                rival.milliseconds.map_or("-".to_owned(), |ms| format!("{ms:.4}")),
                bytes(rival.memory),
                bytes(rival.moved),
                number(rival.error_setting),
                number(rival.error_model),
                number(rival.error_model_p95)
            ));
        }
    }
    if let Some(row) = explanation.presets.first() {
        text.push_str(&format!(
            "\npresets, measured on {}\n  timed: {}\n  error: {}\n",
            row.date, row.timed, row.norm
        ));
        explanation.presets.iter().for_each(|row| text.push_str(&format!("  {}\n", row.words())));
    }
    text
}
