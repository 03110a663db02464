//! `airglow render`: a picture of a scene.

use std::path::{Path, PathBuf};

use airglow_scene::image_io::{write_exr, write_png_bytes};
use airglow_scene::{Scene, tone};
use clap::Args;
use glam::DQuat;

use crate::commands::debug;
use crate::commands::without::{PassName, Without};
use crate::failure::{Failure, Outcome};
use crate::files;
use crate::global::Global;
use crate::host::environment_samples::EnvironmentSamples;
use crate::host::filter::Filter;
use crate::host::lighting;
use crate::host::picture::{Picture, WARM_UP};
use crate::host::renderer::Renderer;
use crate::host::settings::{Air, Settings};
use crate::host::source::Source;
use crate::host::split::Split;
#[cfg(feature = "radiance")]
use crate::host::strip;
#[cfg(feature = "fog")]
use crate::host::{airs, complete::Road};
use crate::host::{device, truth};
use crate::measure::health;
#[cfg(feature = "radiance")]
use crate::measure::near::NearStat;
use crate::measure::profiler::ProfilerCost;
#[cfg(feature = "shadow")]
use crate::measure::shadow::ShadowStat;
use crate::measure::stat::Stat;
use crate::measure::trace::{self, Trace};
use crate::output::Output;
use crate::scene_options::SceneOptions;

/// Draw a scene and write the picture: scene-linear EXR, or exposed and tone-mapped PNG.
///
/// What the scene needs is baked first, or read from the cache. Without --frames a few frames are drawn so that the
/// times of the passes mean something; the last one is the picture.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  airglow render assets/scenes/spot.toml -o spot.png
  airglow render assets/scenes/spot.toml -o spot.exr --size 1920x1080 --stat spot.json --frames 200
  airglow render assets/scenes/spot.toml -o spot.png --frames 60 --trace spot.trace.json
  airglow render assets/scenes/spot.toml -o ambient.png --without relight
  airglow render assets/scenes/demo.toml -o both.png --without relight --without fog --split=diagonal
  airglow render assets/scenes/demo.toml -o pair.png --views 2
  airglow render assets/scenes/street.toml -o airs.png --compare-fog --size 640x540
  airglow render assets/scenes/lamp.toml -o lamp.png --strip 5 --size 320x360
  airglow render assets/scenes/grooves.toml -o truth.png --maps texels --samples 4 --passes 64
  airglow render assets/scenes/walkers.toml -o clusters.png --debug shadow-blockers
  airglow render assets/scenes/spot.toml -o truth.exr --reference")]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneOptions,
    /// Where the picture goes: .exr (scene-linear) or .png. May be given twice, for both.
    #[arg(long, short = 'o', value_name = "FILE", required = true)]
    output: Vec<PathBuf>,
    /// Pixels of each view.
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "960x540", value_parser = size)]
    size: [u32; 2],
    /// Views, drawn side by side into one picture from cameras in a row, 64 mm apart: 2 make a stereo pair.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=8))]
    views: u32,
    /// Samples along each side of a pixel.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=4))]
    samples: u32,
    /// Frames drawn, the first of them as warm-up.
    #[arg(long, default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    frames: u32,
    /// Turn the environment about the vertical axis, degrees, counter-clockwise seen from above.
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, allow_hyphen_values = true)]
    turn: f64,
    /// Turn it further by so many degrees in each frame: the light of a moving sun, from one plan.
    #[arg(
        long,
        value_name = "DEGREES",
        default_value_t = 0.0,
        allow_hyphen_values = true,
        conflicts_with = "reference"
    )]
    spin: f64,
    /// Seconds from one frame to the next: figures walk on, from one plan. The picture is the last frame.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, conflicts_with = "reference")]
    step: f64,
    /// Factor from scene-linear values to the display, instead of the scene file's.
    #[arg(long, value_name = "FACTOR")]
    exposure: Option<f32>,
    /// What stands for the normals of normal maps under a pixel.
    #[arg(long, value_enum, default_value_t = Filter::Lobes)]
    maps: Filter,
    /// Average so many passes into the picture, each moved by a fraction of a sample: hundreds of samples a pixel.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4096), conflicts_with_all = ["split", "views"])]
    passes: u32,
    #[command(flatten)]
    left_out: Without,
    /// With --without: show the left half of the picture without the passes and the right half with them.
    #[arg(long, requires = "without", value_enum, num_args = 0..=1, require_equals = true, default_missing_value = "half")]
    split: Option<Split>,
    /// Draw the scene's medium as exponential depth fog, of the mean colour of the picture by the fog pass.
    #[cfg(feature = "fog")]
    #[arg(long, conflicts_with_all = ["without", "compare_fog"])]
    depth_fog: bool,
    /// Draw surfaces in fog by the complete model in the forward draw, without the pass: a night scene with lamps.
    #[cfg(feature = "fog")]
    #[arg(long, value_enum, value_name = "WHERE", conflicts_with_all = ["without", "depth_fog", "compare_fog"])]
    complete: Option<CompleteName>,
    /// Draw the scene three times, side by side: in clear air, in exponential depth fog and by the fog pass.
    #[cfg(feature = "fog")]
    #[arg(long, conflicts_with = "without")]
    compare_fog: bool,
    /// Draw so many pictures side by side, while the emitters of the scene move from `center` to `to`.
    #[cfg(feature = "radiance")]
    #[arg(long, value_name = "PICTURES", value_parser = clap::value_parser!(u32).range(2..=16), conflicts_with_all = ["without", "passes", "reference", "spin"])]
    strip: Option<u32>,
    /// Light the vertices by the model's truth, ray-traced on the CPU, instead of the pass: distant light in clear air.
    #[arg(long, conflicts_with = "split")]
    reference: bool,
    /// Rays for each vertex of the reference.
    #[arg(long, default_value_t = 1024, value_name = "RAYS", value_parser = clap::value_parser!(u32).range(2..))]
    reference_rays: u32,
    /// Write device, times, counts and memory of the passes here, as JSON, and what measuring them costs.
    #[arg(long, value_name = "FILE.json")]
    stat: Option<PathBuf>,
    /// Have the device count what each pass makes it do, too: vertices, primitives, invocations of shaders.
    #[arg(long)]
    pipeline_statistics: bool,
    /// Have the passes count what is wrong with their inputs, too, and limits that they hit: texels of the environment that
    /// are not finite, and negative ones; pixels that fog cannot use; light, visibility and lobes that are not finite.
    #[arg(long)]
    health: bool,
    /// Have what a frame makes for itself hand memory on: the same picture from fewer bytes, which --stat counts.
    #[arg(long)]
    share_transients: bool,
    /// Draw what a pass holds or decides, in false colours with a legend, instead of the picture; an .exr gets the numbers.
    /// `list` names all views.
    #[arg(long, value_name = "VIEW", conflicts_with_all = ["split", "views", "passes", "reference", "stat", "trace"])]
    debug: Option<String>,
    /// Write the frames after warm-up on a time line here, CPU and GPU, as a trace for ui.perfetto.dev.
    #[arg(long, value_name = "FILE.json")]
    trace: Option<PathBuf>,
}

