//! Figure 4.1 of Sun 2005 with another animal: `cargo run --release -p airglow-radiance --example figure -- figure.png`.
//!
//! A cow before a matrix of coloured blocks: light sampled at each vertex; by the oracle, with gradients; as many samples
//! spread evenly, weighed with 1/d^2; and where the oracle's lie, as dots of the size of their domains. The scene is
//! `assets/scenes/blocks.toml` without its sky.

use airglow_radiance::reference::Cube;
use airglow_radiance::{Glow, OVERLAP, RadianceError, Reconstruction, Settings, Weights, refine, rivals};
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

/// A picture with the depth of each pixel.
struct Picture {
    pixels: Vec<[f32; 3]>,
    depth: Vec<f64>,
}

impl Picture {
    fn new() -> Self {
        Self { pixels: vec![[0.02; 3]; SIDE * SIDE], depth: vec![f64::INFINITY; SIDE * SIDE] }
    }

    /// Place in the picture, pixels, and depth: a view without perspective.
    fn place(point: DVec3) -> DVec3 {
        let forward = DVec3::new(3.0, -0.9, 2.6).normalize();
        let right = forward.cross(DVec3::Y).normalize();
        let up = right.cross(forward);
        let from = point - DVec3::new(0.0, 0.95, -0.25);
        let scale = SIDE as f64 / 2.9;
        DVec3::new(from.dot(right) * scale, -from.dot(up) * scale, from.dot(forward))
            + 0.5 * SIDE as f64 * (DVec3::X + DVec3::Y)
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
        let [a, b, c] = corners.map(Self::place);
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

    /// A ring about a sample in front of everything.
    fn ring(&mut self, centre: DVec3, radius: f64, colour: DVec3) {
        let middle = Self::place(centre);
        let scale = radius * SIDE as f64 / 2.9;
        for step in 0..256 {
            let angle = std::f64::consts::TAU * f64::from(step) / 256.0;
            let at = |r: f64| (middle.x + r * angle.cos(), middle.y + r * angle.sin());
            for r in [scale, 0.0, 1.0, 1.5] {
                let (x, y) = at(r);
                self.put(x, y, f64::NEG_INFINITY, colour);
            }
        }
    }
}

fn main() -> Result<(), Failure> {
    let file = std::env::args().nth(1).unwrap_or_else(|| "figure.png".to_owned());
    let Some(placed) = Placed::load("blocks", None)? else { return Ok(()) };
    let (points, emitters) = (placed.points(), &placed.emitters);
    let colour = |vertex: usize, light: &[DVec3]| placed.colour(vertex, light);

    let cube = Cube::new(ORDER, 64)?.with_gradients();
    let sample = |points: &[DVec3]| -> Result<Vec<_>, RadianceError> {
        points.iter().map(|point| cube.sample(*point, emitters)).collect()
    };
    let lights = sample(&points)?;
    let truth: Vec<_> = lights.iter().enumerate().map(|(v, light)| colour(v, &light.coefficients)).collect();

    let settings = Settings { bound: 0.02, ..Settings::default() };
    let refined = refine(&placed.tree, &settings, &Glow::of(emitters), &mut |points| sample(points))?;
    let reconstruction = Reconstruction::new(&refined, Weights::Compact, true);
    let mut light = vec![DVec3::ZERO; ORDER * ORDER];
    let mut ours = Vec::new();
    for (vertex, point) in points.iter().enumerate() {
        reconstruction.light(*point, &mut light)?;
        ours.push(colour(vertex, &light));
    }
    let places = rivals::places(&placed.positions, refined.samples.len());
    let even: Vec<_> = places.iter().copied().zip(sample(&places)?).collect();
    let even: Vec<_> =
        (0..points.len()).map(|v| colour(v, &rivals::interpolate(points[v], &even, 2.0))).collect();

    let error = |colours: &[DVec3]| -> f64 {
        let difference: f64 = colours.iter().zip(&truth).map(|(a, b)| a.distance_squared(*b)).sum();
        (difference / truth.iter().map(|c| c.length_squared()).sum::<f64>()).sqrt()
    };
    println!("{} samples: error {:.4}, even {:.4}", refined.samples.len(), error(&ours), error(&even));

    let drawn = |colours: &[DVec3]| {
        let mut picture = Picture::new();
        for triangle in placed.indices.chunks_exact(3) {
            let corners = [triangle[0], triangle[1], triangle[2]].map(|i| i as usize);
            picture.triangle(corners.map(|i| points[i]), corners.map(|i| colours[i]));
        }
        emitters.iter().for_each(|emitter| picture.triangle(emitter.corners, [emitter.radiance; 3]));
        picture
    };
    let mut dots = drawn(&ours.iter().map(|colour| 0.2 * *colour).collect::<Vec<_>>());
    for sample in refined.samples.iter().filter(|sample| !sample.split) {
        dots.ring(sample.point, OVERLAP * sample.reach, DVec3::new(0.5, 0.45, 0.1));
    }
    let pictures = [drawn(&truth), drawn(&ours), drawn(&even), dots];
    let row = |y: usize| pictures.iter().flat_map(move |picture| &picture.pixels[y * SIDE..(y + 1) * SIDE]);
    let pixels = (0..SIDE).flat_map(row).copied().collect();
    write_png(file.as_ref(), &FloatImage { width: 4 * SIDE, height: SIDE, pixels }, 1.5)?;
    Ok(())
}
