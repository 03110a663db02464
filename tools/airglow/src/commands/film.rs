//! `airglow film`: a scene while its figures walk and its lamps move, frame by frame, and how steady the frames are.

use std::path::PathBuf;

use airglow_scene::Scene;
use airglow_scene::image_io::write_png_bytes;
use clap::Args;
use glam::{Mat4, Vec3};
use serde::Serialize;

use crate::commands::render::size;
use crate::failure::{Failure, Outcome};
use crate::files;
use crate::global::Global;
use crate::host::lighting;
use crate::host::machine::Machine;
use crate::host::picture::Picture;
use crate::host::renderer::Renderer;
use crate::host::settings::Settings;
use crate::host::source::Source;
use crate::host::{device, strip};
use crate::output::Output;
use crate::report::steadiness;
use crate::scene_options::SceneOptions;

/// Draw a scene while its figures walk and its emitters go their ways: every frame as PNG, a strip of some, and how much
/// each differs from the one before.
///
/// Only pixels that no figure covers count where steadiness is meant: those that are the same bits in three frames
/// without shadows. Of them, smooth shadows have second differences far below the first ones; frames that flicker at
/// random have them 1.73 times as large. Where emitters move, or the camera, no pixel stays the same, and none is counted.
#[derive(Debug, Args)]
#[command(after_help = "Example:
  airglow film assets/scenes/walkers.toml -o out/walk --frames 60 --step 0.02 --size 480x270
  airglow film assets/scenes/demo.toml -o out/dusk --frames 24 --step 0.1 --fly 0.5,0,1")]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneOptions,
    /// Folder for `frame-000.png` and so on, `strip.png`, `difference.svg` and `film.json`.
    #[arg(long, short = 'o', value_name = "FOLDER")]
    output: PathBuf,
    /// Pixels of a frame.
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "480x270", value_parser = size)]
    size: [u32; 2],
    /// Samples along each side of a pixel.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=4))]
    samples: u32,
    /// Frames.
    #[arg(long, default_value_t = 60, value_parser = clap::value_parser!(u32).range(3..=10_000))]
    frames: u32,
    /// Seconds from one frame to the next.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.02)]
    step: f64,
    /// Way of the camera over the whole film: metres to its right, upwards and forwards.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = way)]
    fly: Option<Vec3>,
    /// Frames of the strip.
    #[arg(long, value_name = "FRAMES", default_value_t = 6, value_parser = clap::value_parser!(u32).range(1..=12))]
    strip: u32,
    /// Factor from scene-linear values to the display, instead of the scene file's.
    #[arg(long, value_name = "FACTOR")]
    exposure: Option<f32>,
}

/// What was drawn, as `film.json` has it.
#[derive(Serialize)]
struct Film {
    machine: Machine,
    frames: u32,
    step: f64,
    /// Root mean square of a frame's difference from the one before, over the mean radiance, all pixels.
    picture: Vec<f64>,
    /// The same of the pixels that no figure covers, with shadows.
    first: Vec<f64>,
    /// Their second differences.
    second: Vec<f64>,
    /// All second differences over all first ones: far below 1 for what moves smoothly, 1.73 for what flickers at random.
    unsteadiness: f64,
}

/// Runs the command.
pub fn run(arguments: &Arguments, global: &Global, output: &Output) -> Outcome {
    let scene = arguments.scene.load(output)?;
    let source = Source::of_scene(&scene, false, &arguments.scene.cache, output)?;
    let film = device::with(global, &lighting::requirements(&source, &scene), |device| {
        let start = Settings { samples: arguments.samples, ..Settings::plain(arguments.size) };
        let mut renderer = Renderer::new(device, &scene, &source, arguments.size)?;
        let settings = Settings {
            exposure: renderer.exposure(arguments.exposure, scene.exposure, &start)?,
            time: arguments.scene.time,
            ..start
        };
        arguments.draw(&mut renderer, &settings, &scene, output, device.machine())
    })?;
    if !film.second.is_empty() {
        let plot = steadiness::svg(&film.first, &film.second)?;
        files::write(&arguments.output.join("difference.svg"), plot.as_bytes())?;
    }
    let json = serde_json::to_vec_pretty(&film).map_err(Failure::work)?;
    files::write(&arguments.output.join("film.json"), &json)?;
    output.result(&film, |film| {
        let written =
            format!("{} frames, {} s apart, in {}", film.frames, film.step, arguments.output.display());
        if film.second.is_empty() {
            return written;
        }
        format!(
            "{written}\nfirst differences {:.2e}, second {:.2e} of the mean radiance where no figure is: \
             unsteadiness {:.2} (1.73 would be noise)",
            mean(&film.first),
            mean(&film.second),
            film.unsteadiness
        )
    })
}

