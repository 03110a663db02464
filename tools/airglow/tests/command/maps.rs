//! Normal maps end to end: small pictures of a scene beside the truth, in clear air and in a medium, and files of lobes.

#![cfg(all(feature = "fog", feature = "normals", feature = "relight"))]

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::root;

fn maps(scene: &Path, folder: &Path, more: &[&str]) -> Value {
    let arguments = ["--size", "32x20", "--passes", "2", "--device", "cpu", "--json", "--quiet"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_airglow"));
    command.current_dir(folder).arg("maps").arg(scene).args(["-o", "out"]).args(arguments).args(more);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The error of a filter's picture.
fn error(rows: &Value, filter: &str) -> f64 {
    let row = rows.as_array().unwrap().iter().find(|row| row["filter"] == filter).unwrap();
    row["errors"][0].as_f64().unwrap()
}

#[test]
fn filtered_maps_look_like_their_texels() {
    let folder = tempfile::tempdir().unwrap();
    let weave = root().join("assets/scenes/weave.toml").canonicalize().unwrap();
    let rows = maps(&weave, folder.path(), &["--filters", "octahedral,harmonics,mip"]);
    let of = |filter| error(&rows, filter);
    println!("clear air: {rows}");
    assert!(of("octahedral") < 0.6 * of("mip") && of("harmonics") < 0.6 * of("mip"), "{rows}");
    // Through a medium, which dims the lights on their way and the surface on its way to the eye.
    let mesh = root().join("assets/mesh/weave.glb").canonicalize().unwrap();
    let medium = "[medium]\nextinction = 0.1\nalbedo = 0.5\n";
    let scene = folder.path().join("fog.toml");
    std::fs::write(&scene, format!("[[gltf]]\nfile = '{}'\n{medium}", mesh.display())).unwrap();
    let rows = maps(&scene, folder.path(), &["--filters", "lobes,mip"]);
    println!("in a medium: {rows}");
    assert!(error(&rows, "lobes") < 0.5 * error(&rows, "mip"), "{rows}");
}

#[test]
fn files_of_lobes_say_what_they_lose() {
    let folder = tempfile::tempdir().unwrap();
    let weave = root().join("assets/scenes/weave.toml").canonicalize().unwrap();
    let baked = maps(&weave, folder.path(), &["--bake"]);
    println!("{baked}");
    let file = baked[0]["file"].as_str().unwrap();
    let bytes = std::fs::read(folder.path().join(file)).unwrap();
    assert_eq!(&bytes[1..7], b"KTX 20");
    assert_eq!(bytes.len() as u64, baked[0]["bytes"].as_u64().unwrap());
    let kept = baked[0]["kept"].as_array().unwrap();
    let names: Vec<_> = kept.iter().map(|kept| kept["storage"].as_str().unwrap()).collect();
    assert_eq!(names, ["F16", "Snorm8", "Octahedral8", "BC5"]);
    let error = |at: usize| kept[at]["errors"][0].as_f64().unwrap();
    assert!(error(0) < error(2) && error(2) < error(1) && error(3) < 0.3, "{kept:?}");
}
