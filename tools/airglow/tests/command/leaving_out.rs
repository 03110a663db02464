//! What is in a frame and what is not, for every combination of what a scene may hold: a golden text of steps, reasons
//! and bytes. And what is there but does nothing: the same counts, the same pixels.

#![cfg(all(
    feature = "fog",
    feature = "normals",
    feature = "radiance",
    feature = "relight",
    feature = "shadow"
))]

use std::path::Path;
use std::process::Command;

use airglow_scene::image_io::read_image;
use airglow_tests::golden::assert_text;
use serde_json::Value;

use super::root;

/// Parts of a scene file.
type Parts = &'static [&'static str];

const ENVIRONMENT: &str = "[environment]\nfile = 'ENV/courtyard_512.exr'\n";
const FAR: &str = "[environment]\nfile = 'ENV/courtyard_512.exr'\ndistance = 40\n";
const MEDIUM: &str = "[medium]\nextinction = 0.05\nalbedo = 0.9\n";
const EMITTER: &str = "[[emitter]]\ncenter = [0, 1, -1]\nsize = [0.2, 0.2, 0.2]\nradiance = [9, 5, 2]\n";
/// Much farther than the mesh is wide: one sample is enough.
const DISTANT: &str =
    "[[emitter]]\ncenter = [0, 40, -90]\nsize = [0.2, 0.2, 0.2]\nradiance = [9000, 5000, 2000]\n";
/// It is drawn, black, and lights nothing.
const DARK: &str = "[[emitter]]\ncenter = [0, 1, -1]\nsize = [0.2, 0.2, 0.2]\nradiance = [0, 0, 0]\n";
/// A file without a mesh.
const LAMP: &str = "[[gltf]]\nfile = 'lamp.gltf'\n";
const LAMP_FILE: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"translation":[0,3,0],"extensions":{"KHR_lights_punctual":{"light":0}}}],
"extensionsUsed":["KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":100}]}}}"#;
const BLOCKER: &str = "[[blocker]]\ncenter = [0.3, 1, 0.2]\nradius = 0.4\n";

/// Combinations: the mesh, which with `grooves` has a normal map, a sun and a lamp, and what else there is.
const SCENES: [(&str, &str, Parts); 17] = [
    ("nothing but a mesh", "ground", &[]),
    ("an environment", "ground", &[ENVIRONMENT]),
    ("a medium without light", "ground", &[MEDIUM]),
    ("an environment behind a medium", "ground", &[FAR, MEDIUM]),
    ("near emitters", "ground", &[EMITTER]),
    ("near emitters and an environment", "ground", &[EMITTER, ENVIRONMENT]),
    ("a far emitter and an environment", "ground", &[DISTANT, ENVIRONMENT]),
    ("an emitter that is dark, and an environment", "ground", &[DARK, ENVIRONMENT]),
    ("something that moves, without light", "ground", &[BLOCKER]),
    ("something that moves under an environment", "ground", &[BLOCKER, ENVIRONMENT]),
    ("one light on a surface that only scatters", "ground", &[LAMP]),
    ("one light in a medium", "ground", &[LAMP, MEDIUM]),
    ("three lamps, no normal map", "lights_room", &[]),
    ("lamps on a normal map", "grooves", &[]),
    ("lamps on a normal map under an environment", "grooves", &[ENVIRONMENT]),
    ("lamps on a normal map in a medium", "grooves", &[MEDIUM]),
    ("all of it", "grooves", &[FAR, MEDIUM, EMITTER, BLOCKER]),
];

/// A scene with something that does nothing, by itself or by what the command is told, and the scene without it.
const IDLE: [(&str, Parts, Parts, Parts); 3] = [
    ("a blocker where nothing is relit", &[BLOCKER], &[], &[]),
    ("a medium left out", &[ENVIRONMENT, MEDIUM], &["--without", "fog"], &[ENVIRONMENT]),
    ("a shadow left out", &[ENVIRONMENT, BLOCKER], &["--without", "shadow"], &[ENVIRONMENT]),
];

