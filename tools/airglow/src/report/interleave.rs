//! Fair timing of rivals: all of them in turn, round after round, so that drift of clocks and load falls on
//! every one alike; then paired comparison.

use airglow_math::{MathError, statistics};

use super::model::{Comparison, Point};

/// Confidence of the bootstrap intervals.
const CONFIDENCE: f64 = 0.95;
/// Resamples of a bootstrap interval.
const RESAMPLES: usize = 2000;
/// The same samples always give the same interval.
const SEED: u64 = 1;

/// How often to measure.
#[derive(Clone, Copy, Debug)]
pub struct Rounds {
    /// Rounds whose times are dropped: drivers compile at first use.
    pub warm_up: usize,
    /// Rounds whose times are kept.
    pub measured: usize,
}

/// Milliseconds of `rivals` runs, `[rival][round]`. `run(rival)` makes one run and returns its time. Every
/// second round goes backwards, so that no rival always follows the same neighbour.
pub fn measure<E>(
    rounds: Rounds,
    rivals: usize,
    mut run: impl FnMut(usize) -> Result<f64, E>,
) -> Result<Vec<Vec<f64>>, E> {
    let mut samples = vec![Vec::with_capacity(rounds.measured); rivals];
    for round in 0..rounds.warm_up + rounds.measured {
        for step in 0..rivals {
            let rival = if round % 2 == 0 { step } else { rivals - 1 - step };
            let milliseconds = run(rival)?;
            if round >= rounds.warm_up {
                samples[rival].push(milliseconds);
            }
        }
    }
    Ok(samples)
}

/// The chosen point's time against every other point measured in the same rounds.
pub fn compare(points: &[Point], chosen: &str) -> Result<Vec<Comparison>, MathError> {
    let Some(mine) = points.iter().find(|point| point.setting == chosen) else { return Ok(Vec::new()) };
    let rivals = points.iter().filter(|point| point.setting != chosen);
    rivals
        .filter(|rival| !mine.milliseconds.is_empty() && rival.milliseconds.len() == mine.milliseconds.len())
        .map(|rival| paired(mine, rival))
        .collect()
}

/// One point's time against another's, both measured in the same rounds.
pub fn paired(mine: &Point, rival: &Point) -> Result<Comparison, MathError> {
    let (mine_times, rival_times) = (&mine.milliseconds, &rival.milliseconds);
    let interval = statistics::paired_ratio_interval(mine_times, rival_times, CONFIDENCE, RESAMPLES, SEED)?;
    Ok(Comparison {
        setting: mine.setting.clone(),
        against: rival.setting.clone(),
        ratio: interval.estimate,
        interval: [interval.low, interval.high],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::model::testing;

    #[test]
    fn every_rival_runs_once_a_round_and_warm_up_is_dropped() {
        let mut calls = Vec::new();
        let rounds = Rounds { warm_up: 1, measured: 2 };
        let samples = measure(rounds, 2, |rival| {
            calls.push(rival);
            Ok::<f64, ()>(calls.len() as f64)
        })
        .unwrap();
        assert_eq!(calls, [0, 1, 1, 0, 0, 1]);
        assert_eq!(samples, [[4.0, 5.0], [3.0, 6.0]]);
    }

    #[test]
    fn four_times_the_time_is_called_slower() {
        let report = testing::report("a test device");
        let found = compare(&report.curves[0].points, "fine").unwrap();
        assert_eq!((found.len(), found[0].verdict()), (1, "slower"));
        assert!((found[0].ratio - 4.0).abs() < 1e-12, "{} instead of 4", found[0].ratio);
    }
}
