//! `airglow compare`: how far one picture is from another.

use std::path::{Path, PathBuf};

use airglow_math::statistics::{mean, percentiles};
use airglow_scene::image_io::{read_image, write_png_bytes};
use airglow_scene::tone::tone_map;
use airglow_scene::{Exposure, FloatImage};
use clap::Args;
use serde::Serialize;

use crate::compare::statistics::{self, Statistics};
use crate::compare::{difference, flip, picture};
use crate::failure::{Failure, Outcome};
use crate::output::Output;

/// Compare a picture with its reference: error statistics, the difference an observer sees (FLIP), and a
/// picture of the signed difference.
///
/// Pictures are EXR or HDR (scene-linear) or PNG (decoded from sRGB). FLIP looks at both pictures as they would
/// be shown: exposed by one factor, tone-mapped and encoded.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  airglow compare picture.exr reference.exr -o difference.png
  airglow compare picture.png golden.png --max-flip 0.01     exit code 3 if the mean FLIP is larger")]
pub struct Arguments {
    /// The picture to judge.
    test: PathBuf,
    /// What it should be.
    reference: PathBuf,
    /// Write the signed difference of luminance here: red where the test is brighter, blue where darker.
    #[arg(long, short = 'o', value_name = "FILE.png")]
    output: Option<PathBuf>,
    /// Difference shown in full colour; without it the 99th percentile of the absolute difference.
    #[arg(long, value_name = "RADIANCE")]
    range: Option<f32>,
    /// Write the FLIP value of each pixel here, black for no difference to white for the largest.
    #[arg(long, value_name = "FILE.png")]
    flip_map: Option<PathBuf>,
    /// Factor from scene-linear values to the display, for FLIP; without it automatic from the reference, and 1
    /// for two PNG files.
    #[arg(long, value_name = "FACTOR")]
    exposure: Option<f32>,
    /// Pixels in a degree of the observer's sight.
    #[arg(long, value_name = "PIXELS", default_value_t = flip::PIXELS_PER_DEGREE)]
    pixels_per_degree: f32,
    /// Fail with exit code 3 if the mean FLIP exceeds this.
    #[arg(long, value_name = "FLIP")]
    max_flip: Option<f64>,
    /// Fail with exit code 3 if the relative L2 error exceeds this.
    #[arg(long, value_name = "ERROR")]
    max_relative_l2: Option<f64>,
}

#[derive(Serialize)]
struct Comparison {
    width: usize,
    height: usize,
    exposure: f32,
    #[serde(flatten)]
    statistics: Statistics,
    flip: FlipSummary,
}

#[derive(Serialize)]
struct FlipSummary {
    mean: f64,
    p50: f64,
    p95: f64,
    max: f64,
}

/// Runs the command.
pub fn run(arguments: &Arguments, output: &Output) -> Outcome {
    let (test, reference) = (load(&arguments.test)?, load(&arguments.reference)?);
    if (test.width, test.height) != (reference.width, reference.height) {
        return Err(Failure::input(format!(
            "{} has {} x {} pixels and {} has {} x {}; render both at one --size",
            arguments.test.display(),
            test.width,
            test.height,
            arguments.reference.display(),
            reference.width,
            reference.height
        )));
    }
    let exposure = exposure(arguments, &reference)?;
    let map = flip_map(arguments, &test, &reference, exposure)?;
    let comparison = Comparison {
        width: test.width,
        height: test.height,
        exposure,
        statistics: statistics::of(&test, &reference).map_err(Failure::work)?,
        flip: summarise(&map)?,
    };
    if let Some(path) = &arguments.output {
        write_difference(path, arguments.range, &test, &reference)?;
    }
    if let Some(path) = &arguments.flip_map {
        let bytes: Vec<[u8; 3]> = map.iter().map(|&value| [byte(value); 3]).collect();
        write_png_bytes(path, test.width, test.height, &bytes).map_err(Failure::work)?;
    }
    output.result(&comparison, text)?;
    check("mean FLIP", comparison.flip.mean, arguments.max_flip)?;
    check("relative L2 error", comparison.statistics.relative_l2, arguments.max_relative_l2)
}

fn load(path: &Path) -> Outcome<FloatImage> {
    let picture = read_image(path).map_err(Failure::input)?;
    let bad = picture.pixels.iter().flatten().filter(|value| !value.is_finite()).count();
    if bad > 0 {
        return Err(Failure::input(format!(
            "{}: {bad} values are NaN or infinite; a comparison needs finite pixels",
            path.display()
        )));
    }
    Ok(picture)
}

