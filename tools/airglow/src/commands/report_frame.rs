//! `airglow report presets`: the presets of every pass, each on the scene that shows it.

use std::path::Path;

use crate::cli::Global;
use crate::commands::report::{Arguments, Pass};
use crate::commands::scene::{CACHE, SceneOptions};
use crate::failure::{Failure, Outcome};
use crate::output::Output;
use crate::report::date::today;
use crate::report::model::{Machine, Report};
use crate::report::presets::measure::Bench;

/// The map with most to filter.
#[cfg(feature = "normals")]
const WOVEN: &str = "assets/scenes/weave.toml";

/// The report on the presets.
pub fn presets(arguments: &Arguments, global: &Global, output: &Output) -> Outcome<Report> {
    let bench = Bench { quick: arguments.quick, cache: Path::new(CACHE), global, output };
    let scene = |pass: Pass| SceneOptions::plain(Path::new(pass.scene()), None).load(output);
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
    })
}