impl Arguments {
    fn draw(
        &self,
        renderer: &mut Renderer<'_>,
        settings: &Settings,
        scene: &Scene,
        output: &Output,
        machine: Machine,
    ) -> Outcome<Film> {
        let bar = output.progress("frames", self.frames.into(), "frames");
        let (mut last, mut strip) = (Vec::new(), Vec::new());
        let (mut picture, mut first, mut second) = (Vec::new(), Vec::new(), Vec::new());
        let stays = self.fly.is_none() && scene.emitters.iter().all(|emitter| emitter.to.is_none());
        for frame in 0..self.frames {
            self.move_along(renderer, scene, frame as f32 / (self.frames - 1) as f32);
            let time = settings.time + self.step * f64::from(frame);
            let shown = renderer.draw(&Settings { time, ..*settings }, 1)?;
            write_frame(&self.output.join(format!("frame-{frame:03}.png")), &shown)?;
            if stays {
                let plain = renderer.draw(&Settings { time, without_shadow: true, ..*settings }, 1)?;
                last.push([shown.linear.pixels.clone(), plain.linear.pixels]);
            }
            if strip.len() < self.strip as usize && frame * self.strip >= strip.len() as u32 * self.frames {
                strip.push(shown);
            }
            if let [.., [before, _], [now, _]] = &last[..] {
                picture.push(difference(now, before));
            }
            if let [a, b, c] = &last[..] {
                let [once, twice] = still_differences([a, b, c]);
                first.push(once);
                second.push(twice);
                last.remove(0);
            }
            bar.inc(1);
        }
        bar.finish_and_clear();
        let (linear, display) = strip::joined(&strip);
        let path = self.output.join("strip.png");
        write_png_bytes(&path, linear.width, linear.height, &display).map_err(Failure::work)?;
        let unsteadiness = mean(&second) / mean(&first).max(f64::MIN_POSITIVE);
        Ok(Film { machine, frames: self.frames, step: self.step, picture, first, second, unsteadiness })
    }

    /// Moves emitters and camera to `part` of their ways.
    fn move_along(&self, renderer: &mut Renderer<'_>, scene: &Scene, part: f32) {
        #[cfg(feature = "radiance")]
        renderer.move_emitters(part);
        if let Some(Vec3 { x, y, z }) = self.fly {
            let mut camera = scene.camera();
            camera.transform *= Mat4::from_translation(part * Vec3::new(x, y, -z));
            renderer.look(camera);
        }
    }
}

fn write_frame(path: &std::path::Path, picture: &Picture) -> Outcome {
    let (width, height) = (picture.linear.width, picture.linear.height);
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|error| Failure::file(folder, "making the folder", error))?;
    }
    write_png_bytes(path, width, height, &picture.display).map_err(Failure::work)
}

/// `X,Y,Z`.
fn way(text: &str) -> Result<Vec3, String> {
    let numbers: Option<Vec<f32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y, z]) if [x, y, z].iter().all(|number| number.is_finite()) => Ok(Vec3::new(x, y, z)),
        _ => Err(format!("`{text}` is no way; write it like 0.5,0,1.2")),
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Root mean square of the difference over the mean.
fn difference(a: &[[f32; 3]], b: &[[f32; 3]]) -> f64 {
    let pairs = a.as_flattened().iter().zip(b.as_flattened());
    let (square, sum) = pairs.fold((0.0, 0.0), |(square, sum), (a, b)| {
        let step = f64::from(*a) - f64::from(*b);
        (square + step * step, sum + f64::from(*a))
    });
    let count = a.as_flattened().len().max(1) as f64;
    (square / count).sqrt() / (sum / count).abs().max(f64::MIN_POSITIVE)
}

/// First and second differences of three frames, each with and without shadows, where those without are the same bits; as
/// [`difference`].
fn still_differences([a, b, c]: [&[Vec<[f32; 3]>; 2]; 3]) -> [f64; 2] {
    let (mut first, mut second, mut sum, mut count) = (0.0, 0.0, 0.0, 0.0);
    for pixel in (0..b[0].len()).filter(|&pixel| a[1][pixel] == b[1][pixel] && b[1][pixel] == c[1][pixel]) {
        for channel in 0..3 {
            let [a, b, c] = [a, b, c].map(|frame| f64::from(frame[0][pixel][channel]));
            first += (c - b) * (c - b);
            second += (c - 2.0 * b + a) * (c - 2.0 * b + a);
            sum += b;
            count += 1.0;
        }
    }
    let scale = f64::sqrt(count) / f64::max(sum, f64::MIN_POSITIVE);
    [f64::sqrt(first) * scale, f64::sqrt(second) * scale]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_moves_evenly_has_no_second_difference_and_covered_pixels_do_not_count() {
        let frame = |value: f32, plain: f32| [vec![[value; 3], [9.0 * plain; 3]], vec![[1.0; 3], [plain; 3]]];
        let frames = [frame(1.0, 1.0), frame(2.0, 5.0), frame(3.0, 2.0)];
        let [first, second] = still_differences([&frames[0], &frames[1], &frames[2]]);
        assert!((first - 0.5).abs() < 1e-12 && second == 0.0, "{first} {second}");
        let shaking = [frame(1.0, 1.0), frame(2.0, 5.0), frame(1.0, 2.0)];
        let [first, second] = still_differences([&shaking[0], &shaking[1], &shaking[2]]);
        assert!((second / first - 2.0).abs() < 1e-12, "{first} {second}");
        assert!((difference(&[[3.0; 3]], &[[2.0; 3]]) - 1.0 / 3.0).abs() < 1e-12);
    }
}
