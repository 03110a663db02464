//! Samples of extreme emitters with the GPU's result and the truth, and sweeps of each limit through its singularity.

mod receivers;

pub use receivers::{FrameOutcome, frames};

use glam::DVec3;

use crate::eval::{CubeRow, Evaluated, Method, cubes, default_rays};
use crate::gpu::bench::Bench;
use crate::{Incident, RadianceError, Triangle};

/// The bound on [`error`].
pub const BOUND: f64 = 1e-4;

/// One extreme input.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What is tried.
    pub name: String,
    /// The GPU's result, or a refusal.
    pub result: String,
    /// The truth of the same.
    pub truth: String,
    /// The error as [`error`] measures it; 0 for a refusal that is due, infinite for one that is not.
    pub error: f64,
    /// The row of `radiance-cube`.
    pub row: CubeRow,
}

/// A limit approached in logarithmic steps.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// What is approached.
    pub name: String,
    /// The parameter and its unit.
    pub parameter: &'static str,
    /// Parameter, norms of the GPU's light vector and of the truth, the error.
    pub points: Vec<[f64; 4]>,
    /// The rows of the points.
    pub rows: Vec<CubeRow>,
}

impl Outcome {
    /// Whether the error is within [`BOUND`]; NaN is not.
    #[must_use]
    pub fn pass(&self) -> bool {
        self.error <= BOUND
    }
}

impl Sweep {
    /// Whether every point is within [`BOUND`].
    #[must_use]
    pub fn pass(&self) -> bool {
        self.points.iter().all(|[.., error]| *error <= BOUND)
    }
}

/// Relative error of the light vector, or a hundredth of that of the distance where this is larger: distance only steers where
/// samples are taken. Where there is no light, the norm. Infinite for what is not finite.
#[must_use]
pub fn error(value: &Incident, truth: &Incident) -> f64 {
    let numbers = value.coefficients.iter().map(|l| l.x).chain([value.solid_angle, value.nearness]);
    if !numbers.clone().all(f64::is_finite) {
        return f64::INFINITY;
    }
    let pairs = value.coefficients.iter().zip(&truth.coefficients);
    let difference = (pairs.map(|(a, b)| a.distance_squared(*b)).sum::<f64>() / 3.0).sqrt();
    if truth.norm() == 0.0 {
        return difference;
    }
    let near = (value.distance() / truth.distance() - 1.0).abs();
    (difference / truth.norm()).max(0.01 * near)
}

/// Runs the extreme inputs, or the one called `only`; none, if none has the name.
///
/// # Errors
/// [`RadianceError::Gpu`] when the device fails; a wrong result is an [`Outcome`] that does not pass.
pub fn cases(bench: &Bench<'_>, only: Option<&str>) -> Result<Vec<Outcome>, RadianceError> {
    let chosen = |(name, _, _): &(String, CubeRow, bool)| only.is_none_or(|only| only == *name);
    let cases: Vec<_> = all_cases().into_iter().filter(chosen).collect();
    let rows: Vec<CubeRow> = cases.iter().map(|(_, row, _)| row.clone()).collect();
    let outcome = |((name, row, refused), found): ((String, CubeRow, bool), _)| match found {
        Ok(Evaluated { value, reference }) => Outcome {
            name,
            result: words(&value),
            truth: words(&reference),
            error: if refused { f64::INFINITY } else { error(&value, &reference) },
            row,
        },
        Err(reason) => {
            let (truth, error) = if refused { ("refused", 0.0) } else { ("accepted", f64::INFINITY) };
            Outcome { name, result: format!("refused: {reason}"), truth: truth.to_owned(), error, row }
        }
    };
    Ok(cases.into_iter().zip(sampled(bench, &rows)?).map(outcome).collect())
}

/// The rows as the pass samples them: what is too close for a closed form goes to a cube map.
fn sampled(
    bench: &Bench<'_>,
    rows: &[CubeRow],
) -> Result<Vec<Result<Evaluated, RadianceError>>, RadianceError> {
    let mut found = cubes(bench, rows)?;
    for (row, found) in rows.iter().zip(&mut found) {
        if let Err(RadianceError::Touching) = found {
            let row = CubeRow { method: Method::Cube, ..row.clone() };
            if let Some(cube) = cubes(bench, &[row])?.pop() {
                *found = cube;
            }
        }
    }
    Ok(found)
}

fn words(light: &Incident) -> String {
    format!("|l| {:.8e}, distance {:.8e}", light.norm(), light.distance())
}

