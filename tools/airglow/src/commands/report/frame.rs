//! `airglow report presets` and `airglow report SCENE`: the presets of every pass, each on the scene that shows it, or on one
//! scene with its whole frame.

use std::path::Path;

use airglow_scene::Scene;

use super::Arguments;
use crate::failure::{Failure, Outcome};
use crate::global::Global;
use crate::host::device;
use crate::host::machine::Machine;
use crate::output::Output;
use crate::report::bench::{Bench, Measured};
use crate::report::date::today;
use crate::report::frame::stages::Stages;
use crate::report::interleave::Rounds;
use crate::report::model::scaling::Scaling;
use crate::report::model::{Curve, Report};
use crate::report::pass::Pass;
use crate::scene_options::{CACHE, SceneOptions};

/// The map with most to filter.
#[cfg(feature = "normals")]
const WOVEN: &str = "assets/scenes/weave.toml";

/// The report on the presets.
pub fn presets(arguments: &Arguments, global: &Global, output: &Output) -> Outcome<Report> {
    let bench = Bench { quick: arguments.quick, cache: Path::new(CACHE), global, output };
    let scene = |pass: Pass| SceneOptions::plain(Path::new(pass.scene()), None).load(output);
    #[cfg_attr(
        not(any(feature = "fog", feature = "normals", feature = "radiance", feature = "shadow")),
        expect(unused_mut, reason = "other rooms add to it")
    )]
    let mut measured = vec![bench.relight(&scene(Pass::Relight)?)?];
    #[cfg(feature = "fog")]
    measured.push(bench.fog(&scene(Pass::Fog)?)?);
    #[cfg(feature = "radiance")]
    measured.push(bench.radiance(&scene(Pass::Radiance)?)?);
    #[cfg(feature = "normals")]
    measured.extend(bench.normals(&SceneOptions::plain(Path::new(WOVEN), None).load(output)?)?);
    #[cfg(feature = "shadow")]
    measured.push(bench.shadow(&scene(Pass::Shadow)?)?);
    let (machines, curves): (Vec<Machine>, Vec<_>) = measured.into_iter().unzip();
    let machine = machines.into_iter().next().ok_or_else(|| Failure::work("nothing was measured"))?;
    let quick = if arguments.quick { " --quick" } else { "" };
    Ok(Report {
        pass: "presets".to_owned(),
        command: format!(
            "airglow report presets -o {}{quick} --device \"{}\"",
            arguments.output.display(),
            machine.device
        ),
        machine,
        date: today(),
        workload: "each pass on the scene that shows it".to_owned(),
        remarks: vec![
            "Each section is a pass, each row a preset of it. Presets of one pass are timed in turn; those of different passes \
             are of different scenes, and their times do not add up to a frame's."
                .to_owned(),
        ],
        curves,
        numbers: Vec::new(),
        frame: None,
    })
}

/// Pixels of the frame, and of the frames of its sweep.
const SIZE: [u32; 2] = [320, 180];
const SIZES: [[u32; 2]; 5] = [[80, 45], [160, 90], [320, 180], [640, 360], [1280, 720]];
/// Vertices of a scene of which every one is sampled and traced, without `--full`.
#[cfg(feature = "radiance")]
const FEW: usize = 20_000;

/// The report on a scene's frame.
pub fn frame(file: &Path, arguments: &Arguments, global: &Global, output: &Output) -> Outcome<Report> {
    let scene = SceneOptions::plain(file, arguments.environment.as_deref()).load(output)?;
    let bench = Bench { quick: !arguments.full, cache: Path::new(CACHE), global, output };
    let stages = Stages::new(&scene, bench.cache, output)?;
    let rounds = Rounds { warm_up: 1, measured: if arguments.quick { 5 } else { 9 } };
    let (sizes, cut) =
        if arguments.full { (&SIZES[..], "") } else { (&SIZES[..4], "1280 x 720, with --full") };
    let (machine, mut measured, points) = device::with(global, &stages.requirements(), |device| {
        let measured = stages.measure(device, SIZE, rounds, output)?;
        Ok((device.machine(), measured, stages.sizes(device, sizes, rounds, output)?))
    })?;
    measured.scalings = bench.sweeps(arguments.full)?;
    let timed = "the whole frame of the scene at the default preset, device time of all its passes";
    measured.scalings.push(Scaling::new("pixels", timed.to_owned(), cut, points));
    let (curves, remarks) = rooms(&bench, &scene, arguments.full);
    let full = if arguments.full { " --full" } else { "" };
    Ok(Report {
        pass: "frame".to_owned(),
        command: format!(
            "airglow report {} -o {}{full} --device \"{}\"",
            file.display(),
            arguments.output.display(),
            machine.device
        ),
        machine,
        date: today(),
        workload: format!(
            "{}: {} instances, {} vertices, {} lights, {} emitters, {} figures",
            file.display(),
            scene.instances.len(),
            vertices(&scene),
            scene.lights.len(),
            scene.emitters.len(),
            scene.figures.len()
        ),
        remarks,
        curves,
        numbers: Vec::new(),
        frame: Some(measured),
    })
}

fn vertices(scene: &Scene) -> usize {
    scene.instances.iter().map(|instance| scene.meshes[instance.mesh].positions.len()).sum()
}

/// The presets of each pass that has something to do in the scene; and why others are not there.
#[cfg_attr(not(feature = "radiance"), expect(unused_variables, reason = "only near emitters take minutes"))]
fn rooms(bench: &Bench<'_>, scene: &Scene, full: bool) -> (Vec<Curve>, Vec<String>) {
    let (mut curves, mut remarks) = (Vec::new(), Vec::new());
    let mut keep = |room: &str, measured: Outcome<Option<Measured>>| match measured {
        Ok(Some((_, curve))) => curves.push(curve),
        Ok(None) => {}
        Err(failure) => remarks.push(format!("{room} is not measured by itself: {failure}")),
    };
    keep("relight", bench.relight(scene).map(Some));
    #[cfg(feature = "fog")]
    keep("fog", bench.fog(scene).map(Some));
    #[cfg(feature = "radiance")]
    {
        let few = full || scene.emitters.is_empty() || vertices(scene) <= FEW;
        let many =
            || Failure::input(format!("it has more than {FEW} vertices; --full samples and traces all"));
        keep("radiance", if few { bench.radiance(scene).map(Some) } else { Err(many()) });
    }
    #[cfg(feature = "normals")]
    keep("normals", bench.normals(scene));
    #[cfg(feature = "shadow")]
    keep("shadow", bench.shadow(scene).map(Some));
    (curves, remarks)
}
