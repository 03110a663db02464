//! Normal maps end to end: small pictures of a scene beside the truth, in clear air and in a medium, a flat map beside none,
//! and files of lobes.

#![cfg(all(feature = "fog", feature = "normals", feature = "relight"))]

use std::path::Path;
use std::process::Command;

use airglow_math::statistics::relative_l2;
use airglow_scene::image_io::read_image;
use serde_json::{Value, json};

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

/// The picture of a matt plane under a sky alone, with this normal texture. Between vertices of a bent surface, and where it
/// shadows itself, a light that maps turn and a colour are not the same.
fn plane_under_a_sky(folder: &Path, name: &str, normal_texture: Option<Value>) -> Vec<f64> {
    let glb = std::fs::read(root().join("assets/mesh/grooves.glb")).unwrap();
    let end = 20 + u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    let mut content: Value = serde_json::from_slice(&glb[20..end]).unwrap();
    let image = root().join("assets/normalmap/weave.png");
    std::fs::copy(image, folder.join("weave.png")).unwrap();
    content["images"][0]["uri"] = json!("weave.png");
    content["scenes"][0]["nodes"] = json!([0]); // without the lights
    let surface =
        json!({"baseColorFactor": [0.7, 0.6, 0.4, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9});
    content["materials"][0] = json!({"pbrMetallicRoughness": surface});
    normal_texture.into_iter().for_each(|texture| content["materials"][0]["normalTexture"] = texture);
    let mut text = content.to_string();
    text.push_str(&" ".repeat((4 - text.len() % 4) % 4));
    let length = |bytes: usize| (bytes as u32).to_le_bytes();
    let all = length(20 + text.len() + glb.len() - end);
    let changed = [&glb[..8], &all, &length(text.len()), &glb[16..20], text.as_bytes(), &glb[end..]].concat();
    std::fs::write(folder.join(format!("{name}.glb")), changed).unwrap();
    let sky = root().join("assets/env/sunrise_512.exr").canonicalize().unwrap();
    let scene = format!(
        "[[gltf]]\nfile = '{name}.glb'\n[environment]\nfile = '{}'\n[quality]\norder = 4\nshadow = 'unshadowed'\n\
         [camera]\nfrom = [0, 1.2, 2.2]\nto = [0, 0, 0]\n",
        sky.display()
    );
    std::fs::write(folder.join(format!("{name}.toml")), scene).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_airglow"));
    command.current_dir(folder).args(["render", &format!("{name}.toml"), "-o", &format!("{name}.exr")]);
    command.args(["--size", "48x32", "--frames", "1", "--device", "cpu", "--quiet"]);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let picture = read_image(&folder.join(format!("{name}.exr"))).unwrap();
    picture.pixels.as_flattened().iter().map(|&value| value.into()).collect()
}

/// A map that is flat leaves relight's own colour, up to what eight bits tilt its normals by: 0.3 degrees, which is 1.5 %
/// under a sun 20 degrees high.
#[test]
fn a_flat_map_has_the_colour_of_relight() {
    let folder = tempfile::tempdir().unwrap();
    let of = |name, scale| {
        let texture = |scale: f64| json!({"index": 0, "scale": scale});
        plane_under_a_sky(folder.path(), name, Option::map(scale, texture))
    };
    let (bare, flat, woven) = (of("bare", None), of("flat", Some(0.0)), of("woven", Some(1.0)));
    let difference = relative_l2(&flat, &bare).unwrap();
    let most = flat.iter().zip(&bare).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
    let mapped = relative_l2(&woven, &bare).unwrap();
    println!("flat: {difference:.1e} of the picture, {most:.1e} of a pixel at most; woven: {mapped:.1e}");
    assert!(difference < 0.015 && most < 0.02, "{difference} {most}");
    assert!(mapped > 5.0 * difference, "the map is drawn: {mapped}");
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