/// Names, rows, and whether each is refused.
fn all_cases() -> Vec<(String, CubeRow, bool)> {
    let lamp = || square(DVec3::new(0.3, 0.2, -1.0), 0.4 * DVec3::X, 0.4 * DVec3::Y);
    let wall = |z: f64| square(DVec3::new(0.0, 0.0, z), 50.0 * DVec3::X, 50.0 * DVec3::Y);
    let flat = |corners: [DVec3; 3]| vec![Triangle { corners, radiance: DVec3::ONE }];
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let mut cases = Vec::new();
    for (method, word) in [(Method::Cube, "cube map"), (Method::Analytic, "closed form")] {
        let mut add = |name: &str, triangles: Vec<Triangle>| {
            cases.push((format!("{word}: {name}"), row(method, triangles), false));
        };
        add("no emitter", Vec::new());
        add("all emitters black", lit(lamp(), 0.0));
        add("zero area: one point", flat([DVec3::NEG_Z; 3]));
        add("zero area: a line", flat([at(0.0, 0.0, -1.0), at(1.0, 0.0, -1.0), at(2.0, 0.0, -1.0)]));
        add("radiance 1e6", lit(lamp(), 1e6));
        add("radiance 1e-6", lit(lamp(), 1e-6));
        add("larger than the scene", square(at(3.0, 5.0, -1.0), 1e6 * DVec3::X, 1e6 * DVec3::Y));
        add("plane through the point, beside it", square(at(2.0, 0.0, 0.0), DVec3::X, DVec3::Y));
        add("across an edge of a face", square(at(1.017, 0.113, -1.0), 0.503 * DVec3::X, 0.497 * DVec3::Y));
        add("across a corner of a face", square(at(1.0, 1.0, -1.0), 0.3 * DVec3::X, 0.3 * DVec3::Y));
        add("a hundred at once", (0..10).flat_map(|i| grid(i, 5)).collect());
    }
    let mut add = |name: &str, triangles: Vec<Triangle>| {
        cases.push((format!("cube map: {name}"), row(Method::Cube, triangles), false));
    };
    add("all emitters hidden", [lamp(), lit(wall(-0.5), 0.0)].concat());
    add(
        "half of an emitter hidden",
        [lamp(), lit(square(at(0.0, 0.0, -0.5), 0.15 * DVec3::X, DVec3::Y), 0.0)].concat(),
    );
    add("inside a black box before emitters", [lamp(), lit(room(0.5), 0.0)].concat());
    add("inside a shining box", room(0.5));
    add("emitters that cross", [lamp(), square(at(0.3, 0.2, -1.0), 0.4 * DVec3::X, 0.4 * DVec3::Z)].concat());
    add("a thousand at once", (0..100).flat_map(|i| grid(i, 5)).collect());
    let mut refuse = |name: &str, method: Method, triangles: Vec<Triangle>| {
        cases.push((name.to_owned(), row(method, triangles), true));
    };
    refuse("closed form: emitters that overlap", Method::Analytic, [lamp(), wall(-2.0)].concat());
    refuse("radiance below zero", Method::Cube, lit(lamp(), -1.0));
    refuse("radiance NaN", Method::Cube, lit(lamp(), f64::NAN));
    refuse("corner at infinity", Method::Cube, flat([DVec3::INFINITY, DVec3::X, DVec3::Y]));
    cases
}

/// A row for each value of a parameter.
type Approach = (&'static str, &'static str, [f64; 2], fn(f64) -> Vec<Triangle>);

