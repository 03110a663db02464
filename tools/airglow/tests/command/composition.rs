//! The passes together, end to end: identities that hold only if light meets surfaces in the right order.

#![cfg(all(
    feature = "fog",
    feature = "normals",
    feature = "radiance",
    feature = "relight",
    feature = "shadow"
))]

use std::path::{Path, PathBuf};
use std::process::Command;

use airglow::radiance::reference::Cube;
use airglow::radiance::{Lights, Sphere};
use airglow_scene::FloatImage;
use airglow_scene::image_io::{read_image, write_exr};
use glam::DVec3;
use serde_json::Value;

use super::root;

const SIZE: [usize; 2] = [32, 18];
/// Metres of the camera over the ground, which it looks straight down at, and half of what it sees of it from top to bottom.
const HEIGHT: f64 = 3.0;
const HALF: f64 = 1.09;
/// Metres of a near environment's light through the medium.
const FAR: &str = "[environment]\nfile = 'env.exr'\ndistance = 40\n";
const SKY: &str = "[environment]\nfile = 'env.exr'\n";
const LAMP: &str = "[[emitter]]\ncenter = [0.6, 1.2, 5]\nradius = 0.3\nradiance = [60, 30, 10]\n";
const BALL: &str = "[[blocker]]\ncenter = [1.5, 1.2, 0]\nradius = 1.2\n";

/// A folder with an environment that is red towards +X and blue towards -X.
struct Stage {
    folder: tempfile::TempDir,
    /// Of the camera, metres.
    height: f64,
}

impl Stage {
    fn new() -> Self {
        Self::seen_from(HEIGHT)
    }

    /// The same ground seen from another height.
    fn seen_from(height: f64) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let size = [32, 16];
        let texel = |at: usize| if at % size[0] < size[0] / 2 { [0.0, 0.1, 1.0] } else { [1.0, 0.1, 0.0] };
        let pixels = (0..size[0] * size[1]).map(texel).collect();
        write_exr(&folder.path().join("env.exr"), &FloatImage { width: size[0], height: size[1], pixels })
            .unwrap();
        Self { folder, height }
    }

    fn write(&self, mesh: &str, parts: &[&str]) -> PathBuf {
        let mesh = root().join("assets/mesh").join(mesh);
        let text = format!(
            "[[gltf]]\nfile = '{}'\n{}[camera]\nfrom = [0, {}, 0]\nto = [0, 0, 0]\nup = [0, 0, -1]\n\
             vertical_degrees = {}\nnear = 0.1\nfar = 20\n[exposure]\nscale = 1\n\
             [quality]\norder = 4\nrays = 16\nshadow = 'unshadowed'\n",
            mesh.display(),
            parts.concat(),
            self.height,
            2.0 * (HALF / self.height).atan().to_degrees()
        );
        let file = self.folder.path().join("scene.toml");
        std::fs::write(&file, text).unwrap();
        file
    }

    fn airglow(&self, command: &str, scene: &Path, more: &[&str]) -> Vec<u8> {
        let output = Command::new(env!("CARGO_BIN_EXE_airglow"))
            .current_dir(self.folder.path())
            .args([command, &scene.display().to_string(), "--device", "cpu", "--quiet"])
            .args(more)
            .output()
            .unwrap();
        assert!(output.status.success(), "{more:?}: {}", String::from_utf8_lossy(&output.stderr));
        output.stdout
    }

    /// The ground as the scene's parts light it, scene-linear.
    fn picture(&self, mesh: &str, parts: &[&str], more: &[&str]) -> Vec<[f64; 3]> {
        let size = format!("{}x{}", SIZE[0], SIZE[1]);
        let drawn = ["-o", "out.exr", "--samples", "1", "--frames", "1", "--size", &size];
        self.airglow("render", &self.write(mesh, parts), &[&drawn, more].concat());
        let picture = read_image(&self.folder.path().join("out.exr")).unwrap();
        picture.pixels.iter().map(|pixel| pixel.map(f64::from)).collect()
    }

    fn plan(&self, scene: &Path, more: &[&str]) -> Value {
        serde_json::from_slice(&self.airglow("plan", scene, &[&["--json"], more].concat())).unwrap()
    }
}

