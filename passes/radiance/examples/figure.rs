//! Figure 4.1 of Sun 2005 with another animal: `cargo run --release -p airglow-radiance --example figure -- figure.png`.
//!
//! A cow before a matrix of coloured blocks: light sampled at each vertex; by the oracle, with gradients; as many samples
//! spread evenly, weighed with 1/d^2; and where the oracle's lie, as dots in rings of the size of their domains. The scene is
//! `assets/scenes/blocks.toml` without its sky; another name after the file's takes another, `armadillo` the thesis's own.

use airglow_radiance::reference::Cube;
use airglow_radiance::{
    Glow, Incident, OVERLAP, RadianceError, Reconstruction, Refined, Settings, Weights, refine, rivals,
};
use airglow_scene::FloatImage;
use airglow_scene::image_io::write_png;
use glam::DVec3;

#[expect(dead_code, reason = "another example reads the rest")]
#[path = "common/scene.rs"]
mod scene;

use scene::{Failure, Placed};

const ORDER: usize = 4;
/// Pixels along a side of each of the four pictures.
const SIDE: usize = 360;

/// From where the pictures are seen, without perspective.
#[derive(Clone, Copy)]
struct View {
    /// In the middle of the picture, metres.
    middle: DVec3,
    /// Unit axes to the right, upwards and into the picture.
    axes: [DVec3; 3],
    /// Pixels a metre.
    scale: f64,
}

impl View {
    /// Of all of a scene, from the side of its emitters.
    fn of(placed: &Placed) -> Self {
        let corners = || placed.emitters.iter().flat_map(|emitter| emitter.corners);
        let middle = |points: &mut dyn Iterator<Item = DVec3>| {
            let (low, high) = points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), point| {
                (low.min(point), high.max(point))
            });
            (0.5 * (low + high), (high - low).max_element())
        };
        let points = placed.points();
        let (whole, size) = middle(&mut points.iter().copied().chain(corners()));
        let way = (middle(&mut points.iter().copied()).0 - middle(&mut corners()).0).z.signum();
        let forward = DVec3::new(3.0 * way, -0.9, 2.6 * way).normalize();
        let right = forward.cross(DVec3::Y).normalize();
        let axes = [right, right.cross(forward), forward];
        Self { middle: whole, axes, scale: SIDE as f64 / (1.25 * size) }
    }

    /// Place in the picture, pixels, and depth.
    fn place(self, point: DVec3) -> DVec3 {
        let [x, y, z] = self.axes.map(|axis| (point - self.middle).dot(axis));
        DVec3::new(x * self.scale, -y * self.scale, z) + 0.5 * SIDE as f64 * (DVec3::X + DVec3::Y)
    }
}

/// A picture with the depth of each pixel.
struct Picture {
    view: View,
    pixels: Vec<[f32; 3]>,
    depth: Vec<f64>,
}

impl Picture {
    fn new(view: View) -> Self {
        Self { view, pixels: vec![[0.02; 3]; SIDE * SIDE], depth: vec![f64::INFINITY; SIDE * SIDE] }
    }

    fn put(&mut self, x: f64, y: f64, depth: f64, colour: DVec3) {
        if x < 0.0 || y < 0.0 || x >= SIDE as f64 || y >= SIDE as f64 {
            return;
        }
        let at = y as usize * SIDE + x as usize;
        if depth < self.depth[at] {
            (self.depth[at], self.pixels[at]) = (depth, colour.as_vec3().to_array());
        }
    }

    fn triangle(&mut self, corners: [DVec3; 3], colours: [DVec3; 3]) {
        let [a, b, c] = corners.map(|corner| self.view.place(corner));
        let cross = |u: DVec3, v: DVec3| u.x * v.y - u.y * v.x;
        let area = cross(b - a, c - a);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        for y in low.y.floor() as i64..=high.y.ceil() as i64 {
            for x in low.x.floor() as i64..=high.x.ceil() as i64 {
                let point = DVec3::new(x as f64 + 0.5, y as f64 + 0.5, 0.0);
                let weights = [(b, c), (c, a), (a, b)].map(|(u, v)| cross(u - point, v - point) / area);
                if weights.iter().all(|w| *w >= 0.0) {
                    let depth = weights[0] * a.z + weights[1] * b.z + weights[2] * c.z;
                    let colour = weights[0] * colours[0] + weights[1] * colours[1] + weights[2] * colours[2];
                    self.put(point.x, point.y, depth, colour.max(DVec3::ZERO));
                }
            }
        }
    }

