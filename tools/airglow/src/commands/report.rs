//! `airglow report`: a pass measured, as a page.

mod frame;

use std::path::PathBuf;

#[cfg(feature = "fog")]
use airglow::fog::Fog;
use airglow::relight::{Relight, Settings, Storage};
use clap::{Args, ValueEnum};

use crate::failure::Outcome;
use crate::global::Global;
use crate::host::device;
use crate::host::machine::Machine;
use crate::output::Output;
#[cfg(feature = "fog")]
use crate::report;
use crate::report::date::today;
use crate::report::model::Report;
use crate::report::pass::Pass;
use crate::report::relight::curves::Measurement;
use crate::report::relight::effort::Effort;
use crate::report::relight::workload::Workload;
use crate::report::write;
use crate::scene_options::SceneOptions;

/// Measure a pass and write a report: error against time and memory for each of its knobs.
///
/// The folder gets `report.html`, which needs nothing beside it, the same as `report.json` with every raw sample,
/// and `report.csv`. Rivals are timed in turn, round after round; two are called different only if the 95 % bootstrap
/// interval of their paired ratio excludes 1.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  airglow report relight -o out/report
  airglow report relight --scene assets/scenes/demo.toml -o out/report --quick
  airglow report fog -o out/fog
  airglow report radiance -o out/radiance
  airglow report normals -o out/normals
  airglow report shadow -o out/shadow
  airglow report presets -o out/presets           the presets of all passes
  airglow report assets/scenes/demo.toml -o out/frame
                                                  a whole frame: every pass by preset, and how time grows with size
  airglow report --merge docs/measured/relight-llvmpipe.json --merge out/report/report.json -o out/both
                                                  overlay devices: a kept run and one of your own")]
pub struct Arguments {
    /// A pass; `presets` for those of all passes; or a scene file, for all passes of its frame.
    #[arg(value_name = "PASS|presets|SCENE", default_value = "relight", value_parser = subject)]
    subject: Subject,
    /// The scene to light: a scene file or a glTF file. For relight assets/scenes/spot.toml unless given, for fog
    /// assets/scenes/street.toml, for radiance assets/scenes/blocks.toml, for normals
    /// assets/scenes/grooves.toml and weave.toml, for shadow assets/scenes/walkers.toml.
    #[arg(long, value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// Light it by this equirectangular map instead.
    #[arg(long, value_name = "FILE")]
    environment: Option<PathBuf>,
    /// Folder of the report.
    #[arg(long, short = 'o', value_name = "FOLDER")]
    output: PathBuf,
    /// Fewer rays and rounds: enough to see the shape of the curves.
    #[arg(long)]
    quick: bool,
    /// Of a scene's frame measure sizes too that take minutes on a software driver, and passes on all of its vertices.
    #[arg(long)]
    full: bool,
    /// Measure nothing; overlay these `report.json` files instead. May be given several times.
    #[arg(long, value_name = "FILE.json")]
    merge: Vec<PathBuf>,
}

/// What is measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Subject {
    /// The knobs of a pass.
    Pass(Pass),
    /// The presets of all passes, each on the scene that shows it.
    Presets,
    /// The frame of a scene.
    Frame(PathBuf),
}

/// Reads what is measured: a word that is neither a pass nor `presets` is a file.
fn subject(text: &str) -> Result<Subject, String> {
    match (Pass::from_str(text, false), text) {
        (Ok(pass), _) => Ok(Subject::Pass(pass)),
        (Err(_), "presets") => Ok(Subject::Presets),
        (Err(_), file) if file.contains('.') => Ok(Subject::Frame(PathBuf::from(file))),
        (Err(_), word) => Err(format!("`{word}` is no pass and no scene file")),
    }
}

impl Arguments {
    /// The pass; of other subjects the one that all frames have.
    fn pass(&self) -> Pass {
        match self.subject {
            Subject::Pass(pass) => pass,
            Subject::Presets | Subject::Frame(_) => Pass::Relight,
        }
    }

    fn scene(&self) -> PathBuf {
        self.scene.clone().unwrap_or_else(|| PathBuf::from(self.pass().scene()))
    }

