//! Scenes in a medium, end to end: pictures of `render` against what the model says of them.

#![cfg(all(feature = "fog", feature = "relight"))]

use std::path::Path;
use std::process::Command;

use airglow::fog::reference::environment::factors;
use airglow::fog::{Distant, Medium};
use airglow::math::sphere::equirect;
use airglow_scene::FloatImage;
use airglow_scene::image_io::{read_image, write_exr};
use glam::DVec3;
use serde_json::json;

const SIZE: [usize; 2] = [48, 27];
/// Of the wall, metres before the eye, which looks down -Z.
const WALL: f64 = 20.0;
const HALF_WIDTH: f64 = 8.0;
const EXTINCTION: [f64; 3] = [0.01, 0.03, 0.06];
const ALBEDO: f64 = 0.9;
/// Of the environment, metres.
const DISTANCE: f64 = 40.0;
/// Bands 0 and 1 of the environment in its map: `MEAN + SLOPE . direction`.
const MEAN: f64 = 1.0;
const SLOPE: DVec3 = DVec3::new(0.5, 0.3, -0.2);

/// A white wall of so many squares along a side, and a lamp before it where that is asked for.
fn write_wall(folder: &Path, squares: u16, lamp: bool) {
    let side = squares + 1;
    let place = |at: u16| HALF_WIDTH as f32 * (2.0 * f32::from(at) / f32::from(squares) - 1.0);
    let corners = (0..side * side).flat_map(|at| [place(at % side), place(at / side), -WALL as f32]);
    let normals = [0.0_f32, 0.0, 1.0].repeat(usize::from(side * side));
    let mut bytes: Vec<u8> = corners.chain(normals).flat_map(f32::to_le_bytes).collect();
    let square = |at: u16| {
        let corner = at / squares * side + at % squares;
        [0, 1, side + 1, 0, side + 1, side].map(|step| corner + step)
    };
    bytes.extend((0..squares * squares).flat_map(square).flat_map(u16::to_le_bytes));
    std::fs::write(folder.join("wall.bin"), &bytes).unwrap();
    let count = usize::from(side * side);
    let view = |offset, length| json!({"buffer": 0, "byteOffset": offset, "byteLength": length});
    let w = HALF_WIDTH;
    let vectors = |view| {
        json!({"bufferView": view, "componentType": 5126, "count": count, "type": "VEC3",
        "min": [-w, -w, -WALL], "max": [w, w, 1.0]})
    };
    let mut wall = json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "buffers": [{"uri": "wall.bin", "byteLength": bytes.len()}],
        "bufferViews": [view(0, 12 * count), view(12 * count, 12 * count),
            view(24 * count, bytes.len() - 24 * count)],
        "accessors": [vectors(0), vectors(1), {"bufferView": 2, "componentType": 5123,
            "count": 6 * usize::from(squares * squares), "type": "SCALAR"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}],
    });
    if lamp {
        wall["extensionsUsed"] = json!(["KHR_lights_punctual"]);
        wall["extensions"] = json!({"KHR_lights_punctual": {"lights": [
            {"type": "point", "intensity": 40.0, "color": [1.0, 0.7, 0.4]}]}});
        wall["scenes"] = json!([{"nodes": [0, 1]}]);
        wall["nodes"] = json!([{"mesh": 0}, {"translation": [1.5, 1.0, 3.0 - WALL],
            "extensions": {"KHR_lights_punctual": {"light": 0}}}]);
    }
    std::fs::write(folder.join("wall.gltf"), wall.to_string()).unwrap();
}