const APPROACHES: [Approach; 8] = [
    ("an emitter comes to touch the point", "height, m", [1e-7, 1.0], |height| {
        square(DVec3::new(0.1, 0.07, -height), 0.5 * DVec3::X, 0.5 * DVec3::Y)
    }),
    ("a corner comes to touch the point", "distance, m", [1e-6, 1.0], |distance| {
        let tip = distance * DVec3::new(0.3, 0.2, -0.9);
        let corners = [tip, tip + DVec3::new(1.0, 0.2, -1.0), tip + DVec3::new(-0.1, 0.9, -1.1)];
        vec![Triangle { corners, radiance: DVec3::ONE }]
    }),
    ("seen edge-on", "sine of the tilt", [1e-7, 1.0], |tilt| {
        let turned = DVec3::new(0.0, tilt, -(1.0 - tilt * tilt).sqrt());
        square(DVec3::new(0.05, 0.03, -1.0), 0.5 * DVec3::X, 0.5 * turned)
    }),
    ("small to larger than the scene", "half side, m", [1e-6, 1e7], |half| {
        square(DVec3::new(0.013, 0.009, -1.0), half * DVec3::X, half * DVec3::Y)
    }),
    ("near to far", "distance, m", [1e-2, 1e6], |distance| {
        square(distance * DVec3::new(0.2, 0.3, -1.0), 0.5 * DVec3::X, 0.5 * DVec3::Y)
    }),
    ("radiance", "W/sr/m2", [1e-12, 1e12], |radiance| {
        lit(square(DVec3::new(0.3, 0.2, -1.0), 0.4 * DVec3::X, 0.4 * DVec3::Y), radiance)
    }),
    ("across an edge of a face", "part beyond it", [1e-6, 1.0], |part| {
        square(DVec3::new(0.6 + 0.8 * part, 0.11, -1.0), 0.4 * DVec3::X, 0.4 * DVec3::Y)
    }),
    ("across a corner of a face", "part beyond it", [1e-6, 1.0], |part| {
        let at = 0.6 + 0.8 * part;
        square(DVec3::new(at, at, -1.0), 0.4 * DVec3::X, 0.4 * DVec3::Y)
    }),
];

/// Steps of a sweep.
const STEPS: usize = 40;

/// Runs the sweeps, or the one called `only`; none, if none has the name.
///
/// # Errors
/// [`RadianceError::Gpu`] when the device fails.
pub fn sweeps(bench: &Bench<'_>, only: Option<&str>) -> Result<Vec<Sweep>, RadianceError> {
    let mut sweeps = Vec::new();
    for (method, word) in [(Method::Cube, "cube map"), (Method::Analytic, "closed form")] {
        for (name, parameter, [low, high], emitters) in APPROACHES {
            let name = format!("{word}: {name}");
            if only.is_some_and(|only| only != name) {
                continue;
            }
            let place = |step: usize| low * (high / low).powf(step as f64 / (STEPS - 1) as f64);
            let rows: Vec<CubeRow> = (0..STEPS).map(|step| row(method, emitters(place(step)))).collect();
            let found = sampled(bench, &rows)?.into_iter().enumerate();
            let points = found.map(|(step, found)| match found {
                Ok(Evaluated { value, reference }) => {
                    [place(step), value.norm(), reference.norm(), error(&value, &reference)]
                }
                Err(_) => [place(step), f64::NAN, f64::NAN, f64::INFINITY],
            });
            sweeps.push(Sweep { name, parameter, points: points.collect(), rows });
        }
    }
    Ok(sweeps)
}

/// A row of corners that single precision holds.
fn row(method: Method, mut triangles: Vec<Triangle>) -> CubeRow {
    for corner in triangles.iter_mut().flat_map(|triangle| &mut triangle.corners) {
        *corner = corner.as_vec3().as_dvec3();
    }
    CubeRow { order: 5, face: 16, rays: default_rays(), point: DVec3::ZERO, triangles, method }
}

/// A parallelogram of radiance 1 about its centre, from half its sides.
fn square(centre: DVec3, x: DVec3, y: DVec3) -> Vec<Triangle> {
    let corners = [centre - x - y, centre + x - y, centre + x + y, centre - x + y];
    let half = |places: [usize; 3]| Triangle { corners: places.map(|i| corners[i]), radiance: DVec3::ONE };
    vec![half([0, 1, 2]), half([0, 2, 3])]
}

fn lit(mut triangles: Vec<Triangle>, radiance: f64) -> Vec<Triangle> {
    triangles.iter_mut().for_each(|triangle| triangle.radiance = DVec3::splat(radiance));
    triangles
}

/// Five squares of row `row` of a wall of lamps.
fn grid(row: usize, columns: usize) -> Vec<Triangle> {
    let place =
        |column: usize| DVec3::new(0.3137 * column as f64 - 0.7083, 0.2963 * row as f64 - 1.3179, -1.1);
    (0..columns).flat_map(|column| square(place(column), 0.1213 * DVec3::X, 0.1197 * DVec3::Y)).collect()
}

/// A closed box about the point.
fn room(half: f64) -> Vec<Triangle> {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let sides = (0..3).flat_map(|i| [(i, half), (i, -half)]);
    sides
        .flat_map(|(i, at)| square(at * axes[i], half * axes[(i + 1) % 3], half * axes[(i + 2) % 3]))
        .collect()
}
