//! `airglow plan`: what a frame does, and what it does without.

use clap::{Args, ValueEnum};
use glam::DQuat;

use crate::cli::Global;
use crate::commands::render::PassName;
use crate::commands::scene::SceneOptions;
use crate::failure::{Failure, Outcome};
use crate::host::renderer::{self, Renderer, Settings};
use crate::host::{device, transfer};
use crate::output::Output;

/// Print the plan of a frame: passes in order, barriers and their causes, memory; and what was left out, why, what
/// that saved, and what would bring it back.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  airglow plan assets/scenes/spot.toml
  airglow plan assets/scenes/spot.toml --as mermaid > plan.mmd
  airglow plan assets/mesh/spot.glb          no environment: relighting is left out, and the plan says so")]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneOptions,
    /// How the plan is written. JSON too with --json.
    #[arg(long = "as", value_enum, default_value_t = Form::Text)]
    form: Form,
    /// Leave a pass out.
    #[arg(long, value_enum)]
    without: Option<PassName>,
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
    let scene = arguments.scene.load(output)?;
    let baked = transfer::of_scene(&scene, &scene.quality, &arguments.scene.cache, output)?;
    let size = [960, 540];
    let text = device::with(global, &renderer::requirements(&scene), |device| {
        let mut renderer = Renderer::new(device, &scene, &baked, size)?;
        let settings = Settings {
            size,
            samples: 1,
            exposure: 1.0,
            turn: DQuat::IDENTITY,
            spin: 0.0,
            without_relight: arguments.without == Some(PassName::Relight),
        };
        if settings.without_relight && scene.environment.is_some() {
            renderer.measure_relight(&settings)?;
        }
        let plan = renderer.plan(&settings)?;
        let form = if output.json() { Form::Json } else { arguments.form };
        Ok(match form {
            Form::Text => plan.text(),
            Form::Mermaid => plan.mermaid(),
            Form::Json => plan.json().map_err(Failure::work)?,
        })
    })?;
    println!("{}", text.trim_end());
    Ok(())
}
