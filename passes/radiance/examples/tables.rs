//! Errors of sampled light on three receivers: `cargo run --release -p airglow-radiance --example tables`.
//!
//! Re-makes the rows of error of Sun 2005, tables 4.1, 4.2 and 4.4, with meshes like those of the thesis and emitters as
//! its text describes them. Error: root mean square of the linear colour's difference from that of a sample at each
//! vertex, over the root mean square of the latter.

use std::ops::ControlFlow;
use std::thread;

use airglow_bake::{Mesh, unshadowed};
use airglow_radiance::reference::Cube;
use airglow_radiance::{
    Hierarchy, Incident, Oracle, RadianceError, Reconstruction, Settings, Triangle, Weights, refine, rivals,
};
use glam::DVec3;

/// Bands of all vectors.
const ORDER: usize = 4;
/// Texels along a face of a cube map.
const FACE: usize = 64;

type Failure = Box<dyn std::error::Error>;

/// A receiver with its emitters and its true colours.
struct Case {
    positions: Vec<[f32; 3]>,
    transfer: Vec<f32>,
    emitters: Vec<Triangle>,
    truth: Vec<DVec3>,
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
    fn new(name: &str, emitters: impl Fn(DVec3, DVec3) -> Vec<Triangle>) -> Result<Option<Self>, Failure> {
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
        let corner = |pick: fn(DVec3, DVec3) -> DVec3, start: DVec3| {
            positions.iter().map(|p| DVec3::from(p.map(f64::from))).fold(start, pick)
        };
        let (low, high) = (corner(DVec3::min, DVec3::INFINITY), corner(DVec3::max, DVec3::NEG_INFINITY));
        let emitters = emitters(low, high);
        let mut case = Self { positions, transfer, emitters, truth: Vec::new() };
        let points: Vec<DVec3> = (0..case.positions.len()).map(|v| case.point(v)).collect();
        let lights = case.sample(&points)?;
        case.truth =
            lights.iter().enumerate().map(|(v, light)| case.colour(v, &light.coefficients)).collect();
        println!(
            "{name}: {} vertices, box {low:.2} to {high:.2}, {} emitter triangles",
            points.len(),
            case.emitters.len()
        );
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
        let cube = Cube::new(ORDER, FACE)?;
        let run = |points: &[DVec3]| points.iter().map(|point| cube.sample(*point, &self.emitters)).collect();
        let (one, other) = points.split_at(points.len() / 2);
        let halves: [Result<Vec<_>, _>; 2] = thread::scope(|scope| {
            let first = scope.spawn(|| run(one));
            let second = run(other);
            [first.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)), second]
        });
        let [mut all, rest] = [halves[0].clone()?, halves[1].clone()?];
        all.extend(rest);
        Ok(all)
    }

    /// Relative error of what `light` says of each vertex.
    fn error(
        &self,
        mut light: impl FnMut(DVec3) -> Result<Vec<DVec3>, RadianceError>,
    ) -> Result<f64, RadianceError> {
        let (mut difference, mut whole) = (0.0, 0.0);
        for (vertex, truth) in self.truth.iter().enumerate() {
            let colour = self.colour(vertex, &light(self.point(vertex))?);
            difference += colour.distance_squared(*truth);
            whole += truth.length_squared();
        }
        Ok((difference / whole).sqrt())
    }

    /// Number of samples and error at one bound.
    fn ours(
        &self,
        tree: &Hierarchy,
        settings: &Settings,
        weights: Weights,
    ) -> Result<(usize, f64), RadianceError> {
        let refined = refine(tree, settings, &mut |points| self.sample(points))?;
        let reconstruction = Reconstruction::new(&refined, weights);
        let error = self.error(|point| {
            let mut light = vec![DVec3::ZERO; ORDER * ORDER];
            reconstruction.light(point, &mut light)?;
            Ok(light)
        })?;
        Ok((refined.samples.len(), error))
    }

    /// The bound that takes as near to `count` samples as there is, by bisection of its logarithm.
    fn ours_at(
        &self,
        tree: &Hierarchy,
        count: usize,
        settings: Settings,
        weights: Weights,
    ) -> Result<(f64, usize, f64), RadianceError> {
        let taken = |bound: f64| {
            let settings = Settings { bound, ..settings };
            refine(tree, &settings, &mut |points| self.sample(points)).map(|refined| refined.samples.len())
        };
        let (mut low, mut high) = (1e-7_f64, 1e4_f64);
        for _ in 0..24 {
            let middle = (low * high).sqrt();
            if taken(middle)? > count { low = middle } else { high = middle }
        }
        let (samples, error) = self.ours(tree, &Settings { bound: high, ..settings }, weights)?;
        Ok((high, samples, error))
    }

    fn table(&self, counts: &[usize]) -> Result<(), Failure> {
        let tree = Hierarchy::build(&self.positions, &self.transfer, &mut |_, _| ControlFlow::Continue(()))?;
        for &count in counts {
            let places = rivals::places(&self.positions, count);
            let lights: Vec<_> = places.iter().copied().zip(self.sample(&places)?).collect();
            for power in [1.0, 2.0, 4.0, 8.0] {
                let error = self.error(|point| Ok(rivals::interpolate(point, &lights, power)))?;
                println!("  even, 1/d^{power}: {} samples, error {error:.4}", places.len());
            }
            for oracle in [Oracle::Printed, Oracle::Argued, Oracle::Transfer] {
                for stride in [1, 3] {
                    let settings = Settings { oracle, stride, limit: 2 * count, ..Settings::default() };
                    for weights in [Weights::Inverse, Weights::Compact] {
                        let (bound, samples, error) = self.ours_at(&tree, count, settings, weights)?;
                        println!(
                            "  {oracle:?}, stride {stride}, {weights:?}: bound {bound:.3e}, {samples} samples, error {error:.4}"
                        );
                    }
                }
            }
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

fn main() -> Result<(), Failure> {
    if let Some(case) = Case::new("mesh/armadillo_10k.glb", block_matrix)? {
        case.table(&[130, 250])?;
    }
    Ok(())
}