fn mean(picture: &[[f64; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|c| picture.iter().map(|pixel| pixel[c]).sum::<f64>() / picture.len() as f64)
}

/// The largest difference, W/sr/m2.
fn difference(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let pairs = a.as_flattened().iter().zip(b.as_flattened());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Values of a key in a list of the plan's.
fn texts<'a>(plan: &'a Value, list: &str, key: &'a str) -> impl Iterator<Item = &'a str> {
    plan[list].as_array().into_iter().flatten().filter_map(move |item| item[key].as_str())
}

/// Whether a step is a room's.
fn has(plan: &Value, room: &str) -> bool {
    texts(plan, "steps", "name").any(|name| name.split(' ').next() == Some(room))
}

#[test]
fn every_pass_has_something_to_do_in_the_demo() {
    let stage = Stage::new();
    let quick = ["--order", "3", "--rays", "1", "--shadow", "unshadowed", "--cache", "cache"];
    let scene = root().join("assets/scenes/demo.toml");
    // Filtering its maps takes seconds: that they are there is enough.
    let plan = stage.plan(&scene, &[&quick[..], &["--without", "normals"]].concat());
    for room in ["shadow", "radiance", "relight", "fog"] {
        assert!(has(&plan, room), "no step of {room}");
    }
    let said = |what: &str| what == "normals";
    assert!(texts(&plan, "left_out", "what").any(said), "no maps to leave out");
}

#[test]
fn a_pass_left_out_is_gone_from_plan_and_memory_and_the_others_stay() {
    let stage = Stage::new();
    let medium = "[medium]\nextinction = 0.05\nalbedo = 0.9\n";
    // Only one of the two has a map, which takes its time.
    let write = |room: &str| {
        let mesh = if room == "normals" { "grooves.glb" } else { "ground.glb" };
        stage.write(mesh, &[FAR, medium, LAMP, BALL])
    };
    let bytes = |plan: &Value| plan["bytes"]["imported"].as_u64().zip(plan["bytes"]["transient"].as_u64());
    let rooms = ["shadow", "radiance", "relight", "normals", "fog"];
    for left_out in rooms {
        let scene = write(left_out);
        let [whole, plan] = [&[][..], &["--without", left_out]].map(|more| stage.plan(&scene, more));
        assert!(!has(&plan, left_out), "{left_out} is still there");
        assert!(texts(&plan, "left_out", "what").any(|what| what == left_out), "{left_out}: {plan}");
        let [(imported, transient), (all_imported, all_transient)] =
            [&plan, &whole].map(|plan| bytes(plan).unwrap());
        let saved = (imported <= all_imported && transient <= all_transient, imported + transient);
        assert!(saved.0 && saved.1 < all_imported + all_transient, "{left_out}: {saved:?} bytes");
        // Light of near emitters and shadows of what moves go where relighting takes them, or nowhere.
        let feed = |room: &str| left_out == "relight" && ["shadow", "radiance"].contains(&room);
        for room in rooms.into_iter().filter(|room| *room != left_out && has(&whole, room)) {
            assert_eq!(has(&plan, room), !feed(room), "{room} without {left_out}");
        }
    }
}

#[test]
fn a_pass_left_out_has_no_time_in_the_frame_and_no_memory() {
    let stage = Stage::new();
    let medium = "[medium]\nextinction = 0.05\nalbedo = 0.9\n";
    let stat = |mesh: &str, more: &[&str]| -> Value {
        let drawn =
            ["-o", "out.exr", "--samples", "1", "--frames", "4", "--size", "32x18", "--stat", "stat.json"];
        let scene = stage.write(mesh, &[FAR, medium, LAMP, BALL]);
        stage.airglow("render", &scene, &[&drawn, more].concat());
        serde_json::from_slice(&std::fs::read(stage.folder.path().join("stat.json")).unwrap()).unwrap()
    };
    let timed = |stat: &Value, room: &str| {
        let mut rows = stat["passes"].as_array().unwrap().iter();
        assert!(rows.clone().all(|row| row["median_ms"].is_f64()), "{stat}");
        rows.any(|row| row["name"].as_str().unwrap().split(' ').next() == Some(room))
    };
    let holds = |stat: &Value, room: &str| texts(stat, "memory", "owner").any(|owner| owner == room);
    // Fog has memory of its own where lamps shine on surfaces in it. Maps have no pass: the scene's own draw looks them up.
    for (mesh, rooms) in
        [("ground.glb", &["shadow", "radiance", "relight"][..]), ("lights_room.glb", &["fog"])]
    {
        let whole = stat(mesh, &[]);
        for room in rooms {
            let left = stat(mesh, &["--without", room]);
            assert_eq!([timed(&whole, room), timed(&left, room)], [true, false], "times of {room}");
            assert_eq!([holds(&whole, room), holds(&left, room)], [true, false], "memory of {room}");
        }
    }
    let left = stat("grooves.glb", &["--without", "normals"]);
    assert!(!timed(&left, "normals") && !holds(&left, "normals"), "{left}");
}

#[test]
fn near_light_and_maps_left_out_leave_the_pixels_of_a_scene_without_them() {
    let stage = Stage::new();
    let sky = stage.picture("ground.glb", &[SKY], &[]);
    assert!(sky == stage.picture("ground.glb", &[SKY, LAMP], &["--without", "radiance"]), "radiance");
    assert!(sky == stage.picture("ground.glb", &[SKY], &["--without", "normals"]), "normals");
}

#[test]
fn near_and_distant_light_add_before_the_transfer_product() {
    let stage = Stage::new();
    let [near, far, both] =
        [&[LAMP][..], &[SKY], &[LAMP, SKY]].map(|parts| stage.picture("ground.glb", parts, &[]));
    let sum: Vec<_> = near.iter().zip(&far).map(|(a, b)| [0, 1, 2].map(|c| a[c] + b[c])).collect();
    let (found, contributions) = (difference(&both, &sum), [mean(&near)[0], mean(&far)[0]]);
    assert!(found < 1e-5 && contributions.iter().all(|x| *x > 0.03), "{found:.1e}, {contributions:?}");
}

#[test]
fn a_dynamic_shadow_takes_the_light_behind_the_blocker_and_leaves_the_other() {
    let stage = Stage::new();
    let [open, shadowed] = [&[SKY][..], &[SKY, BALL]].map(|parts| stage.picture("ground.glb", parts, &[]));
    let truth = stage.picture("ground.glb", &[SKY, BALL], &["--reference", "--reference-rays", "2048"]);
    let [open, shadowed, truth] = [open, shadowed, truth].map(|picture| mean(&picture));
    let left = [0, 2].map(|c| shadowed[c] / open[c]);
    let of_truth = [0, 2].map(|c| truth[c] / open[c]);
    // A factor on the colour would take the same share of red and blue.
    assert!(left[0] + 0.05 < left[1], "red and blue left: {left:?}");
    let error = [0, 1].map(|c| (left[c] - of_truth[c]).abs());
    assert!(error.iter().all(|x| *x < 0.02), "left {left:?}, by rays {of_truth:?}");
}

#[test]
fn the_medium_filters_distant_light_before_it_relights_with_near_emitters_as_without() {
    let stage = Stage::new();
    let medium = "[medium]\nextinction = [0.01, 0.03, 0.06]\nalbedo = 0.9\n";
    // It lights nothing to speak of, but has the light come to each vertex by the other pass.
    let spark = "[[emitter]]\ncenter = [0.6, 1.2, 5]\nradius = 0.3\nradiance = 1e-6\n";
    let clear = stage.picture("ground.glb", &[SKY], &[]);
    let [one, other] =
        [&[FAR, medium][..], &[FAR, medium, spark]].map(|parts| stage.picture("ground.glb", parts, &[]));
    let (found, changed) = (difference(&one, &other), difference(&one, &clear));
    assert!(found < 1e-4 && changed > 0.05, "between the roads {found:.1e}, from clear air {changed:.2}");
}

#[test]
fn normal_maps_reflect_the_light_that_shadows_leave() {
    let stage = Stage::new();
    let dark = "[environment]\nfile = 'env.exr'\nscale = 1e-6\n";
    let over = "[[blocker]]\ncenter = [1.2, 1.4, 0]\nradius = 0.9\n";
    let draw = |more: &[&str]| {
        [&[dark][..], &[SKY, over], &[SKY]].map(|parts| stage.picture("weave.glb", parts, more))
    };
    let [mapped, smooth] = [draw(&["--maps", "mip"]), draw(&["--without", "normals"])];
    let shadowed = |at: &usize| (smooth[1][*at][0] - smooth[2][*at][0]).abs() > 1e-3;
    let places: Vec<usize> = (0..SIZE[0] * SIZE[1]).filter(shadowed).collect();
    // Of the distant light alone: the mesh brings lamps, which cast no shadows.
    let left = |[lamps, shadowed, open]: &[Vec<[f64; 3]>; 3], c: usize| {
        let sum = |picture: &[[f64; 3]]| places.iter().map(|at| picture[*at][c]).sum::<f64>();
        (sum(shadowed) - sum(lamps)) / (sum(open) - sum(lamps))
    };
    let [red, blue] = [0, 2].map(|c| [left(&mapped, c), left(&smooth, c)]);
    assert!(red[1] < 0.8 && blue[1] > 0.9, "left of the light of smooth cloth: red {red:?}, blue {blue:?}");
    let differs = |[mapped, smooth]: [f64; 2]| (mapped - smooth).abs() > 0.05;
    assert!(!differs(red) && !differs(blue), "left of mapped and of smooth cloth: {red:?}, {blue:?}");
}

/// Where each pixel sees the ground, metres.
fn ground() -> impl Iterator<Item = [f64; 2]> {
    let across = |i: usize, axis: usize| (2.0 * i as f64 + 1.0 - SIZE[axis] as f64) / SIZE[1] as f64 * HALF;
    (0..SIZE[0] * SIZE[1]).map(move |at| [across(at % SIZE[0], 0), across(at / SIZE[0], 1)])
}

/// Metres from the ground to a camera.
fn way(height: f64, [x, z]: [f64; 2]) -> f64 {
    (height * height + x * x + z * z).sqrt()
}

/// It scatters nothing, so that it only takes.
const MEDIUM: &str = "[medium]\nextinction = [0.05, 0.1, 0.2]\nalbedo = 0\n";
const EXTINCTION: [f64; 3] = [0.05, 0.1, 0.2];

#[test]
fn fog_comes_last_and_once() {
    let heights = [HEIGHT, 2.0 * HEIGHT];
    let [near, far] =
        heights.map(|height| Stage::seen_from(height).picture("ground.glb", &[LAMP, BALL, MEDIUM], &[]));
    let mut worst = 0.0_f64;
    for (place, (near, far)) in ground().zip(near.iter().zip(&far)) {
        let further = way(heights[1], place) - way(heights[0], place);
        for (c, extinction) in EXTINCTION.into_iter().enumerate() {
            let expected = near[c] * (-extinction * further).exp();
            worst = worst.max((far[c] - expected).abs() / expected.max(1e-3));
        }
    }
    assert!(worst < 1e-3, "relative difference {worst:.1e} from one passage");
}

#[test]
fn the_medium_dims_near_light_on_its_way_to_the_surface() {
    let stage = Stage::new();
    let none = "[medium]\nextinction = 0\nalbedo = 0\n";
    let fine = "[quality.presets]\nradiance = 'reference'\n";
    let [clear, empty, fogged] = [&[LAMP, fine][..], &[LAMP, fine, none], &[LAMP, fine, MEDIUM]]
        .map(|parts| stage.picture("ground.glb", parts, &[]));
    assert!(clear == empty, "a medium of no extinction differs by {:.1e}", difference(&clear, &empty));
    let lamp = [Sphere { centre: DVec3::new(0.6, 1.2, 5.0), radius: 0.3, radiance: DVec3::ONE }];
    let cube = Cube::new(1, 64).unwrap();
    let arriving = |point: DVec3, extinction: [f32; 3]| {
        let lights = Lights { spheres: &lamp, extinction, ..Lights::default() };
        cube.sample_lights(point, &lights).unwrap().coefficients[0]
    };
    let (light, mut worst) = (mean(&clear), 0.0_f64);
    for (place, (clear, fogged)) in ground().zip(clear.iter().zip(&fogged)).step_by(7) {
        let point = DVec3::new(place[0], 0.0, place[1]);
        let left = arriving(point, EXTINCTION.map(|x| x as f32)) / arriving(point, [0.0; 3]);
        for (c, extinction) in EXTINCTION.into_iter().enumerate() {
            let expected = clear[c] * left[c] * (-extinction * way(HEIGHT, place)).exp();
            worst = worst.max((fogged[c] - expected).abs() / light[c]);
        }
    }
    // Samples are bounded by what they err of the light there is, not of what the medium leaves.
    assert!(worst < 0.05, "{worst:.1e} of the light in clear air from light dimmed twice");
}