/// Where the complete model is evaluated.
#[cfg(feature = "fog")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum CompleteName {
    /// At each pixel.
    Pixels,
    /// At each vertex.
    Vertices,
}

/// Runs the command.
pub fn run(arguments: &Arguments, global: &Global, output: &Output) -> Outcome {
    for path in &arguments.output {
        check_extension(path)?;
    }
    let whole = arguments.scene.load(output)?;
    let bare = || arguments.left_out.scene(whole.clone());
    let scene = if arguments.split.is_some() { whole.clone() } else { bare() };
    let mut source = match arguments.reference {
        true => Source::Colours(reference(&scene, arguments, output)?),
        false => {
            Source::of_scene(&scene, arguments.leaves_out(PassName::Relight), &arguments.scene.cache, output)?
        }
    };
    if let Some(view) = &arguments.debug {
        let settings = settings(arguments);
        return debug::run(view, &scene, &source, settings, &arguments.output, (global, output));
    }
    if arguments.health {
        source.count_health();
    }
    let (picture, stat) = device::with(global, &lighting::requirements(&source, &scene), |device| {
        let mut settings = settings(arguments);
        let size = settings.picture_size();
        let (maps, count) = (arguments.maps, arguments.health);
        let mut renderer = Renderer::with_filter(device, &scene, &source, size, maps, count)?;
        if arguments.health {
            renderer.count_health()?;
        }
        settings.exposure = renderer.exposure(arguments.exposure, scene.exposure, &settings)?;
        let statistics = arguments.pipeline_statistics;
        let mut picture = arguments.picture(&mut renderer, &mut settings)?;
        if arguments.passes > 1 {
            picture.linear = renderer.average(&settings, arguments.passes)?;
            picture.display = tone::encode(&picture.linear, settings.exposure);
        }
        if let Some(split) = arguments.split {
            picture.replace_left(&arguments.other_half(device, &bare(), settings, output)?, split);
        }
        let cost = match (&arguments.stat, &picture.timing) {
            (Some(_), Some(timing)) => {
                ProfilerCost::measure(&mut renderer, &settings, statistics, timing.frames)?
            }
            _ => None,
        };
        if let Some(path) = &arguments.trace {
            write_trace(path, device, &picture)?;
        }
        let mut stat = Stat::new(device, &settings, &picture, cost);
        #[cfg(feature = "radiance")]
        {
            stat.near = renderer.near_samples(&settings)?.as_ref().map(NearStat::new);
        }
        #[cfg(feature = "shadow")]
        {
            stat.shadow =
                renderer.shadow_counts(&settings)?.map(|(spheres, counts)| ShadowStat::new(spheres, counts));
        }
        for health in renderer.health() {
            stat.health.extend(health::collect(device, health)?);
        }
        Ok((picture, stat))
    })?;
    for path in &arguments.output {
        write(path, &picture)?;
        output.say(format!("wrote {}", path.display()));
    }
    if let Some(path) = &arguments.stat {
        let json = serde_json::to_vec_pretty(&stat).map_err(Failure::work)?;
        files::write(path, &json)?;
    }
    output.result(&stat, Stat::text)
}

