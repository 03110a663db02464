//! What moves, end to end: pictures of `render` against f64, with shadows and without, in clear air and in fog.

#![cfg(all(feature = "relight", feature = "shadow", feature = "fog"))]

use std::path::Path;
use std::process::Command;

use airglow::fog::{Distant, Medium};
use airglow::math::sh::product::TripleProduct;
use airglow::math::sh::{evaluate, zonal};
use airglow::math::sphere::equirect::Projector;
use airglow::shadow::reference::{Reference, caps};
use airglow::shadow::{Exponential, Sphere};
use airglow_scene::FloatImage;
use airglow_scene::image_io::{read_environment, read_image};
use airglow_tests::golden::assert_text;
use glam::DVec3;
use serde_json::Value;

use super::counts::counts;
use super::root;

/// Pixels of a side, so many of them from one vertex of the ground to the next, which are 8 m / 12 apart.
const SIDE: usize = 65;
const STEP: usize = 8;
const SPACING: f64 = 8.0 / 12.0;
/// Of the eye, which looks straight down on the origin; metres.
const HEIGHT: f64 = 3.0;
const ORDER: usize = 4;
/// Base colour of the ground's material.
const GROUND: [f64; 3] = [0.62, 0.6, 0.57];
const BALL: Sphere = Sphere { center: DVec3::new(0.3, 1.3, 0.2), radius: 0.45 };
const EXTINCTION: [f64; 3] = [0.02, 0.05, 0.1];
const ALBEDO: f64 = 0.9;
/// Of the environment through the medium, metres.
const DISTANCE: f64 = 12.0;

const BLOCKER: &str = "[[blocker]]\ncenter = [0.3, 1.3, 0.2]\nradius = 0.45\n";

fn asset(name: &str) -> String {
    root().join("assets").join(name).display().to_string()
}

/// The ground from above, and what else a scene file says.
fn write(folder: &Path, name: &str, more: &str) {
    let degrees = 2.0 * (0.5 * SIDE as f64 * SPACING / STEP as f64 / HEIGHT).atan().to_degrees();
    let text = format!(
        "[[gltf]]\nfile = '{}'\nsubdivide = 2\n{more}[environment]\nfile = '{}'\ndistance = {DISTANCE}\n[camera]\n\
         from = [0, {HEIGHT}, 0]\nto = [0, 0, 0]\nup = [0, 0, -1]\nvertical_degrees = {degrees}\nnear = 0.1\n\
         [quality]\norder = {ORDER}\nshadow = 'unshadowed'\n",
        asset("mesh/ground.glb"),
        asset("env/courtyard_512.exr")
    );
    std::fs::write(folder.join(name), text).unwrap();
}

