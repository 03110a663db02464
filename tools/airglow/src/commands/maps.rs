//! `airglow maps`: the normal maps of a scene filtered in every way, beside the truth.

use std::path::{Path, PathBuf};

use airglow_math::statistics::relative_l2;
use airglow_scene::image_io::write_png;
use airglow_scene::{Camera, FloatImage, Scene, luminance};
use clap::{Args, ValueEnum};
use glam::{DQuat, Mat4};
use serde::Serialize;

use crate::commands::maps_baked;
use crate::commands::render::size;
use crate::failure::{Failure, Outcome};
use crate::files;
use crate::global::Global;
use crate::host::device::{self, Device};
use crate::host::filter::Filter;
use crate::host::lighting;
use crate::host::mapped;
use crate::host::renderer::Renderer;
use crate::host::settings::{Air, Settings};
use crate::host::source::Source;
use crate::output::Output;
use crate::report::lines::{self, Series};
use crate::scene_options::SceneOptions;

/// Draw a scene with its normal maps filtered in each way, and compare with the truth by many samples.
///
/// Writes rows.png (a row for each filter, the truth first; a column for each distance, its middle enlarged pixel by
/// pixel to the size it has in the first), zoom.csv and zoom.svg (mean
/// brightness of a camera that moves away, frame by frame), and says the error of each filter.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  airglow maps assets/scenes/grooves.toml -o out/grooves --size 640x150
  airglow maps assets/scenes/weave.toml -o out/weave --size 240x200 --distances 1,4,16
  airglow maps assets/scenes/weave.toml -o out/weave --filters lobes,octahedral,harmonics
  airglow maps assets/scenes/weave.toml -o out/weave --bake")]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneOptions,
    /// Folder of the results.
    #[arg(long, short = 'o', value_name = "FOLDER")]
    output: PathBuf,
    /// Pixels of each picture.
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "480x200", value_parser = size)]
    size: [u32; 2],
    /// Distances of the camera from what it looks at, as multiples of the scene's: the columns.
    #[arg(long, value_name = "FACTORS", default_value = "1", value_delimiter = ',', value_parser = factor)]
    distances: Vec<f32>,
    /// How far away what the camera looks at is, metres; otherwise the middle of the scene.
    #[arg(long, value_name = "METRES", value_parser = factor)]
    pivot: Option<f32>,
    /// Frames of the zoom, from the first of --distances to the last; 0 for none.
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=1000))]
    zoom: u32,
    /// Filters to be compared with the truth: the further rows.
    #[arg(long, value_name = "FILTERS", default_value = "lobes,toksvig,lean,mip", value_delimiter = ',')]
    filters: Vec<Filter>,
    /// Draw nothing: write the lobes of each map to a KTX2 file in BC5 blocks, and say what each storage loses.
    #[arg(long)]
    bake: bool,
    /// Samples along each side of a pixel, of all filters but the truth.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4))]
    samples: u32,
    /// Passes of --samples that make each filter's picture: as many as silhouettes need, and what is left of the error is
    /// the filter's own.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4096))]
    filter_passes: u32,
    /// Passes of 16 samples a pixel that make the truth.
    #[arg(long, default_value_t = 32, value_parser = clap::value_parser!(u32).range(1..=4096))]
    passes: u32,
}

/// One way to filter, at all distances.
#[derive(Serialize)]
struct Row {
    filter: String,
    /// Relative L2 error of the scene-linear picture, for each of --distances.
    errors: Vec<f64>,
    /// The largest difference of the mean brightness of a frame of the zoom from the truth's, as a share of it.
    brightness_error: Option<f64>,
    #[serde(skip)]
    pictures: Vec<FloatImage>,
    #[serde(skip)]
    brightness: Vec<f64>,
}

