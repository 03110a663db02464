//! `airglow plan --what-if KEY=VALUE`: what one change would add to a frame's plan or take away.

use std::path::Path;

use airglow_graph::PlanDifference;
use airglow_scene::{Environment, Scene, Shadow, Storage};
use serde::Serialize;

use crate::failure::{Failure, Outcome};
use crate::global::Global;
use crate::host::device::{self, Device};
#[cfg(feature = "radiance")]
use crate::host::emitters;
use crate::host::lighting;
use crate::host::renderer::Renderer;
use crate::host::settings::{Air, Settings};
#[cfg(feature = "shadow")]
use crate::host::shadow;
use crate::host::source::Source;
use crate::output::Output;

/// Every key and what it takes.
const KEYS: [(&str, &str); 12] = [
    ("order", "1 to 6"),
    ("storage", "f32 or f16"),
    ("shadow", "scene, object or unshadowed"),
    ("environment", "none or a file (.exr, .hdr)"),
    ("medium", "none"),
    ("emitters", "none"),
    ("moving_shadow", "off"),
    ("relight", "on or off"),
    ("fog", "on or off"),
    ("views", "1 to 8"),
    ("size", "WIDTHxHEIGHT, each 1 to 8192"),
    ("samples", "1 to 8"),
];

/// What is asked, and what it would change.
#[derive(Serialize)]
struct Answer<'a> {
    what_if: &'a [String],
    difference: PlanDifference,
}

/// Prints the difference between the plan of a frame and that of the changed one. Nothing is baked: plans do not
/// depend on what the vectors hold.
pub fn run(
    scene: &Scene,
    settings: &Settings,
    changes: &[String],
    global: &Global,
    output: &Output,
) -> Outcome {
    let (mut other_scene, mut other_settings) = (scene.clone(), *settings);
    for change in changes {
        apply(change, &mut other_scene, &mut other_settings)?;
    }
    let source = Source::unbaked(scene, settings.without_relight)?;
    let other_source = Source::unbaked(&other_scene, other_settings.without_relight)?;
    let requirements =
        lighting::requirements(&source, scene).and(&lighting::requirements(&other_source, &other_scene));
    let difference = device::with(global, &requirements, |device| {
        let plan = plan(device, scene, &source, settings)?;
        Ok(plan.difference(&self::plan(device, &other_scene, &other_source, &other_settings)?))
    })?;
    output.result(&Answer { what_if: changes, difference }, |answer| {
        format!("what if {}\n{}", answer.what_if.join(", "), answer.difference)
    })
}

fn plan(
    device: &Device<'_>,
    scene: &Scene,
    source: &Source,
    settings: &Settings,
) -> Outcome<airglow_graph::Plan<airglow_gpu::Record>> {
    Renderer::new(device, scene, source, settings.picture_size())?.plan(settings)
}

/// Makes one change, or says what could be made.
fn apply(change: &str, scene: &mut Scene, settings: &mut Settings) -> Outcome {
    let (key, value) = change.split_once('=').unwrap_or((change, ""));
    let Some((_, takes)) = KEYS.iter().find(|(name, _)| *name == key) else {
        let known: Vec<String> = KEYS.iter().map(|(name, takes)| format!("{name}={takes}")).collect();
        return Err(Failure::usage(format!(
            "--what-if: there is no key \"{key}\"; the keys are\n  {}",
            known.join("\n  ")
        )));
    };
    let made = match (key, value) {
        ("order", _) => whole(value, 6).map(|order| scene.quality.order = order),
        ("storage", _) => storage(value).map(|storage| scene.quality.storage = storage),
        ("shadow", _) => shadow(value).map(|shadow| scene.quality.shadow = shadow),
        ("environment", _) => environment(value)?.map(|environment| scene.environment = environment),
        ("medium", _) => (value == "none").then(|| scene.medium = None),
        #[cfg(feature = "radiance")]
        ("emitters", _) => (value == "none").then(|| emitters::remove(scene)),
        #[cfg(feature = "shadow")]
        ("moving_shadow", _) => (value == "off").then(|| *scene = shadow::without(scene.clone())),
        ("relight", _) => switch(value).map(|on| settings.without_relight = !on),
        ("fog", _) => switch(value).map(|on| settings.air = Air::with_fog(on)),
        ("views", _) => whole(value, 8).map(|views| settings.views = views),
        ("samples", _) => whole(value, 8).map(|samples| settings.samples = samples),
        ("size", _) => size(value).map(|size| settings.size = size),
        _ => None,
    };
    made.ok_or_else(|| Failure::usage(format!("--what-if {change}: {key} takes {takes}")))
}

/// A number from 1 to `most`.
fn whole(value: &str, most: u32) -> Option<u32> {
    value.parse().ok().filter(|number| (1..=most).contains(number))
}

fn storage(value: &str) -> Option<Storage> {
    match value {
        "f32" => Some(Storage::F32),
        "f16" => Some(Storage::F16),
        _ => None,
    }
}

fn shadow(value: &str) -> Option<Shadow> {
    match value {
        "scene" => Some(Shadow::Scene),
        "object" => Some(Shadow::Object),
        "unshadowed" => Some(Shadow::Unshadowed),
        _ => None,
    }
}

fn environment(value: &str) -> Outcome<Option<Option<Environment>>> {
    match value {
        "" => Ok(None),
        "none" => Ok(Some(None)),
        file => {
            let read = airglow_scene::image_io::read_environment(Path::new(file));
            Ok(Some(Some(read.map_err(Failure::input)?)))
        }
    }
}

fn switch(value: &str) -> Option<bool> {
    match value {
        "on" => Some(true),
        "off" => Some(false),
        _ => None,
    }
}

fn size(value: &str) -> Option<[u32; 2]> {
    let (width, height) = value.split_once('x')?;
    Some([whole(width, 8192)?, whole(height, 8192)?])
}
