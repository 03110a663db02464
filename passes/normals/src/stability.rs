//! Extreme inputs with the device's radiance and the truth, sweeps of each limit, and refusals.

mod maps;
mod sweeps;

use glam::DVec3;

use crate::NormalsError;
use crate::bench::{Bench, LevelLobes, Row};
use crate::brdf::{Brdf, Directions};
use crate::eval::{TexelRow, texels};
use crate::map::NormalMap;
use crate::method::Method;
use crate::mixture::{Mixture, WeightedLobe};
use crate::reference;
use crate::settings::Settings;

pub use sweeps::{Sweep, sweeps};

/// Radiance, 1/sr, that an error is compared with at least: a hundredth of white paper.
const DARK: f64 = 0.003;
/// Lobes of every case.
const LOBES: usize = 4;

/// One extreme input.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What is tried.
    pub name: String,
    /// The input in words.
    pub input: String,
    /// The device's result, or a refusal.
    pub result: String,
    /// The truth of the same.
    pub truth: String,
    /// The error as [`error`] measures it; 0 for a refusal that came, infinite for one that did not.
    pub error: f64,
    /// The largest error allowed.
    pub bound: f64,
}

impl Outcome {
    /// Whether the error is within its bound; NaN is not.
    #[must_use]
    pub fn pass(&self) -> bool {
        self.error <= self.bound
    }

    fn of_value(name: String, input: String, value: f64, truth: f64, bound: f64) -> Self {
        let (result, shown) = (format!("{value:.8e}"), format!("{truth:.8e}"));
        Self { name, input, result, truth: shown, error: error(value, truth), bound }
    }
}

/// The difference relative to the truth, to 0.003 where that is darker. Infinite for a value that is not finite or below 0.
#[must_use]
pub fn error(value: f64, truth: f64) -> f64 {
    if !value.is_finite() || value < 0.0 {
        return f64::INFINITY;
    }
    (value - truth).abs() / truth.max(DARK)
}

/// A texel of a map under materials and directions that are all tried.
struct Case {
    name: &'static str,
    input: &'static str,
    map: NormalMap,
    level: usize,
    brdfs: &'static [Brdf],
    /// The largest error allowed.
    bound: f64,
}

/// Materials, the glossiest last: where few normals stand for many, each is a highlight of its own there.
const BRDFS: [Brdf; 5] = [
    Brdf::Lambert,
    Brdf::BlinnPhong { exponent: 1.0 },
    Brdf::BlinnPhong { exponent: 50.0 },
    Brdf::Ggx { alpha: 0.3 },
    Brdf::BlinnPhong { exponent: 10_000.0 },
];

/// Light and view of every case: from above, grazing on both sides, and opposite.
const DIRECTIONS: [[DVec3; 2]; 4] = [
    [DVec3::new(0.3, 0.1, 1.0), DVec3::new(-0.2, 0.3, 1.0)],
    [DVec3::new(1.0, 0.0, 1e-3), DVec3::new(-1.0, 0.2, 1e-3)],
    [DVec3::new(0.0, 1.0, 0.02), DVec3::new(0.1, 0.0, 1.0)],
    [DVec3::new(0.6, 0.0, 0.8), DVec3::new(-0.6, 0.0, -0.8)],
];

/// Runs the extreme inputs, or the one called `only`; none, if none has the name. A case's outcome is its worst row.
///
/// # Errors
/// [`NormalsError::Gpu`] when the device fails; a wrong result is an [`Outcome`] that does not pass.
pub fn cases(bench: &Bench<'_>, only: Option<&str>) -> Result<Vec<Outcome>, NormalsError> {
    let chosen = |name: &str| only.is_none_or(|only| only == name);
    let mut outcomes = Vec::new();
    for case in maps::cases()?.into_iter().filter(|case| chosen(case.name)) {
        outcomes.push(worst(bench, case)?);
    }
    if chosen(WRAP) {
        outcomes.push(wrapped(bench)?);
    }
    outcomes.extend(refusals(bench)?.into_iter().filter(|outcome| chosen(&outcome.name)));
    Ok(outcomes)
}