/// Runs the command.
pub fn run(arguments: &Arguments, global: &Global, output: &Output) -> Outcome {
    let scene = arguments.scene.load(output)?;
    if arguments.bake {
        let requirements = mapped::requirements(&scene);
        let baked = device::with(global, &requirements, |device| {
            maps_baked::write(device, &scene, &arguments.output)
        })?;
        return output.result(&baked, |baked| maps_baked::text(baked));
    }
    let source = Source::of_scene(&scene, false, &arguments.scene.cache, output)?;
    let (rows, exposure) = device::with(global, &lighting::requirements(&source, &scene), |device| {
        let mut rows = Vec::new();
        for filter in [Filter::Texels].into_iter().chain(arguments.filters.iter().copied()) {
            rows.push(draw(device, &scene, &source, filter, arguments, output)?);
        }
        let truth: &Row = &rows[0];
        let exposure = scene.exposure.scale(&truth.pictures[0].pixels);
        let compared = rows.iter().map(|row| row.compared(truth)).collect::<Outcome<Vec<_>>>()?;
        for (row, (errors, brightness_error)) in rows.iter_mut().zip(compared) {
            (row.errors, row.brightness_error) = (errors, brightness_error);
        }
        Ok((rows, exposure))
    })?;
    std::fs::create_dir_all(&arguments.output).map_err(Failure::work)?;
    let sheet = stacked(&rows, &arguments.distances);
    write_png(&arguments.output.join("rows.png"), &sheet, exposure).map_err(Failure::work)?;
    if arguments.zoom > 0 {
        write_zoom(&arguments.output, &arguments.zoom_distances(), &rows)?;
    }
    output.say(format!("wrote {}", arguments.output.display()));
    output.result(&rows, |rows| text(rows))
}

/// The pictures of one filter.
fn draw(
    device: &Device<'_>,
    scene: &Scene,
    source: &Source,
    filter: Filter,
    arguments: &Arguments,
    output: &Output,
) -> Outcome<Row> {
    let mut renderer = Renderer::with_filter(device, scene, source, arguments.size, filter, false)?;
    let truth = filter == Filter::Texels;
    let settings = Settings {
        size: arguments.size,
        views: 1,
        samples: if truth { 4 } else { arguments.samples },
        exposure: 1.0,
        turn: DQuat::IDENTITY,
        spin: 0.0,
        without_shadow: false,
        count_shadow: false,
        share_transients: false,
        time: 0.0,
        step: 0.0,
        without_relight: false,
        air: Air::default(),
        window: None,
    };
    let passes = if truth { arguments.passes } else { arguments.filter_passes };
    let name = name(filter);
    let bar =
        output.progress(&name, (arguments.distances.len() + arguments.zoom as usize) as u64, "pictures");
    let mut at = |factor: f32| {
        renderer.look(arguments.camera(scene, factor));
        bar.inc(1);
        renderer.average(&settings, passes)
    };
    let pictures = arguments.distances.iter().map(|&factor| at(factor)).collect::<Outcome<_>>()?;
    let brightness = arguments.zoom_distances().into_iter().map(|factor| Ok(brightness(&at(factor)?)));
    let brightness = brightness.collect::<Outcome<_>>()?;
    bar.finish_and_clear();
    Ok(Row { filter: name, errors: Vec::new(), brightness_error: None, pictures, brightness })
}

impl Arguments {
    /// The scene's camera, moved back to so many times its distance.
    fn camera(&self, scene: &Scene, factor: f32) -> Camera {
        let camera = scene.camera();
        let centre = scene.bounding_sphere().map_or([0.0; 3], |sphere| sphere.center);
        let middle = (glam::Vec3::from(centre) - camera.position()).dot(camera.direction());
        let back = (factor - 1.0) * self.pivot.unwrap_or(middle).max(0.0);
        Camera { transform: camera.transform * Mat4::from_translation(back * glam::Vec3::Z), ..camera }
    }

    /// The distances of the frames of the zoom, in equal steps of their logarithm.
    fn zoom_distances(&self) -> Vec<f32> {
        let [first, last] =
            [self.distances.first(), self.distances.last()].map(|end| end.copied().unwrap_or(1.0));
        let share = |frame: u32| frame as f32 / (self.zoom - 1).max(1) as f32;
        (0..self.zoom).map(|frame| first * (last / first).powf(share(frame))).collect()
    }
}

