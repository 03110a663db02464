//! `airglow eval`: a pass's own code on rows of parameters.

use std::path::{Path, PathBuf};

use airglow::relight::Bench;
use airglow::relight::Relight;
use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::eval::table::Table;
use crate::eval::{self, Settings, relight};
use crate::failure::{Failure, Outcome};
use crate::files;
use crate::global::Global;
use crate::host::device;
use crate::output::Output;

/// Run a pass's own GPU code on rows of parameters: to check it against your own numbers, or to plot it.
///
/// The output holds the input columns unchanged, the result columns, and a last column `error` with the reason where
/// a row was refused. Numbers have nine significant digits; vectors inside a cell are separated by `;`; lines that
/// start with `#` are comments.
#[derive(Debug, Args)]
#[command(after_help = "Names and their columns:
  environment-sh  order -> red, green, blue          --set image=FILE.exr, equirectangular
  sh-product      order, f, g -> product             order n in, order n out
  sh-rotate       order, f, qx, qy, qz, qw -> rotated   rotated(s) = f(q^-1 s q)
  fog-airlight    beta, d_sv, d_vp, gamma -> radiance   also light_radius; phase (isotropic, hg:g, poly:w0;w1;w2;w3,
                  draine:g;alpha); method (default, reference), or --set method=reference for all rows
  fog-surface     t_sp, theta, n -> g                   G_n; n = 1 is Lambert's lobe; also method (default, reference)
  fog-psf         t_sv, gamma -> psf                    also method (exact, factored)
  normals         level, x, y, lx, ly, lz, vx, vy, vz, brdf -> radiance   --set map=FILE; brdf (lambert, blinn:n,
                  ggx:a); also method (vmf:1, vmf:2, vmf:4, vmf:6; default is vmf:4)
  radiance-cube   order, face, px, py, pz, triangles (9 numbers each), radiance (one each) -> sh, distance
                  also method (cube, analytic: refuses what overlaps); --set rays=1, 2 or 4 a side of a texel
  sh-circle       order, theta -> visibility, log       blocker about +Z; zonal, order values each
  sh-log          order, g -> f                         eigenvalues clipped at 0.02 of the largest
  sh-exp          order, f -> g                         also method (default, exact, ol, hyb:T, psN, pssN)
  shadow-spheres  order, px, py, pz, spheres -> visibility   x;y;z;r each; also method (as sh-exp, or products)

Example:
  printf 'order,f,qx,qy,qz,qw\\n2,1;0;0.5;0,0,1,0,1\\n' > rows.csv
  airglow eval sh-rotate --in rows.csv --out rotated.csv --reference")]
pub struct Arguments {
    /// What to evaluate.
    #[arg(value_enum, value_name = "NAME")]
    name: Evaluator,
    /// Rows of parameters, with a header that names the columns.
    #[arg(long = "in", value_name = "FILE.csv")]
    input: PathBuf,
    /// Where the rows go with their results.
    #[arg(long = "out", value_name = "FILE.csv")]
    output: PathBuf,
    /// A setting that holds for all rows. May be given several times.
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = key_value)]
    settings: Vec<(String, String)>,
    /// Add the columns of the f64 reference, with the suffix `_ref`.
    #[arg(long)]
    reference: bool,
}

/// What can be evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Evaluator {
    /// An environment projected on spherical harmonics.
    EnvironmentSh,
    /// The product of two functions in spherical harmonics.
    ShProduct,
    /// A rotated function in spherical harmonics.
    ShRotate,
    /// Airlight along a ray by a light of 1 W/sr, in a medium of albedo 1.
    #[cfg(feature = "fog")]
    FogAirlight,
    /// The glow of a light through a reflecting lobe.
    #[cfg(feature = "fog")]
    FogSurface,
    /// The point spread function of fog.
    #[cfg(feature = "fog")]
    FogPsf,
    /// The radiance of a texel of a normal map's level.
    #[cfg(feature = "normals")]
    Normals,
    /// Incident radiance of triangles at a point.
    #[cfg(feature = "radiance")]
    RadianceCube,
    /// Visibility of a circle of directions and its logarithm.
    #[cfg(feature = "shadow")]
    ShCircle,
    /// The logarithm of a function in spherical harmonics.
    #[cfg(feature = "shadow")]
    ShLog,
    /// The exponential of a function in spherical harmonics.
    #[cfg(feature = "shadow")]
    ShExp,
    /// What spheres leave a point to see.
    #[cfg(feature = "shadow")]
    ShadowSpheres,
}