/// One factor for both pictures, so that a wrong brightness stays visible.
fn exposure(arguments: &Arguments, reference: &FloatImage) -> Outcome<f32> {
    let encoded = |path: &Path| path.extension().is_some_and(|kind| kind.eq_ignore_ascii_case("png"));
    match arguments.exposure {
        Some(factor) if factor > 0.0 && factor.is_finite() => Ok(factor),
        Some(factor) => Err(Failure::usage(format!("--exposure is {factor}; expected a positive factor"))),
        None if encoded(&arguments.test) && encoded(&arguments.reference) => Ok(1.0),
        None => Ok(Exposure::default().scale(&reference.pixels)),
    }
}

fn flip_map(
    arguments: &Arguments,
    test: &FloatImage,
    reference: &FloatImage,
    exposure: f32,
) -> Outcome<Vec<f32>> {
    let ppd = arguments.pixels_per_degree;
    if !(ppd.is_finite() && ppd >= 1.0) {
        return Err(Failure::usage(format!("--pixels-per-degree is {ppd}; expected at least 1")));
    }
    // PNG files are display-ready already; scene-linear ones are tone-mapped as `render` would.
    let shown = |path: &Path, image: &FloatImage| {
        let encoded = path.extension().is_some_and(|kind| kind.eq_ignore_ascii_case("png"));
        picture::map(image, |pixel| if encoded { pixel } else { tone_map(pixel.map(|c| c * exposure)) })
    };
    let test = shown(&arguments.test, test);
    let reference = shown(&arguments.reference, reference);
    flip::flip(&reference, &test, ppd).ok_or_else(|| Failure::input("the pictures have different sizes"))
}

fn summarise(map: &[f32]) -> Outcome<FlipSummary> {
    let values: Vec<f64> = map.iter().map(|&value| f64::from(value)).collect();
    let mean = mean(&values).map_err(Failure::work)?;
    let percentiles = percentiles(&values, &[50.0, 95.0, 100.0]).map_err(Failure::work)?;
    Ok(FlipSummary { mean, p50: percentiles[0], p95: percentiles[1], max: percentiles[2] })
}

fn write_difference(path: &Path, range: Option<f32>, test: &FloatImage, reference: &FloatImage) -> Outcome {
    let range = match range {
        Some(range) if range > 0.0 && range.is_finite() => range,
        Some(range) => {
            return Err(Failure::usage(format!("--range is {range}; expected a positive radiance")));
        }
        None => (statistics::of(test, reference).map_err(Failure::work)?.p99 as f32).max(f32::MIN_POSITIVE),
    };
    let shown = difference::signed_difference(test, reference, range);
    let bytes: Vec<[u8; 3]> = shown.pixels.iter().map(|pixel| pixel.map(byte)).collect();
    write_png_bytes(path, shown.width, shown.height, &bytes).map_err(Failure::work)
}

/// The nearest of 256 levels.
fn byte(value: f32) -> u8 {
    (255.0 * value.clamp(0.0, 1.0)).round() as u8
}

fn check(name: &str, value: f64, limit: Option<f64>) -> Outcome {
    match limit {
        Some(limit) if value.is_nan() || value > limit => {
            Err(Failure::check(format!("{name} is {value:.3e}, above the limit of {limit:.3e}")))
        }
        _ => Ok(()),
    }
}

fn text(comparison: &Comparison) -> String {
    let (s, f) = (&comparison.statistics, &comparison.flip);
    format!(
        "{} x {} pixels, exposure {:.4}\n\
         RMSE            {:.4e}\n\
         relative L2     {:.4e}\n\
         relative H1     {:.4e}\n\
         mean difference {:+.4e} (luminance)\n\
         absolute        p50 {:.3e}  p95 {:.3e}  p99 {:.3e}  max {:.3e}\n\
         FLIP            mean {:.4}  p50 {:.4}  p95 {:.4}  max {:.4}",
        comparison.width,
        comparison.height,
        comparison.exposure,
        s.rmse,
        s.relative_l2,
        s.relative_h1,
        s.mean_signed,
        s.p50,
        s.p95,
        s.p99,
        s.max,
        f.mean,
        f.p50,
        f.p95,
        f.max
    )
}