/// The wall before a smooth environment that is turned by 90 degrees.
fn write_scene(folder: &Path) {
    write_wall(folder, 1, false);
    let texel = |at: usize| {
        let place = [at % 64, at / 64].map(|at| at as f64 + 0.5);
        let value = (MEAN + SLOPE.dot(equirect::direction(place[0] / 64.0, place[1] / 32.0))) as f32;
        [value, 0.5 * value, 2.0 * value]
    };
    let sky = FloatImage { width: 64, height: 32, pixels: (0..64 * 32).map(texel).collect() };
    write_exr(&folder.join("sky.exr"), &sky).unwrap();
    let sky = format!("[environment]\nfile = 'sky.exr'\nrotation = {{ yaw = 90 }}\ndistance = {DISTANCE}\n");
    std::fs::write(folder.join("scene.toml"), scene(&sky)).unwrap();
}

/// The wall in the medium, and what else a scene file says.
fn scene(more: &str) -> String {
    format!(
        "[[gltf]]\nfile = 'wall.gltf'\n{more}[medium]\nextinction = {EXTINCTION:?}\nalbedo = {ALBEDO}\n[camera]\n\
         from = [0, 0, 0]\nto = [0, 0, -1]\nvertical_degrees = 60\nnear = 0.1\nfar = 1000.0\n\
         [quality]\norder = 3\nrays = 64\nshadow = 'unshadowed'\n"
    )
}

/// The picture that `render` makes of a scene, scene-linear.
fn render(folder: &Path, scene: &str, more: &[&str]) -> FloatImage {
    let common = ["-o", "picture.exr", "--samples", "1", "--frames", "1", "--exposure", "1"];
    let quiet = ["--device", "cpu", "--quiet", "--validate"];
    let arguments = [&["render", scene], &common[..], &quiet[..], more].concat();
    let program = env!("CARGO_BIN_EXE_airglow");
    let output = Command::new(program).current_dir(folder).args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    read_image(&folder.join("picture.exr")).unwrap()
}

/// The view ray of a pixel, not of unit length: z is -1.
fn ray(pixel: usize) -> DVec3 {
    let half = 30_f64.to_radians().tan();
    let [x, y] = [pixel % SIZE[0], pixel / SIZE[0]].map(|at| at as f64 + 0.5);
    let aspect = SIZE[0] as f64 / SIZE[1] as f64;
    DVec3::new(
        half * aspect * (2.0 * x / SIZE[0] as f64 - 1.0),
        half * (1.0 - 2.0 * y / SIZE[1] as f64),
        -1.0,
    )
}

/// Whether the wall stands before a pixel; `None` next to its edges.
fn shows_wall(ray: DVec3) -> Option<bool> {
    let out = (WALL * ray.x.abs()).max(WALL * ray.y.abs()) - HALF_WIDTH;
    (out.abs() > 1.0).then_some(out < 0.0)
}

/// The radiance of a pixel in one channel, in units of the environment's in it. The environment has two bands, which are
/// multiplied by what the medium makes of them, on the way to the eye and on that to the wall.
fn truth(ray: DVec3, channel: usize) -> Option<f64> {
    let medium = Medium { extinction: EXTINCTION, albedo: [ALBEDO; 3], ..Medium::with_visibility(1.0) };
    let filter = Distant::new(&medium, DISTANCE).unwrap().band_factors(2).unwrap();
    let [mean, slope] = [filter[0][channel], filter[1][channel]];
    // World from map turns +X to -Z.
    let bands = |direction: DVec3| SLOPE.dot(DVec3::new(-direction.z, direction.y, direction.x));
    if !shows_wall(ray)? {
        return Some(mean * MEAN + slope * bands(ray.normalize()));
    }
    // The cosine about a normal takes two thirds of band 1.
    let wall = mean * MEAN + 2.0 / 3.0 * slope * bands(DVec3::Z);
    let way = EXTINCTION[channel] * WALL * ray.length();
    let before = factors(2, way, EXTINCTION[channel] * DISTANCE).unwrap();
    let scattered = before[0] * MEAN + before[1] * bands(ray.normalize());
    Some((-way).exp() * wall + ALBEDO * scattered)
}

