//! Which setting a curve chooses: the rule, stated once.

use super::super::interleave;
use super::super::model::{Choice, Comparison, Point};
use super::super::pareto;
use crate::failure::{Failure, Outcome};

/// Errors are not seen below this share of the mean light: Weber's contrast threshold in good light is 1 to 2 %.
const VISIBLE: f64 = 0.01;

/// A dearer setting is taken if the model error falls at least to this share for each doubling of time.
const SHARE_PER_DOUBLING: f64 = 0.9;

/// The rule of [`climb`] in words, for reports.
pub fn rule() -> String {
    format!(
        "The rule: settings whose 95 % interval of the paired time ratio to the fastest of them includes 1 count as \
         equal in time, and the most accurate of them stands for all. Up the Pareto front of median time and model \
         error, a dearer setting is taken while the error falls by at least {:.0} % for each doubling of time and its \
         95th percentile is not yet below {:.0} %, the contrast that the eye can see.",
        100.0 * (1.0 - SHARE_PER_DOUBLING),
        100.0 * VISIBLE
    )
}

/// The setting that a curve of model error over time supports.
///
/// The rule. (1) The noise of the truth is subtracted from the model error in quadrature; what is left is compared.
/// (2) From the fastest setting on, all whose 95 % bootstrap interval of the paired time ratio to it includes 1 count
/// as equal in time, and the most accurate of them stands for all. (3) Of these, the Pareto front of median time and
/// error remains. (4) Walking up the front from its fastest end, a dearer setting is taken while the error falls by
/// at least 10 % for each doubling of time: e' <= e 0.9^log2(t'/t). The walk ends at the first that is not taken, and
/// (5) where the 95th percentile of the error is below 1 %, the contrast that the eye can see.
///
/// `None` if a point lacks its time or its model error.
pub fn climb(points: &[Point]) -> Outcome<Option<Choice>> {
    let measured: Option<Vec<Standing<'_>>> = points.iter().map(Standing::of).collect();
    let Some(measured) = measured.filter(|all| !all.is_empty()) else { return Ok(None) };
    let distinct = distinct_in_time(measured)?;
    let pairs: Vec<(f64, f64)> = distinct.iter().map(|here| (here.time, here.error)).collect();
    let front: Vec<_> = pareto::front(&pairs).into_iter().map(|place| distinct[place]).collect();
    let Some((&first, dearer)) = front.split_first() else { return Ok(None) };
    let mut chosen = first;
    let mut reason = String::new();
    for &next in dearer {
        if chosen.point.error.model_p95.is_some_and(|p95| p95 < VISIBLE) {
            reason.push_str(&format!(
                "the 95th percentile of the error at {} is below {:.0} %, and more is not seen; ",
                chosen.point.setting,
                100.0 * VISIBLE
            ));
            break;
        }
        let (taken, line) = step(chosen, next);
        reason.push_str(&line);
        if !taken {
            break;
        }
        chosen = next;
    }
    if chosen.point.setting == front[front.len() - 1].point.setting {
        reason.push_str("nothing more accurate was measured");
    }
    Ok(Some(Choice { setting: chosen.point.setting.clone(), reason }))
}

/// A point with what decides.
#[derive(Clone, Copy)]
struct Standing<'a> {
    point: &'a Point,
    time: f64,
    error: f64,
}

impl<'a> Standing<'a> {
    fn of(point: &'a Point) -> Option<Self> {
        Some(Self { point, time: point.time()?.median, error: point.error.model? })
    }
}

