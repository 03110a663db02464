//! The command as its users see it: exit codes, messages, and a whole road on a small scene.

#![cfg(feature = "relight")]
#![expect(clippy::unwrap_used, reason = "helpers of tests stop at the first surprise")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn airglow(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_airglow"));
    command.current_dir(folder).args(arguments).args(["--quiet", "--device", "cpu"]).output().unwrap()
}

fn succeeds(folder: &Path, arguments: &[&str]) -> String {
    let output = airglow(folder, arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "airglow {arguments:?} ended with {}: {errors}", output.status);
    String::from_utf8(output.stdout).unwrap()
}

fn fails(folder: &Path, arguments: &[&str], code: i32, word: &str) {
    let output = airglow(folder, arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "airglow {arguments:?}: {errors}");
    assert!(errors.contains(word), "`{word}` is not in: {errors}");
}

fn path(folder: &Path, name: &str) -> String {
    folder.join(name).display().to_string()
}

#[test]
fn exit_codes_say_what_went_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fails(here, &["render"], 2, "Usage");
    fails(here, &["render", "none.toml", "-o", "a.jpg"], 2, ".png");
    fails(here, &["render", "none.toml", "-o", "a.png"], 5, "none.toml");
    let spot = path(&root(), "assets/mesh/spot.glb");
    let output = Command::new(env!("CARGO_BIN_EXE_airglow"))
        .current_dir(here)
        .args(["plan", &spot, "--shadow", "unshadowed", "--device", "no such device", "--json"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(4), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(String::from_utf8_lossy(&output.stdout).contains("\"kind\":\"device\""));
    assert!(!here.join("a.png").exists(), "nothing is half written");
}

#[test]
fn a_scene_without_an_environment_leaves_relighting_out_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let spot = path(&root(), "assets/mesh/spot.glb");
    let plan = succeeds(folder.path(), &["plan", &spot, "--shadow", "unshadowed", "--validate"]);
    let left_out = plan.split("left out").nth(1).unwrap();
    assert!(left_out.contains("relight: the scene has no environment"), "{plan}");
    assert!(!plan.contains("relight colours"), "{plan}");
}

/// The picture that the pass lights is close to the one that rays light, and far from the one without the pass.
#[test]
fn a_picture_agrees_with_its_ray_traced_truth() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let scene = path(&root(), "assets/scenes/spot.toml");
    let render = |name: &str, more: &[&str]| {
        let common = ["render", &scene, "-o", name, "--size", "160x120", "--samples", "1", "--frames", "4"];
        succeeds(here, &[&common[..], more].concat())
    };
    render("relit.exr", &["-o", "relit.png", "--exposure", "0.5", "--validate"]);
    render("truth.exr", &["--reference", "--reference-rays", "256"]);
    render("ambient.exr", &["--without", "relight"]);
    let error = |test: &str| -> f64 {
        let text = succeeds(here, &["compare", test, "truth.exr", "--json"]);
        let value: serde_json::Value = serde_json::from_str(&text).unwrap();
        value["rmse"].as_f64().unwrap()
    };
    let (relit, ambient) = (error("relit.exr"), error("ambient.exr"));
    assert!(relit < 0.2 * ambient, "error {relit} with the pass, {ambient} without");
    fails(here, &["compare", "ambient.exr", "truth.exr", "--max-flip", "0.001"], 3, "FLIP");
    developed_as_the_scene_room_would(here);
}

/// Exposure, tone map and encoding on the GPU and on the CPU differ by rounding only.
fn developed_as_the_scene_room_would(folder: &Path) {
    let read = |name: &str| airglow_scene::image_io::read_image(&folder.join(name)).unwrap();
    let (linear, shown) = (read("relit.exr"), read("relit.png"));
    let expected = airglow_scene::tone::encode(&linear, 0.5);
    let byte = |value: f32| (255.0 * airglow_scene::srgb_encode(value)).round() as i32;
    for (shown, expected) in shown.pixels.iter().zip(&expected) {
        for channel in 0..3 {
            let (shown, expected) = (byte(shown[channel]), i32::from(expected[channel]));
            assert!((shown - expected).abs() <= 1, "{shown} on the GPU, {expected} on the CPU");
        }
    }
}

#[test]
fn rows_of_parameters_come_back_with_results_and_reasons() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let rows = "# half a turn about y\norder,f,qx,qy,qz,qw\n2,1;0;0.5;0.25,0,1,0,0\n2,1;0;0.5;0.25,0,0,0,0\n";
    std::fs::write(here.join("rows.csv"), rows).unwrap();
    succeeds(here, &["eval", "sh-rotate", "--in", "rows.csv", "--out", "out.csv", "--reference"]);
    let text = std::fs::read_to_string(here.join("out.csv")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "order,f,qx,qy,qz,qw,rotated,rotated_ref,error");
    let rotated: Vec<f64> =
        lines[1].split(',').nth(6).unwrap().split(';').map(|v| v.parse().unwrap()).collect();
    for (value, truth) in rotated.iter().zip([1.0, 0.0, -0.5, -0.25]) {
        assert!((value - truth).abs() < 1e-6, "{value} instead of {truth}");
    }
    assert!(lines[2].contains("zero"), "{}", lines[2]);
    fails(here, &["eval", "sh-product", "--in", "rows.csv", "--out", "no.csv"], 5, "column g missing");
    assert!(!here.join("no.csv").exists());
}
