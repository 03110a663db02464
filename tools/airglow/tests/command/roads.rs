//! The command as its users see it: exit codes, messages, and a whole road on a small scene.

#![cfg(feature = "relight")]

use crate::root;
use std::path::Path;
use std::process::{Command, Output, Stdio};

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

/// What `| head -1` and `2>&1 | head -1` do to the command, at their earliest.
#[test]
fn a_reader_that_leaves_is_no_failure() {
    let folder = tempfile::tempdir().unwrap();
    let spot = path(&root(), "assets/mesh/spot.glb");
    let start = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_airglow"));
        command.current_dir(folder.path()).args(arguments).args(["--device", "cpu"]);
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    };
    let mut left = start(&["plan", &spot]);
    drop(left.stdout.take());
    let output = left.wait_with_output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && !errors.contains("panicked"), "{}: {errors}", output.status);
    assert!(!errors.contains("error:"), "{errors}");

    let draws = ["render", &spot, "-o", "a.png", "--size", "32x24", "--frames", "1"];
    for (arguments, code) in [(&draws[..], 0), (&["render", "none.toml", "-o", "b.png"], 5)] {
        let mut left = start(arguments);
        drop((left.stdout.take(), left.stderr.take()));
        assert_eq!(left.wait().unwrap().code(), Some(code), "{arguments:?}");
    }
    assert!(folder.path().join("a.png").exists(), "work goes on");
}

/// Newcomers read help from the top: what the command is for, then what all commands have.
#[test]
fn help_has_the_options_of_the_command_before_those_of_all() {
    let folder = tempfile::tempdir().unwrap();
    let always = ["devices", "bake", "render", "compare", "plan", "report", "stability", "explain", "eval"];
    for command in always.into_iter().chain(cfg!(feature = "view").then_some("view")) {
        let help = succeeds(folder.path(), &[command, "--help"]);
        let (own, global) = help.split_once("Global options:").unwrap();
        for option in ["--device", "--validate", "--quiet", "--json"] {
            let lists = |text: &str| {
                text.lines().any(|line| line.trim_start().trim_start_matches("-q, ").starts_with(option))
            };
            assert!(lists(global) && !lists(own), "{option} in the help of {command}: {help}");
        }
    }
}

#[test]
fn a_scene_without_an_environment_leaves_relighting_out_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let spot = path(&root(), "assets/mesh/spot.glb");
    let plan = succeeds(folder.path(), &["plan", &spot, "--check", "--validate", "--json"]);
    let plan: serde_json::Value = serde_json::from_str(&plan).unwrap();
    let is_relight = |left_out: &&serde_json::Value| left_out["what"] == "relight";
    let left_out = plan["left_out"].as_array().unwrap().iter().find(is_relight).unwrap();
    assert_eq!(
        (&left_out["what"], &left_out["why"]),
        (&"relight".into(), &"the scene has no environment".into())
    );
    // Transfer of order 4 and four floats of colour for each vertex.
    let vertices = airglow_scene::load(Path::new(&spot)).unwrap().meshes[0].positions.len() as u64;
    assert_eq!(left_out["bytes"].as_u64(), Some(vertices * (16 * 4 + 16)), "{left_out}");
    assert!(left_out["time"].is_null(), "nothing was measured: {left_out}");
    assert!(left_out["would_return"].as_str().unwrap().contains("--environment"), "{left_out}");
    assert!(!plan["steps"].to_string().contains("relight"), "{plan}");
    assert!(!folder.path().join(".cache").exists(), "nothing is baked");
}

/// Bytes that the device holds for an owner, as `--stat` writes them.
fn held(folder: &Path, owner: &str) -> u64 {
    let stat: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(folder.join("stat.json")).unwrap()).unwrap();
    let owners = stat["memory"].as_array().unwrap();
    owners.iter().filter(|entry| entry["owner"] == owner).map(|entry| entry["bytes"].as_u64().unwrap()).sum()
}

/// No bake, no kernels, no memory; and with the pass there are all three.
#[test]
fn what_is_left_out_is_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let lit = path(&root(), "assets/scenes/spot.toml");
    let dark = path(&root(), "assets/mesh/spot.glb");
    let small = ["-o", "a.png", "--size", "32x24", "--frames", "1", "--rays", "16", "--stat", "stat.json"];
    let render = |scene: &str, more: &[&str]| {
        succeeds(here, &[&["render", scene], &small[..], more].concat());
        (held(here, "relight"), here.join(".cache").exists())
    };
    assert_eq!(render(&lit, &["--without", "relight"]), (0, false), "--without relight");
    assert_eq!(render(&lit, &["--reference", "--reference-rays", "16"]), (0, false), "--reference");
    assert_eq!(render(&dark, &[]), (0, false), "no environment");
    let (bytes, baked) = render(&lit, &[]);
    assert!(bytes > 0 && baked, "{bytes} bytes with the pass, cache {baked}");
}

