//! `airglow devices`: what `--device` can choose from.

use airglow_gpu::open;
use clap::Args;
use serde::Serialize;

use crate::failure::{Failure, Outcome};
use crate::host::machine::kind_name;
use crate::output::Output;

/// List the Vulkan devices of this machine, in the order of their index.
#[derive(Debug, Args)]
pub struct Arguments {}

#[derive(Serialize)]
struct Line {
    index: usize,
    name: String,
    kind: &'static str,
    driver: String,
    api_version: String,
    usable: bool,
}

/// Runs the command.
pub fn run(_: &Arguments, output: &Output) -> Outcome {
    let devices = open::devices().map_err(Failure::device)?;
    let lines: Vec<Line> = devices
        .into_iter()
        .map(|line| Line {
            index: line.index,
            name: line.name,
            kind: kind_name(line.kind),
            driver: line.driver,
            api_version: format!("{}.{}.{}", line.api_version.0, line.api_version.1, line.api_version.2),
            usable: line.api_version >= (1, 3, 0),
        })
        .collect();
    if lines.is_empty() {
        output.warn(
            "there is no Vulkan device; Mesa's lavapipe (package mesa-vulkan-drivers) makes one of the CPU",
        );
    }
    output.result(&lines, |lines| lines.iter().map(text).collect::<Vec<_>>().join("\n"))
}

fn text(line: &Line) -> String {
    let Line { index, name, kind, driver, api_version, usable } = line;
    let mend = if *usable { "" } else { " (too old: Vulkan 1.3 is needed)" };
    format!("{index}: {name} ({kind}), {driver}, Vulkan {api_version}{mend}")
}