impl Evaluator {
    fn columns(self) -> &'static [&'static str] {
        match self {
            Self::EnvironmentSh => &["order"],
            Self::ShProduct => &["order", "f", "g"],
            Self::ShRotate => &["order", "f", "qx", "qy", "qz", "qw"],
            #[cfg(feature = "fog")]
            Self::FogAirlight => &["beta", "d_sv", "d_vp", "gamma"],
            #[cfg(feature = "fog")]
            Self::FogSurface => &["t_sp", "theta", "n"],
            #[cfg(feature = "fog")]
            Self::FogPsf => &["t_sv", "gamma"],
            #[cfg(feature = "normals")]
            Self::Normals => &["level", "x", "y", "lx", "ly", "lz", "vx", "vy", "vz", "brdf"],
            #[cfg(feature = "radiance")]
            Self::RadianceCube => &["order", "face", "px", "py", "pz", "triangles", "radiance"],
            #[cfg(feature = "shadow")]
            Self::ShCircle => &["order", "theta"],
            #[cfg(feature = "shadow")]
            Self::ShLog => &["order", "g"],
            #[cfg(feature = "shadow")]
            Self::ShExp => &["order", "f"],
            #[cfg(feature = "shadow")]
            Self::ShadowSpheres => &["order", "px", "py", "pz", "spheres"],
        }
    }

    fn results(self) -> &'static [&'static str] {
        match self {
            Self::EnvironmentSh => &["red", "green", "blue"],
            Self::ShProduct => &["product"],
            Self::ShRotate => &["rotated"],
            #[cfg(feature = "fog")]
            Self::FogAirlight => &["radiance"],
            #[cfg(feature = "fog")]
            Self::FogSurface => &["g"],
            #[cfg(feature = "fog")]
            Self::FogPsf => &["psf"],
            #[cfg(feature = "normals")]
            Self::Normals => &["radiance"],
            #[cfg(feature = "radiance")]
            Self::RadianceCube => &["sh", "distance"],
            #[cfg(feature = "shadow")]
            Self::ShCircle => &["visibility", "log"],
            #[cfg(feature = "shadow")]
            Self::ShLog => &["f"],
            #[cfg(feature = "shadow")]
            Self::ShExp => &["g"],
            #[cfg(feature = "shadow")]
            Self::ShadowSpheres => &["visibility"],
        }
    }

    fn settings(self) -> &'static [&'static str] {
        match self {
            Self::EnvironmentSh => &["image"],
            Self::ShProduct | Self::ShRotate => &[],
            #[cfg(feature = "fog")]
            Self::FogAirlight | Self::FogSurface | Self::FogPsf => &["method"],
            #[cfg(feature = "normals")]
            Self::Normals => &["map"],
            #[cfg(feature = "radiance")]
            Self::RadianceCube => &["rays"],
            #[cfg(feature = "shadow")]
            Self::ShCircle | Self::ShLog | Self::ShExp | Self::ShadowSpheres => &[],
        }
    }
}

/// What `--json` prints.
#[derive(Serialize)]
struct Summary {
    /// Rows written.
    rows: usize,
    /// How many of them were refused.
    errors: usize,
    file: PathBuf,
}

