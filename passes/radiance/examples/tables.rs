//! Errors of sampled light on three receivers: `cargo run --release -p airglow-radiance --example tables`.
//!
//! Re-makes the rows of error of Sun 2005, tables 4.1, 4.2 and 4.4, with meshes like those of the thesis and emitters as
//! its text describes them. Error: root mean square of the linear colour's difference from that of a sample at each
//! vertex, over the root mean square of the latter.

use std::ops::ControlFlow;
use std::thread;
use std::time::Instant;

use airglow_bake::{Mesh, unshadowed};
use airglow_radiance::reference::Cube;
use airglow_radiance::{
    Glow, Hierarchy, Incident, Oracle, RadianceError, Reconstruction, Refined, Settings, Triangle, Weights,
    refine, rivals,
};
use glam::DVec3;

/// Bands of all vectors.
const ORDER: usize = 4;

type Failure = Box<dyn std::error::Error>;

/// A receiver with its emitters and its true colours.
struct Case {
    positions: Vec<[f32; 3]>,
    transfer: Vec<f32>,
    emitters: Vec<Triangle>,
    truth: Vec<DVec3>,
    cube: Cube,
    tree: Hierarchy,
}

fn block(centre: DVec3, half: DVec3, radiance: DVec3) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let unit = |i: usize| DVec3::AXES[i % 3] * half[i % 3];
            let (n, x, y) = (side * unit(axis), unit(axis + 1), unit(axis + 2));
            let c = [n - x - y, n + x - y, n + x + y, n - x + y].map(|corner| centre + corner);
            triangles.push(Triangle { corners: [c[0], c[1], c[2]], radiance });
            triangles.push(Triangle { corners: [c[0], c[2], c[3]], radiance });
        }
    }
    triangles
}

impl Case {
    /// `face` texels a side of a cube map, for the truth and for the samples of all methods.
    fn new(
        name: &str,
        face: usize,
        emitters: impl Fn(DVec3, DVec3) -> Vec<Triangle>,
    ) -> Result<Option<Self>, Failure> {
        let Some(path) = airglow_tests::data::find(name) else { return Ok(None) };
        let scene = airglow_scene::load(&path)?;
        let (mut positions, mut transfer) = (Vec::new(), Vec::new());
        for instance in &scene.instances {
            let mesh = &scene.meshes[instance.mesh];
            let view =
                Mesh { name, positions: &mesh.positions, normals: &mesh.normals, indices: &mesh.indices };
            transfer.extend(unshadowed(&view, instance.transform, ORDER)?.transfer.coefficients);
            let place = |p: &[f32; 3]| instance.transform.transform_point3((*p).into()).to_array();
            positions.extend(mesh.positions.iter().map(place));
        }
        let points: Vec<DVec3> = positions.iter().map(|p| DVec3::from(p.map(f64::from))).collect();
        let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let emitters = emitters(low, high);
        println!(
            "{name}: {} vertices, box {low:.2} to {high:.2}, {} emitter triangles",
            points.len(),
            emitters.len()
        );
        let tree = Hierarchy::build(&positions, &transfer, &mut |_, _| ControlFlow::Continue(()))?;
        let cube = Cube::new(ORDER, face)?;
        let mut case = Self { positions, transfer, emitters, truth: Vec::new(), cube, tree };
        let start = Instant::now();
        let lights = case.sample(&points)?;
        println!("  truth: {:.1} s", start.elapsed().as_secs_f64());
        case.truth =
            lights.iter().enumerate().map(|(v, light)| case.colour(v, &light.coefficients)).collect();
        case.cube = case.cube.with_gradients();
        Ok(Some(case))
    }

    fn point(&self, vertex: usize) -> DVec3 {
        DVec3::from(self.positions[vertex].map(f64::from))
    }

    fn colour(&self, vertex: usize, light: &[DVec3]) -> DVec3 {
        let transfer = &self.transfer[vertex * light.len()..][..light.len()];
        transfer.iter().zip(light).map(|(t, l)| f64::from(*t) * *l).sum()
    }