#[test]
fn an_environment_in_fog_lights_and_is_seen_as_its_convolution() {
    let folder = tempfile::tempdir().unwrap();
    write_scene(folder.path());
    let picture = render(folder.path(), "scene.toml", &["--size", "48x27"]);
    let mut worst = [0.0_f64; 2];
    for (pixel, found) in picture.pixels.iter().enumerate() {
        let ray = ray(pixel);
        for (channel, scale) in [1.0, 0.5, 2.0].into_iter().enumerate() {
            let Some(expected) = truth(ray, channel) else { continue };
            let error = (f64::from(found[channel]) / (scale * expected) - 1.0).abs();
            let kind = usize::from(shows_wall(ray) == Some(true));
            worst[kind] = worst[kind].max(error);
        }
    }
    println!("background within {:.2e}, wall within {:.2e}", worst[0], worst[1]);
    // The background errs by what of the map is summed as one part.
    assert!(worst[0] < 2e-2 && worst[1] < 1e-3, "{worst:?}");
}

#[test]
fn depth_fog_is_a_share_by_distance_and_stands_beside_the_others() {
    let folder = tempfile::tempdir().unwrap();
    write_scene(folder.path());
    let size = ["--size", "48x27"];
    let clear = render(folder.path(), "scene.toml", &[&size[..], &["--without", "fog"]].concat());
    let fogged = render(folder.path(), "scene.toml", &[&size[..], &["--depth-fog"]].concat());
    let colour = fogged.pixels[0];
    for (pixel, (clear, fogged)) in clear.pixels.iter().zip(&fogged.pixels).enumerate() {
        let Some(wall) = shows_wall(ray(pixel)) else { continue };
        for c in 0..3 {
            let left = if wall { (-EXTINCTION[c] * WALL).exp() as f32 } else { 0.0 };
            let expected = left * clear[c] + (1.0 - left) * colour[c];
            assert!((fogged[c] / expected - 1.0).abs() < 1e-4, "{pixel}: {} and {expected}", fogged[c]);
        }
    }
    let three = render(folder.path(), "scene.toml", &[&size[..], &["--compare-fog"]].concat());
    assert_eq!((three.width, three.height), (3 * 48, 27));
    let row = |picture: &FloatImage, from: usize| picture.pixels[from..from + 48].to_vec();
    assert_eq!(row(&three, 0), row(&clear, 0));
    assert_eq!(row(&three, 48), row(&fogged, 0));
}

/// A white wall in fog with a lamp before it, by two draws and by one.
#[test]
fn the_complete_model_in_one_draw_is_the_picture_of_the_pass() {
    let folder = tempfile::tempdir().unwrap();
    write_wall(folder.path(), 64, true);
    std::fs::write(folder.path().join("night.toml"), scene("")).unwrap();
    let draw = |more: &[&str]| render(folder.path(), "night.toml", &[&["--size", "96x54"], more].concat());
    let pass = draw(&[]);
    let brightest = pass.pixels.as_flattened().iter().copied().fold(0.0, f32::max);
    let errors = |other: &FloatImage| {
        let pairs = pass.pixels.as_flattened().iter().zip(other.pixels.as_flattened());
        let relative = pairs.map(|(a, b)| f64::from((a - b).abs() / (a + 1e-3 * brightest)));
        let (worst, sum) = relative.fold((0.0_f64, 0.0), |(worst, sum), e| (worst.max(e), sum + e * e));
        [worst, (sum / (3 * pass.pixels.len()) as f64).sqrt()]
    };
    let [pixels, _] = errors(&draw(&["--complete", "pixels"]));
    // Between vertices a quarter of a metre apart the glow next to the lamp has a peak that they do not see.
    let [vertices, mean] = errors(&draw(&["--complete", "vertices"]));
    println!("at pixels within {pixels:.1e}, at vertices within {vertices:.1e}, {mean:.1e} root mean square");
    assert!(brightest > 0.1 && pixels < 1e-5 && vertices < 0.2 && mean < 0.02, "{pixels} {vertices} {mean}");
}
