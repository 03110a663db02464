//! `airglow view`: a scene, live, in a window.

use std::path::PathBuf;

use clap::Args;
use glam::DQuat;
use serde::Serialize;

use crate::commands::render::size;
use crate::failure::{Failure, Outcome};
use crate::global::Global;
use crate::host::device;
use crate::host::lighting;
use crate::host::machine::Machine;
use crate::host::settings::{Air, Settings};
use crate::host::source::Source;
use crate::measure::pass::{PassStat, timed};
use crate::output::Output;
use crate::scene_options::SceneOptions;
use crate::window::controls;
use crate::window::reload::Watch;
use crate::window::stage::Stage;
use crate::window::viewer::{Show, Shown, Viewer};
use crate::window::{Places, event_loop, instance_extensions};

/// Show a scene in a window: the frames of `airglow render`, live.
///
/// What the scene needs is baked first, or read from the cache. The light turns; the mouse moves the camera and the
/// light. The title tells frames a second and the device time of each pass.
#[derive(Debug, Args)]
#[command(after_help = format!("{}\n\nExamples:
  airglow view assets/scenes/spot.toml
  airglow view assets/scenes/demo.toml --size 1920x1080 --spin 0
  airglow view assets/scenes/spot.toml --frames 300 --json", controls::HELP))]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneOptions,
    /// Pixels of the window at first.
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "960x540", value_parser = size)]
    size: [u32; 2],
    /// Samples along each side of a pixel.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=4))]
    samples: u32,
    /// Quit after so many frames.
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    frames: Option<u32>,
    /// Turn the environment about the vertical axis to start with, degrees, counter-clockwise seen from above.
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, allow_hyphen_values = true)]
    turn: f64,
    /// Turn it further by so many degrees in each second.
    #[arg(long, value_name = "DEGREES", default_value_t = 20.0, allow_hyphen_values = true)]
    spin: f64,
    /// Factor from scene-linear values to the display to start with, instead of the scene file's.
    #[arg(long, value_name = "FACTOR")]
    exposure: Option<f32>,
    /// Where `p` writes pictures of the window, view.png unless told otherwise. With --frames the last one is written, too.
    #[arg(long, value_name = "FILE.png")]
    picture: Option<PathBuf>,
    /// Hide the panel at first; `h` brings it.
    #[arg(long)]
    bare: bool,
    /// Watch a folder like `shaders` and draw with those of the host's modules in its `spirv` that change from now on. What
    /// cannot be drawn with is told, and the last good ones stay. Kernels of passes are built into them and do not change.
    #[arg(long, value_name = "FOLDER")]
    shaders: Option<PathBuf>,
    /// With --shaders: what makes its modules when its GLSL changes, run by a shell, such as
    /// "cargo run -q -p xtask -- shaders --room host". What it says where it fails is told in the window.
    #[arg(long, value_name = "COMMAND", requires = "shaders")]
    compile: Option<String>,
}

/// What was shown, as `--json` prints it.
#[derive(Serialize)]
struct Stat {
    machine: Machine,
    frames: u32,
    frames_per_second: Option<f64>,
    /// Medians over the last frames.
    passes: Vec<PassStat>,
    /// Where parts of the panel were in the window, pixels: left, top, right and bottom. For scripts that play a user.
    panel: Places,
    /// Where the camera was at last.
    camera: CameraStat,
}

/// A camera in the world.
#[derive(Serialize)]
struct CameraStat {
    /// Metres.
    position: [f32; 3],
    /// Where it looks, of length 1.
    direction: [f32; 3],
}

/// Runs the command.
pub fn run(arguments: &Arguments, global: &Global, output: &Output) -> Outcome {
    // Without a display nothing is baked.
    let event_loop = event_loop()?;
    let extensions = instance_extensions(&event_loop)?;
    let scene = arguments.scene.load(output)?;
    let source = Source::of_scene(&scene, false, &arguments.scene.cache, output)?;
    let stat =
        device::with_window(global, &lighting::requirements(&source, &scene), &extensions, |device| {
            let mut start = settings(arguments);
            let (camera, stated) = (scene.camera(), scene.exposure);
            let cache = arguments.scene.cache.clone();
            let mut stage = Stage::new(device, scene, source, start.picture_size(), cache, output.clone())?;
            start.exposure = stage.renderer.exposure(arguments.exposure, stated, &start)?;
            let show = Show {
                title: format!("{}, airglow", arguments.scene.scene.display()),
                camera,
                start,
                spin: arguments.spin,
                frames: arguments.frames,
                picture: arguments.picture.clone().unwrap_or_else(|| PathBuf::from("view.png")),
                last_picture: arguments.picture.is_some() && arguments.frames.is_some(),
                bare: arguments.bare,
                watch: arguments.shaders.clone().map(|folder| Watch::new(folder, arguments.compile.clone())),
            };
            let mut viewer = Viewer::new(device, stage, show)?;
            event_loop.run_app(&mut viewer).map_err(Failure::work)?;
            Ok(stat(device.machine(), viewer.finish()?))
        })?;
    output.result(&stat, text)
}

fn settings(arguments: &Arguments) -> Settings {
    Settings {
        size: arguments.size,
        views: 1,
        samples: arguments.samples,
        exposure: 1.0,
        turn: DQuat::from_rotation_y(arguments.turn.to_radians()),
        spin: 0.0,
        without_shadow: false,
        count_shadow: false,
        share_transients: false,
        time: arguments.scene.time,
        step: 0.0,
        without_relight: false,
        air: Air::default(),
        window: None,
    }
}

fn stat(machine: Machine, shown: Shown) -> Stat {
    let Shown { frames, seconds, timing, places, camera } = shown;
    Stat {
        machine,
        frames,
        frames_per_second: (frames > 1).then(|| f64::from(frames - 1) / seconds),
        passes: timed(timing.as_ref()),
        panel: places,
        camera: CameraStat {
            position: camera.position().to_array(),
            direction: camera.direction().to_array(),
        },
    }
}

fn text(stat: &Stat) -> String {
    let mut text = format!("{} ({})\n", stat.machine.device, stat.machine.driver);
    text.extend(stat.passes.iter().map(PassStat::line));
    let rate = stat.frames_per_second.map_or(String::new(), |rate| format!(", {rate:.1} a second"));
    text.push_str(&format!("  {} frames shown{rate}\n", stat.frames));
    text
}