    /// Cube maps at the points, on two threads.
    fn sample(&self, points: &[DVec3]) -> Result<Vec<Incident>, RadianceError> {
        let run = |points: &[DVec3]| -> Result<Vec<_>, _> {
            points.iter().map(|point| self.cube.sample(*point, &self.emitters)).collect()
        };
        let (one, other) = points.split_at(points.len() / 2);
        thread::scope(|scope| {
            let first = scope.spawn(|| run(one));
            let second = run(other)?;
            let mut all = first.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
            all.extend(second);
            Ok(all)
        })
    }

    /// As the thesis has it, whose oracle believes what a sample sees.
    fn refine(&self, settings: &Settings) -> Result<Refined, RadianceError> {
        let settings = &Settings { hidden: 0.0, ..*settings };
        refine(&self.tree, settings, &Glow::of(&self.emitters), &mut |points| self.sample(points))
    }

    /// Relative error of what `light` says of each vertex, and the seconds that this took.
    fn error(
        &self,
        mut light: impl FnMut(DVec3) -> Result<Vec<DVec3>, RadianceError>,
    ) -> Result<(f64, f64), RadianceError> {
        let start = Instant::now();
        let (mut difference, mut whole) = (0.0, 0.0);
        for (vertex, truth) in self.truth.iter().enumerate() {
            let colour = self.colour(vertex, &light(self.point(vertex))?);
            difference += colour.distance_squared(*truth);
            whole += truth.length_squared();
        }
        Ok(((difference / whole).sqrt(), start.elapsed().as_secs_f64()))
    }

    fn ours(
        &self,
        refined: &Refined,
        weights: Weights,
        extrapolate: bool,
    ) -> Result<(f64, f64), RadianceError> {
        let reconstruction = Reconstruction::new(refined, weights, extrapolate);
        self.error(|point| {
            let mut light = vec![DVec3::ZERO; ORDER * ORDER];
            reconstruction.light(point, &mut light)?;
            Ok(light)
        })
    }

    /// The settings whose bound takes as near to `count` samples as there is and no more, by bisection.
    fn settings_for(&self, count: usize, oracle: Oracle, stride: usize) -> Result<Settings, RadianceError> {
        let (mut low, mut high) = (1e-6_f64, 1e3_f64);
        let settings = |bound| Settings { oracle, stride, bound, limit: 2 * count, ..Settings::default() };
        for _ in 0..14 {
            let middle = (low * high).sqrt();
            if self.refine(&settings(middle))?.samples.len() > count { low = middle } else { high = middle }
        }
        Ok(settings(high))
    }

    /// Even samples and ours, at about as many.
    fn table(&self, counts: &[usize]) -> Result<(), Failure> {
        for &count in counts {
            let places = rivals::places(&self.positions, count);
            let lights: Vec<_> = places.iter().copied().zip(self.sample(&places)?).collect();
            for power in [1.0, 2.0, 4.0] {
                let (error, seconds) = self.error(|point| Ok(rivals::interpolate(point, &lights, power)))?;
                println!("  even, 1/d^{power}: {} samples, error {error:.4}, {seconds:.3} s", places.len());
            }
            let methods = [
                ("thesis, eq. 3.3 as printed", Oracle::Printed, 1, Weights::Inverse),
                ("thesis, eq. 3.3 as argued", Oracle::Argued, 1, Weights::Inverse),
                ("ours", Oracle::Transfer, Settings::default().stride, Weights::Compact),
            ];
            for (name, oracle, stride, weights) in methods {
                let settings = self.settings_for(count, oracle, stride)?;
                let refined = self.refine(&settings)?;
                for gradients in [false, true] {
                    let (error, seconds) = self.ours(&refined, weights, gradients)?;
                    let with = if gradients { ", gradients" } else { "" };
                    let samples = refined.samples.len();
                    println!(
                        "  {name}{with}: bound {:.2e}, {samples} samples, error {error:.4}, {seconds:.3} s",
                        settings.bound
                    );
                }
            }
        }
        Ok(())
    }