fn write(folder: &Path, mesh: &str, parts: &[&str]) -> String {
    let assets = root().join("assets").display().to_string();
    let quality = "[quality]\norder = 3\nrays = 16\nshadow = 'unshadowed'\n[exposure]\nscale = 1\n";
    let text = format!("[[gltf]]\nfile = '{assets}/mesh/{mesh}.glb'\n{}{quality}", parts.concat());
    std::fs::write(folder.join("lamp.gltf"), LAMP_FILE).unwrap();
    let file = folder.join("scene.toml");
    std::fs::write(&file, text.replace("ENV", &format!("{assets}/env"))).unwrap();
    file.display().to_string()
}

fn airglow(folder: &Path, arguments: &[&str]) -> Vec<u8> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_airglow"));
    let output =
        command.current_dir(folder).args(arguments).args(["--device", "cpu", "--quiet"]).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

fn plan(folder: &Path, mesh: &str, parts: &[&str]) -> Value {
    let scene = write(folder, mesh, parts);
    serde_json::from_slice(&airglow(folder, &["plan", &scene, "--json"])).unwrap()
}

fn list<'a>(value: &'a Value, key: &str) -> impl Iterator<Item = &'a Value> {
    value[key].as_array().into_iter().flatten()
}

fn said<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap()
}

/// Steps, barriers and bytes.
fn within(plan: &Value) -> String {
    let steps: Vec<&str> = list(plan, "steps").map(|step| said(step, "name")).collect();
    let barriers: usize = list(plan, "steps").map(|step| list(step, "barriers").count()).sum();
    let bytes = &plan["bytes"];
    format!(
        "  in: {}\n  {barriers} barriers before them, {} bytes imported, {} transient\n",
        steps.join(", "),
        bytes["imported"],
        bytes["transient"]
    )
}

/// What decides the shaders of each pass.
fn permutations(plan: &Value) -> String {
    let all = plan["permutations"].as_object().unwrap().iter();
    all.map(|(room, settings)| format!("  shaders of {room}: {}\n", settings.as_str().unwrap())).collect()
}

/// What is not there, why, what that saves and what would bring it back.
fn left_out(plan: &Value) -> String {
    let line = |out: &Value| {
        let [what, why, returns] = ["what", "why", "would_return"].map(|key| said(out, key));
        format!("  out: {what}: {why}; {} bytes; returns with {returns}\n", out["bytes"])
    };
    list(plan, "left_out").map(line).collect()
}

#[test]
fn every_combination_holds_what_it_needs_and_says_what_it_does_not() {
    let folder = tempfile::tempdir().unwrap();
    let section = |(title, mesh, parts): &(&str, &str, &[&str])| {
        let plan = plan(folder.path(), mesh, parts);
        format!("{title}\n{}{}{}\n", within(&plan), permutations(&plan), left_out(&plan))
    };
    let text: String = SCENES.iter().map(section).collect();
    assert_text(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/leaving_out.txt"), &text);
}

#[test]
fn what_does_nothing_changes_neither_counts_nor_pixels() {
    let folder = tempfile::tempdir().unwrap();
    let seen = |parts: &[&str], more: &[&str]| {
        let scene = write(folder.path(), "ground", parts);
        let size = ["--size", "32x18", "--stat", "stat.json"];
        airglow(folder.path(), &[&["render", &scene, "-o", "a.exr"], &size[..], more].concat());
        let stat = std::fs::read(folder.path().join("stat.json")).unwrap();
        let stat: Value = serde_json::from_slice(&stat).unwrap();
        let counts: Vec<Value> = list(&stat, "passes").map(|pass| pass["counts"].clone()).collect();
        assert!(!counts.is_empty() && counts.iter().all(Value::is_object), "{stat}");
        (counts, read_image(&folder.path().join("a.exr")).unwrap())
    };
    for (title, parts, told, without) in IDLE {
        let (counts, picture) = seen(parts, told);
        let (fewer_counts, fewer_picture) = seen(without, &[]);
        assert_eq!(counts, fewer_counts, "{title}");
        assert!(picture == fewer_picture, "{title}: pixels differ");
    }
}