/// What does not depend on the view is there once; what does, once for each view.
#[test]
fn views_share_the_light_of_the_vertices() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let scene = path(&root(), "assets/scenes/spot.toml");
    let count = |views: &str| {
        let plan = succeeds(here, &["plan", &scene, "--rays", "16", "--views", views, "--json"]);
        let plan: serde_json::Value = serde_json::from_str(&plan).unwrap();
        let names: Vec<String> = plan["steps"]
            .as_array()
            .unwrap()
            .iter()
            .map(|step| step["name"].as_str().unwrap().into())
            .collect();
        let those = |name: &str| names.iter().filter(|step| step.starts_with(name)).count();
        [those("relight environment rows"), those("relight"), those("scene draw"), those("tone map")]
    };
    let (one, two) = (count("1"), count("2"));
    assert_eq!([one[0], one[2], one[3]], [1, 1, 1]);
    assert_eq!(two, [1, one[1], 2, 2]);
    let pair = ["render", &scene, "-o", "pair.exr", "--size", "160x120", "--samples", "1", "--views", "2"];
    succeeds(here, &[&pair[..], &["--rays", "16", "--frames", "2", "--validate"]].concat());
    let pair = airglow_scene::image_io::read_image(&here.join("pair.exr")).unwrap();
    assert_eq!((pair.width, pair.height), (320, 120));
    let eye = |first: usize| -> Vec<[f32; 3]> {
        pair.pixels.chunks(320).flat_map(|row| row[first..first + 160].to_vec()).collect()
    };
    let (left, right) = (eye(0), eye(160));
    assert_ne!(left, right, "the eyes stand apart");
    // Seen from further right, what is near lies further left: in the middle, where the mesh stands, the pair agrees
    // best with the right eye's picture moved right.
    let difference = |shift: isize| -> f32 {
        let at = |x: isize, y: isize| (160 * y + x) as usize;
        let inner = (45..75).flat_map(|y| (60..100).map(move |x| (at(x, y), at(x - shift, y))));
        inner.map(|(l, r)| (0..3).map(|c| (left[l][c] - right[r][c]).abs()).sum::<f32>()).sum()
    };
    let best = (-6..=6).min_by(|&a, &b| difference(a).total_cmp(&difference(b))).unwrap();
    assert!(best > 0, "the right eye's picture fits {best} pixels to the right");
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
    let rows =
        "# half a turn about y\norder,f,qx,qy,qz,qw\n2,1;0;0.5;0.25,0,1,0,0\n2,1;0;0.5;0.25,0,0,0,0\n2,1\n";
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
    assert!(lines[3].contains("the row has 2 cells"), "{}", lines[3]);
    let rotate = ["eval", "sh-rotate", "--in", "rows.csv", "--out"];
    let json = succeeds(here, &[&rotate[..], &["out.csv", "--json"]].concat());
    let summary: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(summary, serde_json::json!({ "rows": 3, "errors": 2, "file": "out.csv" }));
    fails(here, &[&rotate[..], &["nowhere/no.csv"]].concat(), 1, "the folder nowhere is not there; make it");
    assert!(!here.join("nowhere").exists());
    fails(here, &["eval", "sh-rotate", "--in", "out.csv", "--out", "no.csv"], 5, "`rotated` has the name of");
    fails(here, &["eval", "sh-product", "--in", "rows.csv", "--out", "no.csv"], 5, "column g missing");
    assert!(!here.join("no.csv").exists());
}

#[test]
fn one_extreme_input_runs_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let case = |name: &str| succeeds(here, &["stability", "relight", "--case", name]);
    let zero = case("rotation: zero, order 6");
    assert!(zero.contains("result refused: ") && zero.lines().count() == 3, "{zero}");
    let half = case("rotation: half turn about y, order 6");
    assert!(half.contains("result value ") && half.contains(", truth value "), "{half}");
    assert!(case("a peak rises").contains("worst  at "));
    fails(here, &["stability", "relight", "--case", "nothing"], 2, "nothing has this name");
}

#[test]
fn what_if_tells_what_a_change_would_do() {
    let root = root();
    let scene = "assets/scenes/spot.toml";
    let what_if = |change| succeeds(&root, &["plan", scene, "--what-if", change]);
    assert_eq!(what_if("order=4"), "what if order=4\nno difference\n");
    let without = what_if("environment=none");
    for line in ["- pass relight colours", "+ left out relight", "~ pipelines: 4 -> 0 (-4)"] {
        assert!(without.contains(line), "`{line}` is not in: {without}");
    }
    let dark = succeeds(&root, &["plan", "assets/scenes/blocks.toml", "--what-if", "emitters=none"]);
    for line in ["- pass radiance samples", "+ left out radiance"] {
        assert!(dark.contains(line), "`{line}` is not in: {dark}");
    }
    let bytes = what_if("storage=f16");
    assert!(bytes.contains("vectors of mesh 0: 208896 B -> 104448 B"), "{bytes}");
    let json = succeeds(&root, &["plan", scene, "--what-if", "views=2", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["difference"]["passes_added"][0], "scene draw#2", "{json}");
    fails(&root, &["plan", scene, "--what-if", "colour=red"], 2, "environment=none or a file");
    fails(&root, &["plan", scene, "--what-if", "order=9"], 2, "1 to 6");
}

#[test]
fn requirements_are_told_without_a_device() {
    let root = root();
    let text = succeeds(&root, &["requirements"]);
    assert!(text.contains("feature synchronization2: required"), "{text}");
    let engine = succeeds(&root, &["requirements", "engine", "--json"]);
    let all = succeeds(&root, &["requirements", "--json"]);
    let [engine, all]: [serde_json::Value; 2] =
        [engine, all].map(|json| serde_json::from_str(&json).unwrap());
    assert_eq!(engine["formats"].as_array().unwrap().len(), 0);
    assert!(!all["formats"].as_array().unwrap().is_empty(), "{all}");
}
