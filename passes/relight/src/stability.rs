//! Extreme inputs with the GPU's result and the truth, and sweeps of each limit through its singularity.

mod environments;
mod reproduce;
mod rows;
mod sweep;
mod vertices;

use crate::RelightError;
use crate::bench::Bench;
use crate::eval::Evaluated;

pub use reproduce::{Map, Reproduce};
pub use sweep::{Sweep, SweepPoint, sweeps};

/// The bound on the relative L2 error of coefficient vectors.
pub const COEFFICIENT_BOUND: f64 = 1e-5;

/// Which inputs are tried.
#[derive(Clone, Copy, Debug, Default)]
pub struct Selection<'a> {
    /// Whether the mesh of two million vertices is (a gigabyte of memory, seconds of time).
    pub large: bool,
    /// Only the one of this name.
    pub only: Option<&'a str>,
}

impl Selection<'_> {
    fn has(&self, name: &str) -> bool {
        self.only.is_none_or(|only| only == name)
    }
}

/// One extreme input.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What is tried.
    pub name: String,
    /// The input in words.
    pub input: String,
    /// The GPU's result: the value or colour channel with the largest error, or a refusal. Values are coefficients by
    /// index; those of an environment are red, green and blue of each coefficient in turn.
    pub result: String,
    /// The truth of the same.
    pub truth: String,
    /// The error, in the measure its bound is stated in; 0 for a refusal that came, infinite for one that did not.
    pub error: f64,
    /// The largest error allowed.
    pub bound: f64,
    /// How to run this input alone.
    pub reproduce: Reproduce,
}

impl Outcome {
    /// Whether the error is within its bound; NaN is not.
    #[must_use]
    pub fn pass(&self) -> bool {
        self.error <= self.bound
    }

    /// What a row gave: the coefficient with the largest error beside its truth, or the refusal that is `due`.
    fn of_row(
        name: String,
        input: String,
        found: Result<Evaluated, RelightError>,
        due: bool,
        reproduce: Reproduce,
    ) -> Self {
        let (result, truth, error) = match found {
            Ok(Evaluated { values, reference }) => {
                let place = worst(&values, &reference);
                let show = |values: &[f64]| format!("value {place}: {}", number(values[place]));
                let error = if due { f64::INFINITY } else { relative(&values, &reference) };
                (show(&values), if due { "refused".to_owned() } else { show(&reference) }, error)
            }
            Err(reason) => {
                let (truth, error) = if due { ("refused", 0.0) } else { ("accepted", f64::INFINITY) };
                (format!("refused: {reason}"), truth.to_owned(), error)
            }
        };
        Self { name, input, result, truth, error, bound: COEFFICIENT_BOUND, reproduce }
    }
}

/// Runs the extreme inputs that are selected; none, if none has the name.
///
/// # Errors
/// [`RelightError::Gpu`] when the device fails; a wrong result is an [`Outcome`] that does not pass.
pub fn cases(bench: &Bench<'_>, selection: &Selection<'_>) -> Result<Vec<Outcome>, RelightError> {
    let mut outcomes = environments::cases(bench, selection)?;
    outcomes.extend(rows::rotations(bench, selection)?);
    outcomes.extend(rows::products(bench, selection)?);
    outcomes.extend(vertices::cases(bench, selection)?);
    Ok(outcomes)
}

/// A number in nine significant digits.
fn number(value: f64) -> String {
    format!("{value:.8e}")
}

/// The Euclidean length of all values.
fn length<'v>(values: impl IntoIterator<Item = &'v f64>) -> f64 {
    values.into_iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// The relative L2 distance, or the length of the result where the truth is zero.
fn relative(values: &[f64], truth: &[f64]) -> f64 {
    let difference: Vec<f64> = values.iter().zip(truth).map(|(value, truth)| value - truth).collect();
    match length(truth) {
        0.0 => length(values),
        scale => length(&difference) / scale,
    }
}

/// The index of the value furthest from its truth; NaN is further than any.
fn worst(values: &[f64], truth: &[f64]) -> usize {
    let errors = values.iter().zip(truth).map(|(value, truth)| (value - truth).abs());
    errors.enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0, |(place, _)| place)
}

/// Coefficients without symmetry: 1, -1/2, 1/3, …
fn coefficients(order: usize) -> Vec<f64> {
    (1..=order * order).map(|i| if i % 2 == 0 { -1.0 } else { 1.0 } / i as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(found: Result<Evaluated, RelightError>, due: bool) -> Outcome {
        Outcome::of_row("a".to_owned(), String::new(), found, due, Reproduce::Case)
    }

    #[test]
    fn an_outcome_shows_the_worst_coefficient_or_the_refusal() {
        let row = || Evaluated { values: vec![1.0, 2.5, 3.1], reference: vec![1.0, 2.0, 3.0] };
        let shown = outcome(Ok(row()), false);
        assert_eq!((&shown.result[..], &shown.truth[..]), ("value 1: 2.50000000e0", "value 1: 2.00000000e0"));
        assert!(!shown.pass());
        let refused = || Err(RelightError::Order { order: 9 });
        let refusal = outcome(refused(), true);
        assert!(refusal.result.starts_with("refused: relight: order 9") && refusal.pass(), "{refusal:?}");
        assert!(!outcome(refused(), false).pass() && !outcome(Ok(row()), true).pass());
        assert_eq!(worst(&[0.0, f64::NAN, 9.0], &[0.0; 3]), 1);
    }
}
