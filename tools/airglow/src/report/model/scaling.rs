//! How time grows with the size of an input: samples, and slopes in logarithms of both.
//!
//! A cost of a fixed part and one for each of `n` has a slope that rises from 0 to 1; so there are two: over all sizes, and over
//! the larger half, where the fixed part counts least.

use airglow_math::statistics;
use serde::{Deserialize, Serialize};

use super::Point;

/// A sweep of sizes.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Scaling {
    /// What there are more and more of.
    pub what: String,
    /// What was timed.
    pub timed: String,
    /// The sizes, ascending, and what was measured of each.
    pub points: Vec<(f64, Point)>,
    /// Sizes that were asked for and not measured, and how they are; empty where all were.
    pub cut: String,
    /// Over all sizes, and over the larger half: median over the rounds with its 95 % interval.
    pub slopes: Option<[[f64; 3]; 2]>,
}

impl Scaling {
    /// A sweep with its slopes; none where a size has no time.
    pub fn new(what: &str, timed: String, cut: &str, points: Vec<(f64, Point)>) -> Self {
        let slopes = || Some([slope(&points)?, slope(&points[points.len() / 2..])?]);
        Self { what: what.to_owned(), timed, cut: cut.to_owned(), slopes: slopes(), points }
    }
}

/// The slope of each round by least squares, and of these the median with its interval.
fn slope(points: &[(f64, Point)]) -> Option<[f64; 3]> {
    let rounds = points.iter().map(|(_, point)| point.milliseconds.len()).min()?;
    let of_round = |round: usize| {
        let pairs = points.iter().map(|(at, point)| (at.ln(), point.milliseconds[round].ln()));
        least_squares(pairs.collect())
    };
    let slopes = (0..rounds).map(of_round).collect::<Option<Vec<f64>>>()?;
    let interval = statistics::bootstrap_interval(&slopes, 0.95, 2000, 1).ok()?;
    Some([interval.estimate, interval.low, interval.high])
}

/// Slope of the straight line nearest to some points; none where they have no two abscissae, or are not finite.
fn least_squares(pairs: Vec<(f64, f64)>) -> Option<f64> {
    let count = pairs.len() as f64;
    let (x, y) = pairs.iter().fold((0.0, 0.0), |(x, y), pair| (x + pair.0 / count, y + pair.1 / count));
    let (both, own) = pairs.iter().fold((0.0, 0.0), |(both, own), pair| {
        (both + (pair.0 - x) * (pair.1 - y), own + (pair.0 - x) * (pair.0 - x))
    });
    Some(both / own).filter(|slope| slope.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::model::testing;

    #[test]
    fn slopes_of_powers_and_of_a_fixed_cost_are_found() {
        let measured = |time: fn(f64) -> f64| {
            let point = |at: f64| {
                let mut point = testing::report("a device").curves.remove(0).points.remove(0);
                point.milliseconds = vec![time(at), 1.1 * time(at)];
                (at, point)
            };
            Scaling::new("things", "all".to_owned(), "", [1.0, 10.0, 100.0, 1000.0].map(point).into())
        };
        let square = measured(|at| 0.5 * at * at);
        assert!((square.slopes.unwrap()[0][0] - 2.0).abs() < 1e-9, "{:?}", square.slopes);
        let [all, larger] = measured(|at| 10.0 + at).slopes.unwrap();
        assert!(all[0] < larger[0] && larger[0] < 1.0, "{all:?} {larger:?}");
    }

    #[test]
    fn without_times_there_is_no_slope() {
        assert_eq!(Scaling::new("things", "all".to_owned(), "all of it", Vec::new()).slopes, None);
    }
}
