//! Limits, gone through step by step.

use glam::DVec3;

use super::{DIRECTIONS, LOBES, error, maps};
use crate::NormalsError;
use crate::bench::{Bench, Row};
use crate::brdf::{Brdf, Directions};
use crate::eval::{TexelRow, texels};
use crate::map::NormalMap;
use crate::method::Method;
use crate::mixture::{Mixture, WeightedLobe};
use crate::shade;

const STEPS: usize = 61;

/// A limit gone through.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// What is swept.
    pub name: &'static str,
    /// The parameter.
    pub parameter: &'static str,
    /// Parameter, the device's value, the truth, the error.
    pub points: Vec<[f64; 4]>,
    /// The largest error allowed.
    pub bound: f64,
}

impl Sweep {
    /// Whether every point is within the bound; NaN is not.
    #[must_use]
    pub fn pass(&self) -> bool {
        self.points.iter().all(|[.., error]| *error <= self.bound)
    }
}

/// Runs the sweeps, or the one called `only`.
///
/// # Errors
/// As [`super::cases`].
pub fn sweeps(bench: &Bench<'_>, only: Option<&str>) -> Result<Vec<Sweep>, NormalsError> {
    let chosen = |name: &str| only.is_none_or(|only| only == name);
    let mut all = Vec::new();
    if chosen(WIDTH) {
        all.push(widths(bench)?);
    }
    if chosen(EXPONENT) {
        all.push(exponents(bench)?);
    }
    if chosen(HORIZON) {
        all.push(horizon(bench)?);
    }
    Ok(all)
}

const WIDTH: &str = "a lobe from uniform to a single normal";
const EXPONENT: &str = "the exponent from 1 to 10 000";
const HORIZON: &str = "the light through the horizon";

fn fraction(i: usize) -> f64 {
    i as f64 / (STEPS - 1) as f64
}

/// One lobe by how short of 1 its mean is, from 1e-9 to 1, beside the same formulas in f64.
fn widths(bench: &Bench<'_>) -> Result<Sweep, NormalsError> {
    let [light, view] = DIRECTIONS[0];
    let (directions, brdf) = (Directions::new(light, view)?, Brdf::BlinnPhong { exponent: 50.0 });
    let missing = |i: usize| 10_f64.powf(-9.0 * (1.0 - fraction(i)));
    // What f32 holds of the lobe is the input of both.
    let lobe = |i| -> WeightedLobe {
        WeightedLobe { weight: 1.0, moment: (1.0 - missing(i)) * DVec3::new(0.1, 0.2, 1.0).normalize() }
            .packed()
            .into()
    };
    let rows: Vec<Row> = (0..STEPS).map(|i| Row { lobes: vec![lobe(i)], brdf, directions }).collect();
    let point = |(i, value): (usize, f32)| {
        let truth = shade::radiance(&Mixture::new(vec![lobe(i)])?, brdf, directions);
        Ok([missing(i), value.into(), truth, error(value.into(), truth)])
    };
    let points = bench.radiance(&rows)?.into_iter().enumerate().map(point);
    let points = points.collect::<Result<_, NormalsError>>()?;
    Ok(Sweep { name: WIDTH, parameter: "1 - r", points, bound: 5e-3 })
}

fn exponents(bench: &Bench<'_>) -> Result<Sweep, NormalsError> {
    let map = NormalMap::from_vectors(4, 4, &[[0.05, 0.2, 0.97]; 16])?;
    let at: Vec<f64> = (0..STEPS).map(|i| 10_f64.powf(4.0 * fraction(i))).collect();
    let row = |&exponent: &f64| (DIRECTIONS[0], Brdf::BlinnPhong { exponent });
    let points = points(bench, &map, 2, &at, &at.iter().map(row).collect::<Vec<_>>())?;
    Ok(Sweep { name: EXPONENT, parameter: "exponent", points, bound: 0.01 })
}

/// Grooves under a light that goes down on one side.
fn horizon(bench: &Bench<'_>) -> Result<Sweep, NormalsError> {
    let map = maps::grooves(16)?;
    let at: Vec<f64> = (0..STEPS).map(|i| std::f64::consts::PI * fraction(i)).collect();
    let row = |&angle: &f64| {
        ([DVec3::new(angle.sin(), 0.1, angle.cos()), DVec3::new(0.0, 0.3, 1.0)], Brdf::Lambert)
    };
    let points = points(bench, &map, 4, &at, &at.iter().map(row).collect::<Vec<_>>())?;
    Ok(Sweep { name: HORIZON, parameter: "angle from the zenith", points, bound: 0.01 })
}

/// The first texel of a level under each material and directions, beside the truth.
fn points(
    bench: &Bench<'_>,
    map: &NormalMap,
    level: usize,
    at: &[f64],
    rows: &[([DVec3; 2], Brdf)],
) -> Result<Vec<[f64; 4]>, NormalsError> {
    let method = Method::Lobes(LOBES);
    let row = |&([light, view], brdf): &([DVec3; 2], Brdf)| TexelRow {
        level,
        x: 0,
        y: 0,
        light,
        view,
        brdf,
        method,
    };
    let found = texels(bench, map, &rows.iter().map(row).collect::<Vec<_>>())?;
    let point = |(at, found): (&f64, Result<_, NormalsError>)| {
        let crate::eval::Evaluated { value, reference } = found?;
        Ok([*at, value, reference, error(value, reference)])
    };
    at.iter().zip(found).map(point).collect()
}
