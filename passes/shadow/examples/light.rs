//! `cargo run --release -p airglow-shadow --example light`: a sky with a sun over the shadow of sixty spheres, in f64: the
//! error of all light by spherical harmonics at several windows, and with the sun set apart as a disc; how many receivers
//! come out darker than black.

use std::error::Error;

use airglow_math::sequence::{cosine_hemisphere, hammersley};
use airglow_math::sh::project;
use airglow_math::sphere::equirect::{direction, uv};
use airglow_shadow::families::figure;
use airglow_shadow::light::split;
use airglow_shadow::reference::{Reference, caps};
use airglow_shadow::spheres::Hierarchy;
use airglow_shadow::{Disc, Exponential, Products, Sphere, SplitSettings};
use glam::DVec3;

const SIZE: [usize; 2] = [256, 128];
const WINDOWS: [f64; 4] = [0.0, 0.002, 0.01, 0.05];
/// Receivers along a side of the ground.
const SIDE: usize = 16;
/// Rays of a receiver.
const RAYS: u32 = 2048;

fn sun() -> DVec3 {
    DVec3::new(0.5, 0.7, 0.4).normalize()
}

/// A dome, and a sun of 4 degrees that gives a little more light than it.
fn sky() -> Vec<[f32; 3]> {
    let texel = |at: usize| {
        let place = |k: usize, side: usize| (k as f64 + 0.5) / side as f64;
        let d = direction(place(at % SIZE[0], SIZE[0]), place(at / SIZE[0], SIZE[1]));
        let dome = [0.3, 0.4, 0.6].map(|value: f32| value * (1.0 + 0.5 * d.y as f32));
        if d.dot(sun()).acos() < 4.0_f64.to_radians() { [180.0, 150.0, 110.0] } else { dome }
    };
    (0..SIZE[0] * SIZE[1]).map(texel).collect()
}

fn radiance(texels: &[[f32; 3]], d: DVec3) -> [f64; 3] {
    let [u, v] = uv(d);
    let place = |t: f64, side: usize| ((t * side as f64) as usize).min(side - 1);
    texels[place(v, SIZE[1]) * SIZE[0] + place(u, SIZE[0])].map(f64::from)
}

/// What rays find: those of the rest, and those of the disc, which are few and bright, by themselves.
fn truth(rest: &[[f32; 3]], disc: &Disc, spheres: &[Sphere], place: DVec3) -> [f64; 3] {
    let caps = caps(spheres, place);
    let open = |d: DVec3| !caps.iter().any(|cap| cap.hides(d));
    let mut sum = [0.0; 3];
    for ray in 0..RAYS {
        let d = cosine_hemisphere(hammersley(ray, RAYS));
        let d = DVec3::new(d.x, d.z, -d.y);
        if open(d) {
            sum.iter_mut().zip(radiance(rest, d)).for_each(|(sum, value)| *sum += value / f64::from(RAYS));
        }
    }
    let (u, v) = disc.direction.any_orthonormal_pair();
    let seen = (0..RAYS).filter(|ray| {
        let [a, b] = hammersley(*ray, RAYS);
        let (radius, turn) = (disc.angular_radius * a.sqrt(), std::f64::consts::TAU * b);
        open((disc.direction + radius * (turn.cos() * u + turn.sin() * v)).normalize())
    });
    let share = seen.count() as f64 / f64::from(RAYS);
    let lit = disc.lit(DVec3::Y, share);
    std::array::from_fn(|c| sum[c] + lit[c])
}

fn main() -> Result<(), Box<dyn Error>> {
    let (texels, spheres) = (sky(), figure(60));
    let (rest, disc) = split(SIZE, &texels, &SplitSettings::default())?;
    let disc = disc.ok_or("no sun was found")?;
    let off = disc.direction.dot(sun()).clamp(-1.0, 1.0).acos().to_degrees();
    println!("disc: {:.2} degrees off, radius {:.2} degrees of 4", off, disc.angular_radius.to_degrees());
    let places: Vec<DVec3> = (0..SIDE * SIDE)
        .map(|at| 0.25 * DVec3::new((at % SIDE) as f64 - 7.9, 0.0, (at / SIDE) as f64 - 7.9))
        .collect();
    let truths: Vec<[f64; 3]> = places.iter().map(|place| truth(&rest, &disc, &spheres, *place)).collect();
    for order in [3, 4, 6] {
        let reference = Reference::new(order)?;
        let nodes = Hierarchy::new(&spheres, order)?.posed(&spheres)?;
        let visibility = |place: &DVec3| -> Result<Vec<f64>, Box<dyn Error>> {
            let mut sum = vec![0.0; order * order];
            for node in nodes.iter().filter(|node| node.subtree == 1) {
                let of_node = reference.log_visibility(&[node.sphere.cap(*place)])?;
                sum.iter_mut().zip(of_node).for_each(|(sum, value)| *sum += node.ratio * value);
            }
            Ok(reference.evaluator().exponential(Exponential::Adaptive, &sum)?)
        };
        let seen = places.iter().map(visibility).collect::<Result<Vec<_>, _>>()?;
        for (name, texels, disc) in
            [("all by harmonics", &texels, None), ("disc set apart", &rest, Some(disc))]
        {
            let channel = |c: usize| project(order, 400, |d| radiance(texels, d)[c]);
            let light = [channel(0)?, channel(1)?, channel(2)?];
            let rgb: Vec<[f64; 3]> = (0..order * order).map(|i| [0, 1, 2].map(|c| light[c][i])).collect();
            let products = Products::new(order, &rgb)?;
            for window in WINDOWS {
                let (mut square, mut size, mut black) = (0.0, 0.0, 0);
                for ((place, seen), truth) in places.iter().zip(&seen).zip(&truths) {
                    let band = |i: usize| (i.isqrt() * (i.isqrt() + 1)) as f64;
                    let windowed: Vec<f64> = seen
                        .iter()
                        .enumerate()
                        .map(|(i, g)| g / (1.0 + window * band(i) * band(i)))
                        .collect();
                    let mut lit = products.lit(DVec3::Y, &windowed)?;
                    black += usize::from(lit.iter().any(|value| *value < 0.0));
                    let direct =
                        disc.map_or([0.0; 3], |disc| disc.lit(DVec3::Y, disc.seen(&caps(&spheres, *place))));
                    lit.iter_mut().zip(direct).for_each(|(lit, value)| *lit = lit.max(0.0) + value);
                    square += (0..3).map(|c| (lit[c] - truth[c]).powi(2)).sum::<f64>();
                    size += truth.iter().map(|value| value * value).sum::<f64>();
                }
                let error = 100.0 * (square / size).sqrt();
                println!(
                    "order {order}, {name:16} window {window:5}: {error:5.1} % RMS, {black} below black"
                );
            }
        }
    }
    Ok(())
}
