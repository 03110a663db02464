//! `airglow plan`: what a frame does, and what it does without.

use std::collections::BTreeMap;

use airglow_scene::Scene;
use clap::{Args, ValueEnum};
use glam::DQuat;

use crate::commands::what_if;
use crate::commands::without::{PassName, Without};
use crate::failure::{Failure, Outcome};
use crate::global::Global;
use crate::host::device::{self, Device};
use crate::host::lighting;
use crate::host::permutations;
use crate::host::picture::WARM_UP;
use crate::host::renderer::Renderer;
use crate::host::settings::{Air, Settings};
use crate::host::source::Source;
use crate::measure::pass::{PassStat, counted};
use crate::output::{Output, print};
use crate::report::presets::table::{self, Row};
use crate::scene_options::SceneOptions;

/// Frames drawn for `--measure`.
const MEASURED_FRAMES: usize = WARM_UP + 9;

/// Print the plan of a frame: passes in order, barriers and their causes, memory; and what was left out, why, what
/// that saved, and what would bring it back.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  airglow plan assets/scenes/spot.toml
  airglow plan assets/scenes/spot.toml --as mermaid > plan.mmd
  airglow plan assets/scenes/spot.toml --check             have its barriers replayed
  airglow plan assets/scenes/spot.toml --measure           with time and counts of each pass
  airglow plan assets/scenes/spot.toml --without relight --measure      what it would take
  airglow plan assets/scenes/spot.toml --what-if order=6 --what-if storage=f16      what that would change
  airglow plan assets/mesh/spot.glb          no environment: relighting is left out, and the plan says so")]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneOptions,
    /// How the plan is written. JSON too with --json.
    #[arg(long = "as", value_enum, default_value_t = Form::Text)]
    form: Form,
    #[command(flatten)]
    left_out: Without,
    /// Draw a few frames, and list time and counts of each pass. With --without also the time that leaving it out
    /// saves: it is baked and drawn with, and dropped again.
    #[arg(long)]
    measure: bool,
    /// Replay every barrier over every subresource by a checker that shares no code with the compiler.
    #[arg(long)]
    check: bool,
    /// Print only what a change would add or take away: passes, bytes, barriers, pipelines. May be given several times;
    /// an unknown key lists those there are.
    #[arg(long, value_name = "KEY=VALUE", conflicts_with_all = ["form", "measure", "check"])]
    what_if: Vec<String>,
    /// Views of the frame.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=8))]
    views: u32,
}

/// `--as`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Form {
    /// Lines made to be read and diffed.
    Text,
    /// A diagram for mermaid.
    Mermaid,
    /// Data.
    Json,
}

/// Runs the command.
pub fn run(arguments: &Arguments, global: &Global, output: &Output) -> Outcome {
    let loaded = arguments.scene.load(output)?;
    let scene = arguments.left_out.scene(loaded.clone());
    let (without, cache) = (arguments.left_out.has(PassName::Relight), &arguments.scene.cache);
    let settings = frame(arguments);
    if !arguments.what_if.is_empty() {
        return what_if::run(&scene, &settings, &arguments.what_if, global, output);
    }
    let source = Source::of_scene(&scene, without, cache, output)?;
    let compared = arguments.measure && without;
    let whole = compared.then(|| Source::of_scene(&scene, false, cache, output)).transpose()?;
    let requirements = lighting::requirements(whole.as_ref().unwrap_or(&source), &scene);
    let text = device::with(global, &requirements, |device| {
        let seconds = match &whole {
            Some(whole) => measure(device, &scene, whole, &settings)?,
            None => None,
        };
        let mut renderer = Renderer::new(device, &scene, &source, settings.picture_size())?;
        renderer.say_relight_takes(seconds);
        arguments.left_out.say(&mut renderer, &loaded);
        let plan = renderer.plan(&settings)?;
        if arguments.check {
            let report = airglow_checker::check(&plan).map_err(Failure::check)?;
            output.say(report.to_string().trim_end());
        }
        let passes = match arguments.measure {
            true => {
                let picture = renderer.draw(&settings, MEASURED_FRAMES)?;
                Some(counted(&picture.passes, picture.timing.as_ref()))
            }
            false => None,
        };
        let presets = table::asked(&scene.presets, &device.machine().device);
        let form = if output.json() { Form::Json } else { arguments.form };
        Ok(match form {
            Form::Text => {
                let measured = passes.map_or(String::new(), |passes| measured(&passes));
                plan.text() + &measured + &table::text(&presets)
            }
            Form::Mermaid => plan.mermaid(),
            Form::Json => {
                let steps: Vec<&str> = plan.steps().iter().map(|step| step.name.as_str()).collect();
                let permutations = permutations::of_frame(&scene, &steps);
                with_more(plan.json().map_err(Failure::work)?, passes, &presets, permutations)?
            }
        })
    })?;
    print(&text)
}

/// The frame asked for.
fn frame(arguments: &Arguments) -> Settings {
    Settings {
        size: [960, 540],
        views: arguments.views,
        samples: 1,
        exposure: 1.0,
        turn: DQuat::IDENTITY,
        spin: 0.0,
        without_shadow: arguments.left_out.has(PassName::Shadow),
        count_shadow: false,
        share_transients: false,
        time: arguments.scene.time,
        step: 0.0,
        without_relight: arguments.left_out.has(PassName::Relight),
        air: Air::with_fog(!arguments.left_out.has(PassName::Fog)),
        window: None,
    }
}

/// The passes measured, as lines below those of the plan.
fn measured(passes: &[PassStat]) -> String {
    let lines: String = passes.iter().map(PassStat::line).collect();
    format!("measured (median, 5th to 95th percentile; counts are the same on every machine)\n{lines}")
}

/// The plan as JSON, with what decides its shaders as `permutations`, the passes measured as `measured`, and what presets
/// took as `presets`.
fn with_more(
    plan: String,
    passes: Option<Vec<PassStat>>,
    presets: &[&Row],
    permutations: BTreeMap<&str, String>,
) -> Outcome<String> {
    let mut plan: serde_json::Value = serde_json::from_str(&plan).map_err(Failure::work)?;
    plan["permutations"] = serde_json::to_value(permutations).map_err(Failure::work)?;
    if let Some(passes) = passes {
        plan["measured"] = serde_json::to_value(passes).map_err(Failure::work)?;
    }
    if !presets.is_empty() {
        plan["presets"] = serde_json::to_value(presets).map_err(Failure::work)?;
    }
    serde_json::to_string_pretty(&plan).map_err(Failure::work)
}

/// What the pass takes in a frame that has it, seconds.
fn measure(device: &Device<'_>, scene: &Scene, source: &Source, settings: &Settings) -> Outcome<Option<f64>> {
    let mut renderer = Renderer::new(device, scene, source, settings.picture_size())?;
    renderer.measure_relight(&Settings { without_relight: false, ..*settings })
}
