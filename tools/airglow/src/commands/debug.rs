//! `airglow render SCENE --debug NAME`: a debug view with its legend.

use std::path::PathBuf;

use airglow_scene::Scene;
use airglow_scene::image_io::{write_exr, write_png_bytes};

use crate::compare::legend;
use crate::failure::{Failure, Outcome};
use crate::global::Global;
use crate::host::debug::{self, View};
use crate::host::device;
use crate::host::lighting;
use crate::host::settings::Settings;
use crate::host::source::Source;
use crate::output::{Output, print};

/// Draws a view of a scene, or lists the views. An `.exr` gets the values themselves, without a legend; where there is
/// nothing they are -1.
pub fn run(
    name: &str,
    scene: &Scene,
    source: &Source,
    settings: Settings,
    files: &[PathBuf],
    (global, output): (&Global, &Output),
) -> Outcome {
    let views = debug::views();
    if name == "list" {
        let line = |view: &View| format!("{:18} {}\n", view.name, view.title);
        return print(&views.iter().map(line).collect::<String>());
    }
    let Some(view) = views.iter().find(|view| view.name == name) else {
        let names: Vec<&str> = views.iter().map(|view| view.name).collect();
        return Err(Failure::usage(format!(
            "--debug: there is no view `{name}`; there are {}",
            names.join(", ")
        )));
    };
    let settings = Settings { samples: 1, views: 1, ..settings };
    let values = device::with(global, &lighting::requirements(source, scene), |device| {
        debug::values(view, device, scene, source, settings)
    })?;
    let high = view.high.unwrap_or_else(|| values.largest());
    for file in files {
        if file.extension().is_some_and(|kind| kind.eq_ignore_ascii_case("exr")) {
            let pixels = values.values.iter().map(|value| [value.unwrap_or(-1.0); 3]).collect();
            let [width, height] = settings.size.map(|side| side as usize);
            write_exr(file, &airglow_scene::FloatImage { width, height, pixels }).map_err(Failure::work)?;
        } else {
            let title = format!("{}: {}", view.name, view.title);
            let drawn = legend::with_legend(&values, high, &title);
            let bytes: Vec<[u8; 3]> =
                drawn.pixels.iter().map(|pixel| pixel.map(|value| (255.0 * value + 0.5) as u8)).collect();
            write_png_bytes(file, drawn.width, drawn.height, &bytes).map_err(Failure::work)?;
        }
        output.say(format!("wrote {}", file.display()));
    }
    Ok(())
}
