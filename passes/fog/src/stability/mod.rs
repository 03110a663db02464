//! Extreme inputs with the GPU's result and the truth, sweeps of each limit through its singularity, and refusals.

mod angles;
mod features;
mod motion;
mod refusals;
mod surfaces;
mod sweeps;

use crate::FogError;
use crate::bench::Bench;
use crate::eval::{AirlightRow, Evaluated, airlight};

pub use sweeps::{Sweep, sweeps};

/// The bound on the relative error of a radiance, where the truth is at least [`SMALLEST`].
pub const RELATIVE_BOUND: f64 = 1e-3;

/// The least truth of which a relative error is asked; below it the difference may be [`ABSOLUTE_BOUND`].
pub const SMALLEST: f64 = 1e-30;

/// The bound on the difference from a smaller truth, W/sr/m2.
pub const ABSOLUTE_BOUND: f64 = 1e-36;

/// One extreme input.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What is tried.
    pub name: String,
    /// The input in words.
    pub input: String,
    /// The GPU's result, or a refusal.
    pub result: String,
    /// The truth of the same.
    pub truth: String,
    /// The error as [`error`] measures it; 0 for a refusal that came, infinite for one that did not.
    pub error: f64,
    /// The largest error allowed.
    pub bound: f64,
    /// The row of `fog-airlight` that makes it again, where one can.
    pub row: Option<AirlightRow>,
}

impl Outcome {
    /// Whether the error is within its bound; NaN is not.
    #[must_use]
    pub fn pass(&self) -> bool {
        self.error <= self.bound
    }

    /// A value beside its truth.
    fn of_value(name: String, input: String, value: f64, truth: f64) -> Self {
        let (result, shown) = (number(value), number(truth));
        let error = error(value, truth);
        Self { name, input, result, truth: shown, error, bound: RELATIVE_BOUND, row: None }
    }
}

/// The relative error of a radiance; below [`SMALLEST`] the difference in [`ABSOLUTE_BOUND`]s times the bound. Infinite
/// for a value that is not finite or below 0.
#[must_use]
pub fn error(value: f64, truth: f64) -> f64 {
    if !value.is_finite() || value < 0.0 {
        return f64::INFINITY;
    }
    let difference = (value - truth).abs();
    if truth >= SMALLEST { difference / truth } else { difference / ABSOLUTE_BOUND * RELATIVE_BOUND }
}

/// Runs the extreme inputs, or the one called `only`; none, if none has the name.
///
/// # Errors
/// [`FogError::Gpu`] when the device fails; a wrong result is an [`Outcome`] that does not pass.
pub fn cases(bench: &Bench<'_>, only: Option<&str>) -> Result<Vec<Outcome>, FogError> {
    let chosen = |name: &str| only.is_none_or(|only| only == name);
    let rows: Vec<(String, AirlightRow)> =
        angles::rows().into_iter().filter(|(name, _)| chosen(name)).collect();
    let mut outcomes = of_rows(bench, rows)?;
    outcomes.extend(features::cases(bench, chosen)?);
    outcomes.extend(surfaces::cases(bench, chosen)?);
    outcomes.extend(motion::cases(bench, chosen)?);
    outcomes.extend(refusals::cases(chosen));
    Ok(outcomes)
}

/// Rows run in one go.
fn of_rows(bench: &Bench<'_>, rows: Vec<(String, AirlightRow)>) -> Result<Vec<Outcome>, FogError> {
    let inputs: Vec<AirlightRow> = rows.iter().map(|(_, row)| *row).collect();
    let join = |((name, row), found): ((String, AirlightRow), Result<Evaluated, FogError>)| {
        let diverges = row.radius == 0.0 && row.gamma == 0.0 && row.distance >= row.light_distance;
        let mut outcome = match found {
            Ok(Evaluated { value, reference }) => Outcome::of_value(name, words(&row), value, reference),
            Err(reason) => refusal(name, words(&row), diverges, &reason.to_string()),
        };
        outcome.row = Some(row);
        outcome
    };
    Ok(rows.into_iter().zip(airlight(bench, &inputs)?).map(join).collect())
}

/// A refusal, which is due or is not.
fn refusal(name: String, input: String, due: bool, reason: &str) -> Outcome {
    let (truth, error) = if due { ("refused", 0.0) } else { ("accepted", f64::INFINITY) };
    let (result, truth) = (format!("refused: {reason}"), truth.to_owned());
    Outcome { name, input, result, truth, error, bound: RELATIVE_BOUND, row: None }
}

fn words(row: &AirlightRow) -> String {
    let AirlightRow { extinction, light_distance, gamma, distance, radius, phase, .. } = row;
    format!(
        "extinction {extinction:e} 1/m, light {light_distance} m away, radius {radius} m, gamma {gamma:e}, surface at \
         {distance} m, {phase:?}"
    )
}

/// A number in nine significant digits.
fn number(value: f64) -> String {
    format!("{value:.8e}")
}