    /// Whether the pass has more than one scene of its own.
    fn is_of_normals(&self) -> bool {
        self.pass().name() == "normals"
    }
}

/// Runs the command.
pub fn run(arguments: &Arguments, global: &Global, output: &Output) -> Outcome {
    let reports = if arguments.merge.is_empty() {
        vec![match arguments.subject {
            Subject::Presets => frame::presets(arguments, global, output)?,
            Subject::Frame(ref scene) => frame::frame(scene, arguments, global, output)?,
            Subject::Pass(Pass::Relight) => relight(arguments, global, output)?,
            #[cfg(feature = "fog")]
            Subject::Pass(Pass::Fog) => fog(arguments, global, output)?,
            #[cfg(feature = "radiance")]
            Subject::Pass(Pass::Radiance) => radiance(arguments, global, output)?,
            #[cfg(feature = "normals")]
            Subject::Pass(Pass::Normals) => normals(arguments, global, output)?,
            #[cfg(feature = "shadow")]
            Subject::Pass(Pass::Shadow) => shadow(arguments, global, output)?,
        }]
    } else {
        let read = arguments.merge.iter().map(|path| write::read(path)).collect::<Outcome<Vec<_>>>()?;
        read.into_iter().flatten().collect()
    };
    let paths = write::write(&arguments.output, &reports)?;
    output.result(&paths, |paths| {
        paths.iter().map(|path| format!("wrote {}", path.display())).collect::<Vec<_>>().join("\n")
    })
}

/// The report on shadows of what moves.
#[cfg(feature = "shadow")]
fn shadow(arguments: &Arguments, global: &Global, output: &Output) -> Outcome<Report> {
    use crate::report::shadow::{Effort, Measurement};
    let scene = SceneOptions::plain(&arguments.scene(), arguments.environment.as_deref()).load(output)?;
    device::with(global, &airglow::shadow::Shadow::requirements(), |device| {
        let effort = Effort::new(arguments.quick);
        let measured = Measurement { device, effort, output }.all(&scene)?;
        Ok(Report {
            pass: "shadow".to_owned(),
            machine: device.machine(),
            command: command(arguments, &device.machine()),
            date: today(),
            workload: measured.workload,
            remarks: measured.remarks,
            curves: measured.curves,
            numbers: measured.numbers,
            frame: None,
        })
    })
}

/// The report on fog.
#[cfg(feature = "fog")]
fn fog(arguments: &Arguments, global: &Global, output: &Output) -> Outcome<Report> {
    let scene = SceneOptions::plain(&arguments.scene(), None).load(output)?;
    let requirements = Fog::requirements(&airglow::fog::Settings::default());
    device::with(global, &requirements, |device| {
        let effort = report::fog::Effort::new(arguments.quick);
        let measured = report::fog::Measurement { device, effort, output }.all(&scene)?;
        Ok(Report {
            pass: "fog".to_owned(),
            machine: device.machine(),
            command: command(arguments, &device.machine()),
            date: today(),
            workload: measured.workload,
            remarks: measured.remarks,
            curves: measured.curves,
            numbers: measured.numbers,
            frame: None,
        })
    })
}

/// The report on normal maps: those of a scene, or of the two that are made for it.
#[cfg(feature = "normals")]
fn normals(arguments: &Arguments, global: &Global, output: &Output) -> Outcome<Report> {
    use crate::report::normals::{Effort, Map, Measurement, requirements};
    let more = arguments.scene.is_none().then(|| PathBuf::from("assets/scenes/weave.toml"));
    let paths = [arguments.scene()].into_iter().chain(more);
    let scenes =
        paths.map(|path| SceneOptions::plain(&path, None).load(output)).collect::<Outcome<Vec<_>>>()?;
    let maps = Map::of_scenes(&scenes)?;
    device::with(global, &requirements(), |device| {
        let measured = Measurement { device, effort: Effort::new(arguments.quick), output }.all(&maps)?;
        let names: Vec<_> = maps.iter().map(Map::words).collect();
        Ok(Report {
            pass: "normals".to_owned(),
            machine: device.machine(),
            command: command(arguments, &device.machine()),
            date: today(),
            workload: names.join(", "),
            remarks: measured.remarks,
            curves: measured.curves,
            numbers: measured.numbers,
            frame: None,
        })
    })
}