/// The row of a case that is farthest from its bound.
fn worst(bench: &Bench<'_>, case: Case) -> Result<Outcome, NormalsError> {
    let mut rows = Vec::new();
    for &brdf in case.brdfs {
        for [light, view] in DIRECTIONS {
            let method = Method::Lobes(LOBES);
            rows.push(TexelRow { level: case.level, x: 0, y: 0, light, view, brdf, method });
        }
    }
    let mut worst: Option<Outcome> = None;
    for (row, found) in rows.iter().zip(texels(bench, &case.map, &rows)?) {
        let found = found?;
        let input = format!("{}; {:?}, light {}, view {}", case.input, row.brdf, row.light, row.view);
        let outcome =
            Outcome::of_value(case.name.to_owned(), input, found.value, found.reference, case.bound);
        if worst.as_ref().is_none_or(|worst| outcome.error.total_cmp(&worst.error).is_gt()) {
            worst = Some(outcome);
        }
    }
    worst.ok_or(NormalsError::Range { what: "the number of rows", value: 0.0, range: "at least 1" })
}

const WRAP: &str = "a footprint across the wrap-around";

/// Halfway between the last column and the first, as a sampler that repeats sees it.
fn wrapped(bench: &Bench<'_>) -> Result<Outcome, NormalsError> {
    let (map, level) = (maps::grooves(64)?, 3);
    let built = bench.build(&map, &wide())?;
    let [width, _] = map.size(level);
    let [last, first] = [width - 1, 0].map(|x| texel(&built[level - 1], x, 2));
    let [light, view] = DIRECTIONS[0];
    let (directions, brdf) = (Directions::new(light, view)?, BRDFS[2]);
    let row =
        Row { lobes: Mixture::new(last)?.mix(&Mixture::new(first)?, 0.5).lobes().to_vec(), brdf, directions };
    let value = bench.radiance(&[row])?.first().copied().unwrap_or(f32::NAN);
    let truth =
        |x| Ok::<_, NormalsError>(reference::radiance(&map.footprint(level, x, 2)?, brdf, directions));
    let truth = 0.5 * (truth(width - 1)? + truth(0)?);
    let input = "grooves, level 3, halfway between the last column and the first".to_owned();
    Ok(Outcome::of_value(WRAP.to_owned(), input, value.into(), truth, 0.03))
}

/// Without a budget.
fn wide() -> Settings {
    Settings { budget: Some(u64::MAX), ..Settings::default() }
}

fn texel(level: &LevelLobes, x: usize, y: usize) -> Vec<WeightedLobe> {
    let at = (y * level.size[0] + x) * LOBES;
    level.lobes[at..at + LOBES].iter().map(|lobe| (*lobe).into()).collect()
}

/// What has to be refused, with a mend.
fn refusals(bench: &Bench<'_>) -> Result<Vec<Outcome>, NormalsError> {
    let map = maps::grooves(64)?;
    let over = Settings { budget: Some(1000), ..Settings::default() };
    let refused = |name: &str, input: &str, word: &str, result: Result<(), NormalsError>| {
        let shown = result.as_ref().map_or_else(ToString::to_string, |()| "no refusal".to_owned());
        let error = if result.is_err() && shown.contains(word) { 0.0 } else { f64::INFINITY };
        let truth = format!("a refusal that says `{word}`");
        let (name, input) = (name.to_owned(), input.to_owned());
        Outcome { name, input, result: shown, truth, error, bound: 0.0 }
    };
    let empty = NormalMap::from_vectors(0, 4, &[]).map(|_| ());
    let past = bench.build(&map, &over).map(|_| ());
    let lobes = Settings { fit: crate::FitSettings { lobes: 7, ..Default::default() }, ..wide() };
    let many = bench.build(&map, &lobes).map(|_| ());
    let blind = Directions::new(DVec3::ZERO, DVec3::Z).map(|_| ());
    Ok(vec![
        refused("a map without texels", "0 x 4", "at least one texel", empty),
        refused("a map past its budget", "64 x 64 within 1000 bytes", "give 5460 bytes", past),
        refused("seven lobes", "lobes = 7", "1 to 6", many),
        refused("a light without direction", "light = 0", "longer than 0", blind),
    ])
}
