//! Debug views and presets, as a user asks for them.

#![cfg(all(
    feature = "fog",
    feature = "normals",
    feature = "radiance",
    feature = "relight",
    feature = "shadow"
))]

use std::path::Path;
use std::process::{Command, Output};

use airglow_scene::image_io::read_image;

use crate::root;

fn airglow(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_airglow"));
    command.current_dir(folder).args(arguments).args(["--device", "cpu", "--quiet"]).output().unwrap()
}

/// A square of ground in a medium, with a sphere above it and a sky.
fn scene(folder: &Path) -> String {
    let assets = root().join("assets").display().to_string();
    let text = format!(
        "[[gltf]]\nfile = '{assets}/mesh/ground.glb'\n[environment]\nfile = '{assets}/env/courtyard_512.exr'\n\
         distance = 40\n[medium]\nextinction = 0.05\n[[blocker]]\ncenter = [0.3, 1, 0.2]\nradius = 0.4\n\
         [quality]\norder = 3\nrays = 16\nshadow = 'unshadowed'\npresets.fog = 'high'\n"
    );
    let file = folder.join("scene.toml");
    std::fs::write(&file, text).unwrap();
    file.display().to_string()
}

#[test]
fn views_hold_what_they_say_and_are_listed() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path());
    let render = |view: &str, file: &str| {
        airglow(folder.path(), &["render", &scene, "-o", file, "--size", "32x18", "--debug", view])
    };
    let listed = String::from_utf8(render("list", "a.exr").stdout).unwrap();
    for room in ["relight", "fog", "radiance", "normals", "shadow"] {
        assert!(listed.lines().filter(|line| line.starts_with(room)).count() >= 2, "{listed}");
    }
    for view in ["fog-transmittance", "shadow-visibility"] {
        assert!(render(view, "a.exr").status.success(), "{view}");
        let values = read_image(&folder.path().join("a.exr")).unwrap().pixels;
        let shown: Vec<f32> = values.iter().map(|value| value[0]).filter(|value| *value >= 0.0).collect();
        let (low, high) = shown.iter().fold((1.0_f32, 0.0_f32), |(low, high), v| (low.min(*v), high.max(*v)));
        // Some of the picture is sky, and the sphere hides some of the ground's.
        assert!(shown.len() < values.len() && low < 0.99 && high <= 1.0 + 1e-4, "{view}: {low} to {high}");
    }
    let refused = render("no-such-view", "a.exr");
    let why = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(refused.status.code() == Some(2) && why.contains("shadow-blockers"), "{why}");
    let nothing = render("radiance-domain", "a.exr");
    let why = String::from_utf8_lossy(&nothing.stderr).into_owned();
    assert!(nothing.status.code() == Some(5) && why.contains("[[emitter]]"), "{why}");
}

#[test]
fn plans_say_what_presets_took_where_they_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path());
    let plan = |more: &[&str]| {
        let output = airglow(folder.path(), &[&["plan", &scene], more].concat());
        String::from_utf8(output.stdout).unwrap()
    };
    let of_file = plan(&[]);
    assert!(of_file.contains("fog high: error") && !of_file.contains("shadow high"), "{of_file}");
    let asked = plan(&["--preset", "low", "--preset", "shadow=reference"]);
    for line in ["relight low: error", "fog low: error", "shadow reference: error", "(llvmpipe"] {
        assert!(asked.contains(line), "{line} in {asked}");
    }
    let refused = airglow(folder.path(), &["plan", &scene, "--preset", "rain=low"]);
    assert_eq!(refused.status.code(), Some(2), "{}", String::from_utf8_lossy(&refused.stderr));
}