impl Row {
    fn compared(&self, truth: &Self) -> Outcome<(Vec<f64>, Option<f64>)> {
        let values = |picture: &FloatImage| -> Vec<f64> {
            picture.pixels.as_flattened().iter().map(|&value| value.into()).collect()
        };
        let pairs = self.pictures.iter().zip(&truth.pictures);
        let errors =
            pairs.map(|(ours, truth)| relative_l2(&values(ours), &values(truth)).map_err(Failure::work));
        let differences =
            self.brightness.iter().zip(&truth.brightness).map(|(ours, truth)| (ours / truth - 1.0).abs());
        Ok((errors.collect::<Outcome<_>>()?, differences.reduce(f64::max)))
    }
}

/// Mean luminance.
fn brightness(picture: &FloatImage) -> f64 {
    let sum: f64 = picture.pixels.iter().map(|&rgb| f64::from(luminance(rgb))).sum();
    sum / picture.pixels.len().max(1) as f64
}

/// The pictures, a row for each filter.
fn stacked(rows: &[Row], distances: &[f32]) -> FloatImage {
    let first = &rows[0].pictures[0];
    let (width, height) = (first.width, first.height);
    let pixel = |row: usize, x: usize, y: usize| {
        let (column, x) = (x / width, x % width);
        let times = distances[column] / distances[0];
        let place = |place: usize, side: usize| {
            let middle = 0.5 * side as f32;
            ((middle + (place as f32 + 0.5 - middle) / times) as usize).min(side - 1)
        };
        rows[row].pictures[column].pixels[place(y, height) * width + place(x, width)]
    };
    let (columns, lines) = (width * distances.len(), height * rows.len());
    let places = (0..lines).flat_map(|y| (0..columns).map(move |x| (x, y)));
    let pixels = places.map(|(x, y)| pixel(y / height, x, y % height)).collect();
    FloatImage { width: columns, height: lines, pixels }
}

/// The brightness of each frame as a table and as a plot.
fn write_zoom(folder: &Path, distances: &[f32], rows: &[Row]) -> Outcome {
    let mut csv = String::from("distance");
    rows.iter().for_each(|row| csv.extend([",", &row.filter]));
    for (frame, distance) in distances.iter().enumerate() {
        csv.push_str(&format!("\n{distance}"));
        csv.extend(rows.iter().map(|row| format!(",{}", row.brightness[frame])));
    }
    csv.push('\n');
    files::write(&folder.join("zoom.csv"), csv.as_bytes())?;
    let series = |row: &Row| Series {
        name: row.filter.clone(),
        points: distances.iter().zip(&row.brightness).map(|(&x, &y)| (f64::from(x), y)).collect(),
    };
    let series: Vec<Series> = rows.iter().map(series).collect();
    let svg = lines::svg("distance of the camera, as a multiple", "mean luminance of the frame", &series)?;
    files::write(&folder.join("zoom.svg"), svg.as_bytes())
}

/// As the command line names it; the truth by what it is.
fn name(filter: Filter) -> String {
    match filter {
        Filter::Texels => "truth".to_owned(),
        other => other.to_possible_value().map_or(String::new(), |value| value.get_name().to_owned()),
    }
}

fn text(rows: &[Row]) -> String {
    let mut text = String::from(
        "relative L2 error of the picture at each distance; largest error of a frame's brightness\n",
    );
    for row in rows.iter().skip(1) {
        let errors = row.errors.iter().map(|error| format!("{:8.1} %", 100.0 * error)).collect::<String>();
        let brightness =
            row.brightness_error.map_or(String::new(), |error| format!("   {:8.1} %", 100.0 * error));
        text.push_str(&format!("  {:8}{errors}{brightness}\n", row.filter));
    }
    text
}

/// A positive number.
fn factor(text: &str) -> Result<f32, String> {
    let parsed = text.parse().ok().filter(|factor: &f32| factor.is_finite() && *factor > 0.0);
    parsed.ok_or_else(|| format!("`{text}` is no positive number"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_positive() {
        assert_eq!(factor("2.5"), Ok(2.5));
        for bad in ["0", "-1", "inf", "nan", "x", ""] {
            assert!(factor(bad).is_err(), "{bad}");
        }
    }
}