fn airglow(folder: &Path, arguments: &[&str]) -> String {
    let quiet = ["--device", "cpu", "--quiet"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_airglow"));
    let output = command.current_dir(folder).args(arguments).args(quiet).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The picture of a scene, scene-linear.
fn render(folder: &Path, scene: &str, more: &[&str]) -> FloatImage {
    let size = format!("{SIDE}x{SIDE}");
    let common = ["-o", "a.exr", "--size", &size, "--samples", "1", "--exposure", "1"];
    let once = if more.contains(&"--frames") { &[][..] } else { &["--frames", "1"] };
    airglow(folder, &[&["render", scene], &common[..], once, more].concat());
    read_image(&folder.join("a.exr")).unwrap()
}

/// Radiance of the ground at a place, whose light in each band is multiplied by `factors`.
fn truth(place: DVec3, spheres: &[Sphere], factors: &[[f64; 3]]) -> [f64; 3] {
    let map = read_environment(asset("env/courtyard_512.exr").as_ref()).unwrap();
    let light = Projector::new(ORDER, map.width, map.height).unwrap().project(&map.pixels).unwrap();
    let reference = Reference::new(ORDER).unwrap();
    let visibility = reference.visibility(Exponential::Adaptive, &caps(spheres, place)).unwrap();
    let product = TripleProduct::new(ORDER).unwrap();
    let (mut basis, cosine) = (vec![0.0; ORDER * ORDER], zonal::clamped_cosine(ORDER).unwrap());
    evaluate(ORDER, DVec3::Y, &mut basis).unwrap();
    [0, 1, 2].map(|channel| {
        let filtered = light.iter().enumerate().map(|(i, l)| l[channel] * factors[i.isqrt()][channel]);
        let (filtered, mut seen) = (filtered.collect::<Vec<f64>>(), vec![0.0; ORDER * ORDER]);
        product.product(&filtered, &visibility, &mut seen).unwrap();
        let band = |(i, y): (usize, &f64)| cosine[i.isqrt()] / std::f64::consts::PI * y * seen[i];
        GROUND[channel] * basis.iter().enumerate().map(band).sum::<f64>()
    })
}

/// Vertices of the ground that pixels show exactly: their places, and the pixels.
fn vertices() -> impl Iterator<Item = (DVec3, usize)> {
    let all = (-3..=3_i32).flat_map(|x| (-3..=3_i32).map(move |z| (x, z)));
    all.map(|(x, z)| {
        let pixel = |at: i32| (SIDE as i32 / 2 + STEP as i32 * at) as usize;
        (SPACING * DVec3::new(f64::from(x), 0.0, f64::from(z)), SIDE * pixel(z) + pixel(x))
    })
}

#[test]
fn shadow_times_transfer_is_the_reference_at_every_vertex_in_sight() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "ball.toml", BLOCKER);
    let picture = render(folder.path(), "ball.toml", &["--validate"]);
    let mut darkest = 1.0_f64;
    for (place, pixel) in vertices() {
        let expected = truth(place, &[BALL], &[[1.0; 3]; ORDER]);
        let open = truth(place, &[], &[[1.0; 3]; ORDER]);
        darkest = darkest.min(expected[1] / open[1]);
        for channel in 0..3 {
            let found = f64::from(picture.pixels[pixel][channel]);
            let error = (found - expected[channel]).abs() / open[channel];
            assert!(error < 2e-3, "{place}, channel {channel}: {found} instead of {}", expected[channel]);
        }
    }
    assert!(darkest < 0.9, "the ball takes a tenth of the light somewhere: {darkest}");
}

#[test]
fn fog_comes_over_shadowed_surfaces() {
    let folder = tempfile::tempdir().unwrap();
    let medium = format!("[medium]\nextinction = {EXTINCTION:?}\nalbedo = {ALBEDO}\n");
    write(folder.path(), "fog.toml", &format!("{BLOCKER}{medium}"));
    let shadowed = render(folder.path(), "fog.toml", &["--validate"]);
    let plain = render(folder.path(), "fog.toml", &["--without", "shadow"]);
    let air = Medium { extinction: EXTINCTION, albedo: [ALBEDO; 3], ..Medium::with_visibility(1.0) };
    let factors = Distant::new(&air, DISTANCE).unwrap().band_factors(ORDER).unwrap();
    for (place, pixel) in vertices() {
        let (with, without) = (truth(place, &[BALL], &factors), truth(place, &[], &factors));
        let way = (DVec3::Y * HEIGHT - place).length();
        for channel in 0..3 {
            let through = (-EXTINCTION[channel] * way).exp();
            let expected = through * (without[channel] - with[channel]);
            let found = f64::from(plain.pixels[pixel][channel]) - f64::from(shadowed.pixels[pixel][channel]);
            let error = (found - expected).abs() / (through * without[channel]);
            assert!(error < 2e-3, "{place}, channel {channel}: {found} instead of {expected}");
        }
    }
}

fn stat(folder: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(folder.join("stat.json")).unwrap()).unwrap()
}

/// Passes with their counts, and bytes held by each owner.
fn work(folder: &Path) -> Value {
    let stat = stat(folder);
    let passes = stat["passes"].as_array().unwrap().iter();
    let passes: Vec<Value> = passes.map(|pass| serde_json::json!([pass["name"], pass["counts"]])).collect();
    serde_json::json!([passes, stat["memory"]])
}