    /// A dot in a ring about a sample, in front of everything.
    fn ring(&mut self, centre: DVec3, radius: f64, colour: DVec3) {
        let (middle, scale) = (self.view.place(centre), radius * self.view.scale);
        for step in 0..256 {
            let angle = std::f64::consts::TAU * f64::from(step) / 256.0;
            for r in [scale, 0.0, 1.0, 1.5] {
                let (x, y) = (middle.x + r * angle.cos(), middle.y + r * angle.sin());
                self.put(x, y, f64::NEG_INFINITY, colour);
            }
        }
    }

    /// The receiver in its colours, and the emitters.
    fn drawn(view: View, placed: &Placed, colours: &[DVec3]) -> Self {
        let mut picture = Self::new(view);
        for triangle in placed.indices.chunks_exact(3) {
            let corners = [triangle[0], triangle[1], triangle[2]].map(|i| i as usize);
            picture.triangle(corners.map(|i| placed.point(i)), corners.map(|i| colours[i]));
        }
        placed.emitters.iter().for_each(|emitter| picture.triangle(emitter.corners, [emitter.radiance; 3]));
        picture
    }
}

/// Colours of all vertices, from light of each.
fn coloured(placed: &Placed, mut light: impl FnMut(DVec3) -> Vec<DVec3>) -> Vec<DVec3> {
    (0..placed.positions.len()).map(|vertex| placed.colour(vertex, &light(placed.point(vertex)))).collect()
}

fn ours(placed: &Placed, refined: &Refined) -> Result<Vec<DVec3>, RadianceError> {
    let reconstruction = Reconstruction::new(refined, Weights::Compact, true);
    let (mut light, mut failure) = (vec![DVec3::ZERO; ORDER * ORDER], Ok(0));
    let colours = coloured(placed, |point| {
        let found = reconstruction.light(point, &mut light);
        if found.is_err() {
            failure = found;
        }
        light.clone()
    });
    failure.map(|_| colours)
}

fn main() -> Result<(), Failure> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().unwrap_or_else(|| "figure.png".to_owned());
    let name = arguments.next().unwrap_or_else(|| "blocks".to_owned());
    let data = (name == "armadillo").then_some("mesh/armadillo_10k.glb");
    let Some(placed) = Placed::load(&name, data)? else { return Ok(()) };

    let cube = Cube::new(ORDER, 64)?.with_gradients();
    let sample = |points: &[DVec3]| -> Result<Vec<Incident>, RadianceError> {
        points.iter().map(|point| cube.sample(*point, &placed.emitters)).collect()
    };
    let mut lights = sample(&placed.points())?.into_iter();
    let truth = coloured(&placed, |_| lights.next().map_or_else(Vec::new, |light| light.coefficients));

    let settings = Settings { bound: 0.02, ..Settings::default() };
    let refined = refine(&placed.tree, &settings, &Glow::of(&placed.emitters), &mut |points| sample(points))?;
    let ours = ours(&placed, &refined)?;
    let places = rivals::places(&placed.positions, refined.samples.len());
    let even: Vec<_> = places.iter().copied().zip(sample(&places)?).collect();
    let even = coloured(&placed, |point| rivals::interpolate(point, &even, 2.0));

    let error = |colours: &[DVec3]| -> f64 {
        let difference: f64 = colours.iter().zip(&truth).map(|(a, b)| a.distance_squared(*b)).sum();
        (difference / truth.iter().map(|c| c.length_squared()).sum::<f64>()).sqrt()
    };
    println!("{} samples: error {:.4}, even {:.4}", refined.samples.len(), error(&ours), error(&even));

    let view = View::of(&placed);
    let dark: Vec<DVec3> = ours.iter().map(|colour| 0.2 * *colour).collect();
    let [truth, ours, even, mut dots] =
        [truth, ours, even, dark].map(|colours| Picture::drawn(view, &placed, &colours));
    for sample in refined.samples.iter().filter(|sample| !sample.split) {
        dots.ring(sample.point, OVERLAP * sample.reach, DVec3::new(0.5, 0.45, 0.1));
    }
    let pictures = [truth, ours, even, dots];
    let row = |y: usize| pictures.iter().flat_map(move |picture| &picture.pixels[y * SIDE..(y + 1) * SIDE]);
    let pixels = (0..SIDE).flat_map(row).copied().collect();
    write_png(file.as_ref(), &FloatImage { width: 4 * SIDE, height: SIDE, pixels }, 1.5)?;
    Ok(())
}
