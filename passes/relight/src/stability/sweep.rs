//! Sweeps in logarithmic steps through the limits: small and half turns, high peaks, texels at the pole.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};

use super::environments::project;
use super::{COEFFICIENT_BOUND, Map, Reproduce, Selection, coefficients, length, relative};
use crate::RelightError;
use crate::bench::Bench;
use crate::eval::{Evaluated, RotateRow, sh_rotate};

/// The order of all sweeps.
const ORDER: usize = 6;

/// One point of a sweep.
#[derive(Clone, Debug)]
pub struct SweepPoint {
    /// The parameter.
    pub at: f64,
    /// The GPU's value of the swept measure.
    pub value: f64,
    /// The truth of it.
    pub truth: f64,
    /// The relative L2 error of the whole vector; infinite where the input was refused.
    pub error: f64,
    /// How to run this point alone.
    pub reproduce: Reproduce,
}

impl SweepPoint {
    fn new(
        at: f64,
        found: Result<Evaluated, RelightError>,
        measure: impl Fn(&[f64]) -> f64,
        reproduce: Reproduce,
    ) -> Self {
        let (value, truth, error) = found.map_or((f64::NAN, f64::NAN, f64::INFINITY), |found| {
            let Evaluated { values, reference } = found;
            (measure(&values), measure(&reference), relative(&values, &reference))
        });
        Self { at, value, truth, error, reproduce }
    }
}

/// A limit approached in logarithmic steps.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// What is approached.
    pub name: &'static str,
    /// The parameter and its unit.
    pub parameter: &'static str,
    /// What `value` and `truth` measure.
    pub measure: &'static str,
    /// The points, in the order of the approach.
    pub points: Vec<SweepPoint>,
    /// The largest error allowed.
    pub bound: f64,
}

impl Sweep {
    /// Whether every point is within the bound.
    #[must_use]
    pub fn pass(&self) -> bool {
        self.points.iter().all(|point| point.error <= self.bound)
    }
}

/// Runs the sweeps that are selected; none, if none has the name.
///
/// # Errors
/// [`RelightError::Gpu`] when the device fails.
pub fn sweeps(bench: &Bench<'_>, selection: &Selection<'_>) -> Result<Vec<Sweep>, RelightError> {
    let turned = "distance from the unturned vector";
    let norm = "norm of the coefficients";
    let sweeps: [(_, _, _, fn(&Bench<'_>) -> _); 4] = [
        ("a turn becomes none", "angle, radians", turned, |bench| rotations(bench, |angle| angle)),
        ("a turn becomes a half turn", "pi - angle, radians", turned, |bench| {
            rotations(bench, |rest| PI - rest)
        }),
        ("a peak rises", "radiance of one texel, W/sr/m2", norm, peaks),
        ("a texel shrinks into the pole", "rows of the map", norm, poles),
    ];
    let selected = sweeps.into_iter().filter(|(name, ..)| selection.has(name));
    let run = |(name, parameter, measure, run): (_, _, _, fn(&Bench<'_>) -> Result<_, RelightError>)| {
        Ok(Sweep { name, parameter, measure, points: run(bench)?, bound: COEFFICIENT_BOUND })
    };
    selected.map(run).collect()
}

fn rotations(bench: &Bench<'_>, angle: fn(f64) -> f64) -> Result<Vec<SweepPoint>, RelightError> {
    let steps: Vec<f64> = (0..=32).map(|step| 10f64.powf(-f64::from(step) / 4.0)).collect();
    let axis = DVec3::new(1.0, -2.0, 0.5).normalize();
    let f = coefficients(ORDER);
    let row = |at: &f64| RotateRow {
        order: ORDER,
        f: f.clone(),
        rotation: DQuat::from_axis_angle(axis, angle(*at)),
    };
    let rows: Vec<RotateRow> = steps.iter().map(row).collect();
    let moved = |values: &[f64]| length(&values.iter().zip(&f).map(|(a, b)| a - b).collect::<Vec<_>>());
    let point = |((at, row), found)| SweepPoint::new(at, found, moved, Reproduce::from(row));
    Ok(steps.into_iter().zip(&rows).zip(sh_rotate(bench, &rows)?).map(point).collect())
}

fn peaks(bench: &Bench<'_>) -> Result<Vec<SweepPoint>, RelightError> {
    let peak = |step: i32| {
        let radiance = 10f64.powf(f64::from(step) / 4.0);
        let mut map = Map::new(64, 32, 0.5);
        map.rgb[11 * 64 + 24] = [radiance as f32; 3];
        projected(bench, radiance, map)
    };
    (0..=24).map(peak).collect()
}

fn poles(bench: &Bench<'_>) -> Result<Vec<SweepPoint>, RelightError> {
    let pole = |power: u32| {
        let height = 1 << power;
        let mut map = Map::new(8, height, 0.0);
        map.rgb[3] = [1.0; 3];
        projected(bench, f64::from(height), map)
    };
    (0..=13).map(pole).collect()
}

fn projected(bench: &Bench<'_>, at: f64, map: Map) -> Result<SweepPoint, RelightError> {
    let found = project(bench, ORDER, &map)?;
    let measure = |values: &[f64]| length(values);
    Ok(SweepPoint::new(at, found, measure, Reproduce::Environment { order: ORDER, map }))
}