#[test]
fn where_nothing_blocks_every_bit_and_count_is_that_of_a_frame_without_the_pass() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    write(here, "ball.toml", BLOCKER);
    write(here, "bare.toml", "");
    let of = |scene: &str, more: &[&str]| {
        let picture = render(here, scene, &[&["--stat", "stat.json"], more].concat());
        (picture, work(here))
    };
    let (bare, ball) = (of("bare.toml", &[]), of("ball.toml", &["--without", "shadow"]));
    assert!(bare.0.pixels == ball.0.pixels, "the same bits");
    assert_eq!(bare.1, ball.1, "the same passes, counts and bytes");
    let counted = ["--health", "--pipeline-statistics", "--frames", "3"];
    assert_ne!(of("ball.toml", &counted).1, bare.1);
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/counts-ball.txt");
    assert_text(&golden, &counts("the shadow of a ball, 65 x 65 pixels, on llvmpipe", &stat(here)));
    for (scene, more, why) in [
        ("bare.toml", &[][..], "nothing that moves blocks"),
        ("ball.toml", &["--without", "shadow"], "asked to leave it out"),
        ("ball.toml", &["--order", "2"], "no tables for so many bands"),
    ] {
        let plan = airglow(here, &[&["plan", scene], more].concat());
        assert!(plan.contains(why) && !plan.contains("shadow visibility"), "{scene} {more:?}: {plan}");
    }
    let difference = airglow(here, &["plan", "ball.toml", "--what-if", "moving_shadow=off"]);
    assert!(difference.contains("- pass shadow visibility"), "{difference}");
}

/// A figure that walks to a time in frames of one plan is where one stands that starts there.
#[test]
fn figures_walk_within_a_plan() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let figure = "spheres = 2\nvelocity = [0, 0, 1]\ntranslation = [0.5, 0, -0.5]\n";
    write(here, "walk.toml", &format!("[[figure]]\nfile = '{}'\n{figure}", asset("mesh/walker.glb")));
    let start = render(here, "walk.toml", &[]);
    let walked = render(here, "walk.toml", &["--frames", "3", "--step", "0.2", "--validate"]);
    let there = render(here, "walk.toml", &["--time", "0.4"]);
    assert!(start.pixels != walked.pixels);
    let step = |a: &FloatImage, b: &FloatImage| -> f64 {
        let pairs = a.pixels.as_flattened().iter().zip(b.pixels.as_flattened());
        pairs.map(|(a, b)| f64::from((a - b).abs())).sum()
    };
    let (rest, way) = (step(&walked, &there), step(&start, &there));
    assert!(rest < 0.01 * way, "{rest} from the place that is {way} away");
    let plan = airglow(here, &["plan", "walk.toml", "--check"]);
    assert!(plan.contains("skin") && plan.contains("shadow visibility"), "{plan}");
    let spheres = std::fs::read_dir(here.join(".cache/airglow")).unwrap();
    let names = spheres.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    assert_eq!(names.filter(|name| name.ends_with(".spheres.json")).count(), 1, "fitted once");
}

#[test]
fn spheres_of_a_mesh_are_written_to_be_read_and_seen() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let walker = asset("mesh/walker.glb");
    let files = ["-o", "s.json", "-o", "s.obj", "-o", "s.glb", "--resolution", "8"];
    let said = airglow(here, &[&["spheres", &walker, "--count", "5"], &files[..]].concat());
    assert!(said.contains("5 spheres"), "{said}");
    let json: Value = serde_json::from_slice(&std::fs::read(here.join("s.json")).unwrap()).unwrap();
    assert_eq!(json[0]["spheres"].as_array().unwrap().len(), 5);
    assert!(airglow_scene::load(&here.join("s.glb")).unwrap().meshes[0].triangle_count() > 5 * 1000);
    let case = airglow(here, &["stability", "shadow", "--case", "a skin of zero weights"]);
    assert!(case.contains("it stays"), "{case}");
}