/// The most accurate setting of each group of equal time. Each group is compared with its own fastest member, so that
/// a chain of small steps does not pass for one.
fn distinct_in_time(mut left: Vec<Standing<'_>>) -> Outcome<Vec<Standing<'_>>> {
    left.sort_by(|a, b| a.time.total_cmp(&b.time));
    let mut distinct = Vec::new();
    while let Some(&fastest) = left.first() {
        let (mut best, mut slower) = (fastest, Vec::new());
        for &here in &left[1..] {
            if different(here.point, fastest.point)? {
                slower.push(here);
            } else if here.error < best.error {
                best = here;
            }
        }
        distinct.push(best);
        left = slower;
    }
    Ok(distinct)
}

fn different(a: &Point, b: &Point) -> Outcome<bool> {
    interleave::paired(a, b).map(|comparison| comparison.different()).map_err(Failure::work)
}

/// Whether the step is worth its time, and the line that says so.
fn step(here: Standing<'_>, next: Standing<'_>) -> (bool, String) {
    let (times, falls) = (next.time / here.time, next.error / here.error);
    let allowed = SHARE_PER_DOUBLING.powf(times.log2().max(0.0));
    let taken = falls <= allowed;
    let verdict = if taken { "taken" } else { "not taken" };
    let line = format!(
        "{} -> {}: model error {:.2e} -> {:.2e} ({falls:.3} times) for {times:.2} times the time, {allowed:.3} needed: \
         {verdict}; ",
        here.point.setting, next.point.setting, here.error, next.error
    );
    (taken, line)
}

/// The shipped setting unless another's paired interval says that it is faster; then the fastest of those.
///
/// `None` if the shipped setting is not among the points.
pub fn fastest(points: &[Point], shipped: &str) -> Outcome<Option<Choice>> {
    if !points.iter().any(|point| point.setting == shipped) {
        return Ok(None);
    }
    let stands = interleave::compare(points, shipped).map_err(Failure::work)?;
    let slower = |against: &&Comparison| against.different() && against.ratio > 1.0;
    let worst = stands.iter().filter(slower).max_by(|a, b| a.ratio.total_cmp(&b.ratio));
    let (setting, verdict) = match worst {
        Some(faster) => (faster.against.clone(), "the fastest".to_owned()),
        None if stands.iter().all(Comparison::different) => (shipped.to_owned(), "the fastest".to_owned()),
        None => (shipped.to_owned(), "a tie, and the default is kept".to_owned()),
    };
    let mut reason = format!("{verdict}: ");
    for line in &stands {
        let [low, high] = line.interval;
        reason.push_str(&format!(
            "{} takes {:.3} times {} (95 % interval {low:.3} to {high:.3}, {}); ",
            line.setting,
            line.ratio,
            line.against,
            line.verdict()
        ));
    }
    Ok(Some(Choice { setting, reason }))
}

#[cfg(test)]
mod tests {
    use super::super::super::model::Errors;
    use super::*;

    /// A point timed in five rounds whose load drifts alike for all, and its own jitter.
    fn point(setting: &str, milliseconds: f64, jitter: f64, error: f64) -> Point {
        let drift = [1.0, 1.3, 0.9, 1.1, 1.2];
        let own = [0.0, 1.0, -1.0, 0.5, -0.5];
        Point {
            setting: setting.to_owned(),
            milliseconds: (0..5).map(|i| milliseconds * drift[i] * (1.0 + jitter * own[i])).collect(),
            memory: 1,
            counts: Default::default(),
            error: Errors { model: Some(error), ..Errors::default() },
            distribution: None,
        }
    }

    #[test]
    fn a_lower_error_for_hardly_more_time_is_taken_and_a_dear_one_is_not() {
        let points =
            [point("3", 1.0, 0.0, 7.70e-2), point("4", 1.02, 0.0, 6.85e-2), point("5", 2.04, 0.0, 6.5e-2)];
        let chosen = climb(&points).unwrap().unwrap();
        assert_eq!(chosen.setting, "4", "{}", chosen.reason);
        assert!(chosen.reason.contains("4 -> 5") && chosen.reason.contains("not taken"), "{}", chosen.reason);
        assert!(climb(&[]).unwrap().is_none());
    }

    #[test]
    fn settings_beaten_in_both_are_passed_over() {
        let points = [point("a", 1.0, 0.0, 0.5), point("b", 2.0, 0.0, 0.6), point("c", 3.0, 0.0, 0.1)];
        let chosen = climb(&points).unwrap().unwrap();
        assert_eq!(chosen.setting, "c", "{}", chosen.reason);
        assert!(chosen.reason.contains("a -> c"), "{}", chosen.reason);
    }

    #[test]
    fn of_settings_equal_in_time_the_more_accurate_wins() {
        let points = [point("a", 1.0, 0.0, 0.100), point("b", 1.01, 0.2, 0.099)];
        assert_eq!(climb(&points).unwrap().unwrap().setting, "b");
        let dear = [point("a", 1.0, 0.0, 0.100), point("b", 1.5, 0.2, 0.099)];
        assert_eq!(climb(&dear).unwrap().unwrap().setting, "a");
    }

    #[test]
    fn what_is_not_seen_ends_the_walk() {
        let mut points =
            [point("64", 1.0, 0.0, 0.02), point("256", 4.0, 0.0, 0.008), point("1024", 16.0, 0.0, 0.003)];
        assert_eq!(climb(&points).unwrap().unwrap().setting, "1024");
        points[1].error.model_p95 = Some(0.009);
        let chosen = climb(&points).unwrap().unwrap();
        assert_eq!(chosen.setting, "256", "{}", chosen.reason);
        assert!(chosen.reason.contains("not seen"), "{}", chosen.reason);
    }

    #[test]
    fn a_tie_keeps_the_default_and_a_faster_rival_does_not() {
        let tie = [point("compute", 1.01, 0.2, 0.0), point("fragment", 1.0, 0.0, 0.0)];
        let chosen = fastest(&tie, "compute").unwrap().unwrap();
        assert_eq!(chosen.setting, "compute");
        assert!(chosen.reason.contains("tie"), "{}", chosen.reason);
        let beaten = [point("compute", 1.5, 0.0, 0.0), point("fragment", 1.0, 0.0, 0.0)];
        assert_eq!(fastest(&beaten, "compute").unwrap().unwrap().setting, "fragment");
        assert!(fastest(&beaten, "other").unwrap().is_none());
    }
}