/// Runs the command.
pub fn run(arguments: &Arguments, global: &Global, output: &Output) -> Outcome {
    let input = arguments.input.display().to_string();
    let table = Table::read(&input, &files::read_text(&arguments.input)?)?;
    table.require(&input, arguments.name.columns())?;
    let names = eval::names(arguments.name.results(), arguments.reference);
    table.leave_free(&input, &names)?;
    let settings = settings(arguments)?;
    folder_is_there(&arguments.output)?;
    let requirements = Relight::requirements(&airglow::relight::Settings { order: 6, ..Default::default() });
    let columns = device::with(global, &requirements, |device| {
        let run = device.bench();
        let bench = Bench { context: device.context(), run: &run };
        match arguments.name {
            Evaluator::EnvironmentSh => relight::environment_sh(&bench, &table, &settings),
            Evaluator::ShProduct => relight::sh_product(&bench, &table),
            Evaluator::ShRotate => relight::sh_rotate(&bench, &table),
            #[cfg(feature = "fog")]
            Evaluator::FogAirlight => {
                let bench = airglow::fog::Bench { context: device.context(), run: &run };
                eval::fog::airlight(&bench, &table, &settings)
            }
            #[cfg(feature = "fog")]
            Evaluator::FogSurface => {
                let bench = airglow::fog::Bench { context: device.context(), run: &run };
                eval::fog::surface(&bench, &table, &settings)
            }
            #[cfg(feature = "fog")]
            Evaluator::FogPsf => {
                let bench = airglow::fog::Bench { context: device.context(), run: &run };
                eval::fog::spread(&bench, &table, &settings)
            }
            #[cfg(feature = "normals")]
            Evaluator::Normals => {
                let bench = airglow::normals::Bench { context: device.context(), run: &run };
                eval::normals::normals(&bench, &table, &settings)
            }
            #[cfg(feature = "radiance")]
            Evaluator::RadianceCube => {
                let bench = airglow::radiance::gpu::bench::Bench { context: device.context(), run: &run };
                eval::radiance::cube(&bench, &table, &settings)
            }
            #[cfg(feature = "shadow")]
            Evaluator::ShCircle => eval::shadow::circle(&table),
            #[cfg(feature = "shadow")]
            Evaluator::ShLog => eval::shadow::logarithm(&table),
            #[cfg(feature = "shadow")]
            Evaluator::ShExp => {
                let bench = airglow::shadow::Bench { context: device.context(), run: &run };
                eval::shadow::exponential(&bench, &table)
            }
            #[cfg(feature = "shadow")]
            Evaluator::ShadowSpheres => {
                let bench = airglow::shadow::Bench { context: device.context(), run: &run };
                eval::shadow::spheres(&bench, &table)
            }
        }
    })?;
    let rows = columns.written(arguments.reference);
    files::write(&arguments.output, &table.with_results(&names, &rows)?)?;
    let errors = rows.iter().filter(|row| row.is_err()).count();
    let summary = Summary { rows: rows.len(), errors, file: arguments.output.clone() };
    output.say(format!(
        "wrote {}: {} rows, {errors} refused{}",
        summary.file.display(),
        summary.rows,
        if errors > 0 { " (see the column `error`)" } else { "" }
    ));
    if output.json() { output.result(&summary, |_| String::new()) } else { Ok(()) }
}

/// A folder that is not there is more often a slip in the name than a wish for a new one.
fn folder_is_there(file: &Path) -> Outcome {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            let (file, folder) = (file.display(), folder.display());
            Err(Failure::work(format!("{file}: the folder {folder} is not there; make it, or correct --out")))
        }
        _ => Ok(()),
    }
}

fn settings(arguments: &Arguments) -> Outcome<Settings> {
    let known = arguments.name.settings();
    if let Some((key, _)) = arguments.settings.iter().find(|(key, _)| !known.contains(&key.as_str())) {
        return Err(Failure::usage(format!(
            "--set {key}: not a setting of this evaluator; known: {}",
            if known.is_empty() { "none".to_owned() } else { known.join(", ") }
        )));
    }
    Ok(arguments.settings.iter().cloned().collect())
}

/// `key=value`.
fn key_value(text: &str) -> Result<(String, String), String> {
    let (key, value) = text.split_once('=').ok_or_else(|| format!("`{text}`: write it as key=value"))?;
    Ok((key.to_owned(), value.to_owned()))
}
