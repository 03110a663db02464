//! Sweeps in logarithmic steps through the limits: small and half turns, high peaks, texels at the pole.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};

use super::{COEFFICIENT_BOUND, coefficients, length, relative};
use crate::RelightError;
use crate::bench::{Bench, Texels};
use crate::eval::{RotateRow, environment_sh, sh_rotate};

/// The order of all sweeps.
const ORDER: usize = 6;

/// One point of a sweep.
#[derive(Clone, Copy, Debug)]
pub struct SweepPoint {
    /// The parameter.
    pub at: f64,
    /// The GPU's value of the swept measure.
    pub value: f64,
    /// The truth of it.
    pub truth: f64,
    /// The relative L2 error of the whole vector.
    pub error: f64,
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

/// Runs every sweep.
///
/// # Errors
/// [`RelightError::Gpu`] when the device fails.
pub fn sweeps(bench: &Bench<'_>) -> Result<Vec<Sweep>, RelightError> {
    let steps = || (0..=32).map(|step| 10f64.powf(-f64::from(step) / 4.0));
    Ok(vec![
        Sweep {
            name: "a turn becomes none",
            parameter: "angle, radians",
            measure: "distance from the unturned vector",
            points: turns(bench, steps().collect())?,
            bound: COEFFICIENT_BOUND,
        },
        Sweep {
            name: "a turn becomes a half turn",
            parameter: "pi - angle, radians",
            measure: "distance from the unturned vector",
            points: half_turns(bench, steps().collect())?,
            bound: COEFFICIENT_BOUND,
        },
        Sweep {
            name: "a peak rises",
            parameter: "radiance of one texel, W/sr/m2",
            measure: "norm of the coefficients",
            points: peaks(bench)?,
            bound: COEFFICIENT_BOUND,
        },
        Sweep {
            name: "a texel shrinks into the pole",
            parameter: "rows of the map",
            measure: "norm of the coefficients",
            points: poles(bench)?,
            bound: COEFFICIENT_BOUND,
        },
    ])
}

fn turns(bench: &Bench<'_>, angles: Vec<f64>) -> Result<Vec<SweepPoint>, RelightError> {
    rotations(bench, &angles, |angle| angle)
}

fn half_turns(bench: &Bench<'_>, rests: Vec<f64>) -> Result<Vec<SweepPoint>, RelightError> {
    rotations(bench, &rests, |rest| PI - rest)
}

fn rotations(
    bench: &Bench<'_>,
    parameters: &[f64],
    angle: impl Fn(f64) -> f64,
) -> Result<Vec<SweepPoint>, RelightError> {
    let axis = DVec3::new(1.0, -2.0, 0.5).normalize();
    let f = coefficients(ORDER);
    let row = |at: &f64| RotateRow {
        order: ORDER,
        f: f.clone(),
        rotation: DQuat::from_axis_angle(axis, angle(*at)),
    };
    let rows: Vec<RotateRow> = parameters.iter().map(row).collect();
    let moved = |values: &[f64]| length(&values.iter().zip(&f).map(|(a, b)| a - b).collect::<Vec<_>>());
    let point = |(at, result): (&f64, Result<crate::eval::Evaluated, RelightError>)| {
        let result = result?;
        Ok(SweepPoint {
            at: *at,
            value: moved(&result.values),
            truth: moved(&result.reference),
            error: relative(&result.values, &result.reference),
        })
    };
    parameters.iter().zip(sh_rotate(bench, &rows)?).map(point).collect()
}

fn peaks(bench: &Bench<'_>) -> Result<Vec<SweepPoint>, RelightError> {
    let peak = |step: i32| {
        let radiance = 10f64.powf(f64::from(step) / 4.0);
        let mut rgb = vec![[0.5; 3]; 64 * 32];
        rgb[11 * 64 + 24] = [radiance as f32; 3];
        project(bench, radiance, 64, 32, &rgb)
    };
    (0..=24).map(peak).collect()
}

fn poles(bench: &Bench<'_>) -> Result<Vec<SweepPoint>, RelightError> {
    let pole = |power: u32| {
        let height = 1 << power;
        let mut rgb = vec![[0.0; 3]; 8 * height as usize];
        rgb[3] = [1.0; 3];
        project(bench, f64::from(height), 8, height, &rgb)
    };
    (0..=13).map(pole).collect()
}

fn project(
    bench: &Bench<'_>,
    at: f64,
    width: u32,
    height: u32,
    rgb: &[[f32; 3]],
) -> Result<SweepPoint, RelightError> {
    let rows = environment_sh(bench, &[ORDER], &Texels { width, height, rgb })?;
    let Some(row) = rows.into_iter().next() else { return Err(RelightError::Order { order: ORDER }) };
    let row = row?;
    let (values, truth) = (row.values.concat(), row.reference.concat());
    Ok(SweepPoint { at, value: length(&values), truth: length(&truth), error: relative(&values, &truth) })
}