    /// Error against bound, over two decades and more.
    fn sweep(&self, bounds: &[f64]) -> Result<(), Failure> {
        for bound in bounds {
            let refined = self.refine(&Settings { bound: *bound, limit: 1 << 14, ..Settings::default() })?;
            let errors = [false, true].map(|gradients| self.ours(&refined, Weights::default(), gradients));
            let [plain, gradients] = errors;
            let (samples, rounds) = (refined.samples.len(), refined.rounds);
            println!(
                "  bound {bound:.1e}: {samples} samples in {rounds} rounds, error {:.4}, with gradients {:.4}",
                plain?.0, gradients?.0
            );
        }
        Ok(())
    }
}

/// A square matrix of coloured blocks before the figure, near its hands and face (figure 4.1).
fn block_matrix(low: DVec3, high: DVec3) -> Vec<Triangle> {
    let (size, middle) = (high - low, 0.5 * (low + high));
    let colours = [
        DVec3::new(1.0, 0.1, 0.1),
        DVec3::new(0.1, 1.0, 0.1),
        DVec3::new(0.1, 0.2, 1.0),
        DVec3::new(1.0, 0.9, 0.2),
    ];
    let at = |i: usize| i as f64 / 2.0 - 0.5;
    let place = |i: usize| {
        DVec3::new(middle.x + at(i % 3) * size.x, middle.y + at(i / 3) * size.y, high.z + 0.12 * size.y)
    };
    let half = DVec3::splat(0.06 * size.y);
    (0..9).flat_map(|i| block(place(i), half, 10.0 * colours[(i + i / 3) % 4])).collect()
}

/// Two large planes and three blocks in red, white and green near walls and floor (figure 4.4, "near").
fn near(low: DVec3, high: DVec3) -> Vec<Triangle> {
    let at = |x: f64, y: f64, z: f64| low + DVec3::new(x, y, z) * (high - low);
    let unit = 0.02 * (high - low).max_element();
    let planes = [at(0.5, 1.2, 0.3), at(0.5, 1.2, 0.7)];
    let planes = planes.map(|place| block(place, unit * DVec3::new(5.0, 0.01, 5.0), DVec3::splat(1.0)));
    let lamps =
        [(at(0.2, 0.25, 0.3), DVec3::X), (at(0.5, 0.3, 0.6), DVec3::ONE), (at(0.8, 0.25, 0.8), DVec3::Y)];
    let lamps = lamps.map(|(place, colour)| block(place, DVec3::splat(unit), 8.0 * colour));
    planes.into_iter().chain(lamps).flatten().collect()
}

/// Three large planes, a hundred sizes away (figure 4.4, "far").
fn far(low: DVec3, high: DVec3) -> Vec<Triangle> {
    let size = (high - low).length();
    let place = |axis: usize| 0.5 * (low + high) + 100.0 * size * DVec3::AXES[axis];
    (0..3)
        .flat_map(|axis| {
            block(place(axis), 30.0 * size * (DVec3::ONE - 0.99 * DVec3::AXES[axis]), DVec3::ONE)
        })
        .collect()
}

fn main() -> Result<(), Failure> {
    let chosen: Vec<String> = std::env::args().skip(1).collect();
    let wanted = |name: &str| chosen.is_empty() || chosen.iter().any(|word| word == name);
    if wanted("armadillo")
        && let Some(case) = Case::new("mesh/armadillo_10k.glb", 128, block_matrix)?
    {
        case.table(&[130, 250])?;
        case.sweep(&[0.1, 0.03, 0.01, 0.003, 0.001])?;
    }
    if wanted("nave")
        && let Some(mut case) = Case::new("mesh/nave.glb", 64, near)?
    {
        case.table(&[160, 500])?;
        let bound = 2e-3;
        let settings = Settings { bound, ..Settings::default() };
        let near = case.refine(&settings)?.samples.len();
        let box_of = case.tree.nodes().first().copied().unwrap_or_default();
        let corner = |corner: [f32; 3]| DVec3::from(corner.map(f64::from));
        case.emitters = far(corner(box_of.low), corner(box_of.high));
        let far = case.refine(&settings)?.samples.len();
        println!("  bound {bound:.1e}: near {near} samples, far {far}");
    }
    if wanted("buddha")
        && let Some(case) = Case::new("mesh/buddha_50k.glb", 64, block_matrix)?
    {
        case.sweep(&[0.1, 0.03, 0.01, 0.003, 0.001])?;
    }
    Ok(())
}