/// The settings of the frames but for their exposure.
fn settings(arguments: &Arguments) -> Settings {
    Settings {
        size: arguments.size,
        views: arguments.views,
        samples: arguments.samples,
        exposure: 1.0,
        turn: DQuat::from_rotation_y(arguments.turn.to_radians()),
        spin: arguments.spin.to_radians(),
        without_shadow: arguments.leaves_out(PassName::Shadow),
        count_shadow: false,
        time: arguments.scene.time,
        step: arguments.step,
        share_transients: arguments.share_transients,
        without_relight: arguments.leaves_out(PassName::Relight),
        air: Air::with_fog(!arguments.leaves_out(PassName::Fog)),
        window: None,
    }
}

impl Arguments {
    /// The frames asked for; `settings` become those of the last.
    fn picture(&self, renderer: &mut Renderer<'_>, settings: &mut Settings) -> Outcome<Picture> {
        let frames = self.frames as usize;
        #[cfg(feature = "radiance")]
        if let Some(moments) = self.strip {
            return strip::of_moving_emitters(renderer, settings, moments, frames);
        }
        #[cfg(feature = "fog")]
        if self.compare_fog {
            return airs::side_by_side(renderer, settings, frames);
        }
        #[cfg(feature = "fog")]
        if let Some(at) = self.complete {
            settings.air = Air::Complete(match at {
                CompleteName::Pixels => Road::Pixels,
                CompleteName::Vertices => Road::Vertices,
            });
        }
        #[cfg(feature = "fog")]
        if self.depth_fog {
            settings.air = airs::depth_fog(renderer, settings)?;
        }
        renderer.draw_counted(settings, frames, self.pipeline_statistics)
    }

    /// Whether a pass is left out of the whole picture.
    fn leaves_out(&self, pass: PassName) -> bool {
        self.left_out.has(pass) && self.split.is_none()
    }

    /// The picture of which a split one shows the left half: of the scene without what the passes left out need.
    fn other_half(
        &self,
        device: &device::Device<'_>,
        bare: &Scene,
        settings: Settings,
        output: &Output,
    ) -> Outcome<Picture> {
        let without_relight = self.left_out.has(PassName::Relight);
        let settings = Settings {
            without_relight,
            without_shadow: self.left_out.has(PassName::Shadow),
            air: if self.left_out.has(PassName::Fog) { Air::Clear } else { settings.air },
            ..settings
        };
        let source = Source::of_scene(bare, without_relight, &self.scene.cache, output)?;
        Renderer::new(device, bare, &source, settings.picture_size())?.draw(&settings, 1)
    }
}

/// Colours of all vertices of all instances by rays; shadows are cast as the bake casts them.
fn reference(scene: &Scene, arguments: &Arguments, output: &Output) -> Outcome<Vec<Vec<[f32; 3]>>> {
    let Some(environment) = &scene.environment else {
        return Err(Failure::input("--reference needs an environment; name one with --environment"));
    };
    let mut turned = environment.clone();
    turned.rotation = glam::Quat::from_rotation_y(arguments.turn.to_radians() as f32) * turned.rotation;
    let samples = EnvironmentSamples::new(&turned).map_err(Failure::input)?;
    truth::of_scene(scene, &samples, arguments.reference_rays, output)
}

/// The frames that were timed, on one time line.
fn write_trace(path: &Path, device: &device::Device<'_>, picture: &Picture) -> Outcome {
    if picture.frames.is_empty() {
        return Err(Failure::usage(format!("--trace needs timestamps and more than {WARM_UP} --frames")));
    }
    let trace = Trace {
        machine: device.machine(),
        passes: &picture.passes,
        frames: &picture.frames,
        seconds: &trace::seconds(device.context()),
        calibrations: picture.calibrations,
    };
    files::write(path, &serde_json::to_vec(&trace.json()).map_err(Failure::work)?)
}

fn check_extension(path: &Path) -> Outcome {
    match path.extension().and_then(|kind| kind.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("exr" | "png") => Ok(()),
        _ => Err(Failure::usage(format!("{}: name a .exr or .png file", path.display()))),
    }
}

fn write(path: &Path, picture: &Picture) -> Outcome {
    if path.extension().is_some_and(|kind| kind.eq_ignore_ascii_case("exr")) {
        return write_exr(path, &picture.linear).map_err(Failure::work);
    }
    let (width, height) = (picture.linear.width, picture.linear.height);
    write_png_bytes(path, width, height, &picture.display).map_err(Failure::work)
}

/// `WIDTHxHEIGHT`.
pub fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse().ok().filter(|side| (1..=8192).contains(side));
    let parsed = text.split_once('x').and_then(|(width, height)| Some([side(width)?, side(height)?]));
    parsed.ok_or_else(|| format!("`{text}` is no size; write it like 1280x720, sides from 1 to 8192"))
}

#[cfg(test)]
mod tests {
    use super::size;

    #[test]
    fn sizes_are_two_sides_within_reason() {
        assert_eq!(size("1280x720"), Ok([1280, 720]));
        for bad in ["1280", "0x4", "9999x1", "axb", "-1x2"] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }
}