/// The report on near emitters.
#[cfg(feature = "radiance")]
fn radiance(arguments: &Arguments, global: &Global, output: &Output) -> Outcome<Report> {
    use crate::report::radiance::{Effort, Measurement, Workload};
    let options = SceneOptions::plain(&arguments.scene(), None);
    let scene = options.load(output)?;
    device::with(global, &crate::host::near::measured_requirements(), |device| {
        let workload = Workload::new(device, &scene, &options.cache, output)?;
        let effort = Effort::new(arguments.quick);
        let measurement = Measurement { device, workload: &workload, effort, output };
        let (curves, numbers) = measurement.all()?;
        Ok(Report {
            pass: "radiance".to_owned(),
            machine: device.machine(),
            command: command(arguments, &device.machine()),
            date: today(),
            workload: workload.description.clone(),
            remarks: measurement.remarks(),
            curves,
            numbers,
            frame: None,
        })
    })
}

fn relight(arguments: &Arguments, global: &Global, output: &Output) -> Outcome<Report> {
    let scene = SceneOptions::plain(&arguments.scene(), arguments.environment.as_deref()).load(output)?;
    let effort = Effort::new(arguments.quick);
    let workload = Workload::new(&scene, &effort, output)?;
    let requirements = Relight::requirements(&Settings { order: 6, ..Settings::default() });
    device::with(global, &requirements, |device| {
        let measurement = Measurement { device, workload: &workload, effort: &effort, output };
        let curves = vec![
            measurement.order()?,
            measurement.rays()?,
            measurement.storage()?,
            measurement.method()?,
            measurement.source()?,
            measurement.shape(Storage::F32)?,
            measurement.shape(Storage::F16)?,
        ];
        Ok(Report {
            pass: "relight".to_owned(),
            machine: device.machine(),
            command: command(arguments, &device.machine()),
            date: today(),
            workload: workload.description.clone(),
            remarks: remarks(&effort, &workload),
            curves,
            numbers: Vec::new(),
            frame: None,
        })
    })
}

/// The command that makes this report again.
fn command(arguments: &Arguments, machine: &Machine) -> String {
    let environment = arguments
        .environment
        .as_ref()
        .map_or(String::new(), |path| format!(" --environment {}", path.display()));
    let named = !arguments.is_of_normals() || arguments.scene.is_some();
    let scene = if named { format!(" --scene {}", arguments.scene().display()) } else { String::new() };
    let quick = if arguments.quick { " --quick" } else { "" };
    format!(
        "airglow report {}{scene}{environment} -o {}{quick} --device \"{}\"",
        arguments.pass().name(),
        arguments.output.display(),
        machine.device
    )
}

fn remarks(effort: &Effort, workload: &Workload) -> Vec<String> {
    vec![
        format!(
            "Model error of order, storage and method is against direct light traced with {} rays a vertex, half of \
             them drawn from the environment; its own noise is subtracted.",
            effort.truth_rays
        ),
        format!(
            "The setting error of order and storage is against order 6. The converged bake, of {} rays a vertex, ran at \
             {:.2} million rays a second, all threads.",
            effort.truth_rays,
            1e-6 * workload.rays_per_second
        ),
        format!(
            "Frame times are of {} vertices, the mesh's vectors repeated; {} rounds of all rivals in turn after {} \
             rounds of warm-up. Bakes are timed in {} rounds of their own.",
            effort.vertices, effort.rounds.measured, effort.rounds.warm_up, effort.bake_rounds.measured
        ),
        "Memory held: bytes of the vectors and results that a setting keeps on the device. Read + written: bytes that a \
         frame's kernels over the vertices must move by their algorithm, inputs once, outputs as often as they are \
         written; what caches save or padding adds is not in it. Bound: bytes of all ranges bound while the frame is \
         recorded, whether read or not. Invocations, dispatches, draws, copies and barriers are counted while recording."
            .to_owned(),
    ]
}
