//! Every exponential over receivers, among chained products: error against time, by order and by number of blockers.

use airglow::shadow::bench::SphereKernel;
use airglow::shadow::families::Random;
use airglow::shadow::reference::{caps, rms, truth};
use airglow::shadow::{Blockers, Exponential, MAX_ORDER, MIN_ORDER, Settings, ShadowError, Sphere};
use glam::{DMat4, DVec3};

use super::{Measurement, Rival};
use crate::failure::{Failure, Outcome};
use crate::report::interleave::{compare, paired};
use crate::report::model::{Choice, Curve, Number, Point};

/// Degree of the rule that what is really open is integrated by.
const DEGREE: usize = 160;
/// Numbers of blockers.
const COUNTS: [usize; 5] = [1, 5, 15, 60, 200];

/// The curves of methods and of numbers of blockers, and what they are held to.
pub fn curves(measurement: &Measurement<'_>, figure: &[Sphere]) -> Outcome<(Vec<Curve>, Vec<Number>)> {
    let ground = ground(measurement.effort.side);
    let (mut curves, mut numbers) = (Vec::new(), Vec::new());
    let truths = truths(measurement, &ground, figure)?;
    for order in MIN_ORDER..=MAX_ORDER {
        let rivals = rivals(order);
        let points = measured(measurement, &rivals, &ground, figure, &truths)?;
        numbers.extend(speeds(order, &points)?);
        let title = format!("exponential, order {order}, {} spheres of a figure", figure.len());
        let question = "What does a way to the visibility cost, and how wrong is it?";
        curves.push(curve(title, question, points, "default")?);
    }
    for order in MIN_ORDER..=MAX_ORDER {
        let (curve, number) = crowds(measurement, &ground, order)?;
        curves.push(curve);
        numbers.push(number);
    }
    Ok((curves, numbers))
}

/// Ways with a kernel over receivers; nothing is culled or clamped.
fn rivals(order: usize) -> Vec<Rival> {
    let ways = [
        ("default", Exponential::Adaptive),
        ("PS-3", Exponential::Series { degree: 3 }),
        ("PS-9", Exponential::Series { degree: 9 }),
        ("PS-9, mean apart", Exponential::Horner { degree: 9, norm: 1e9 }),
        ("PS*-2", Exponential::ScaledSeries { degree: 2 }),
        ("PS*-9", Exponential::ScaledSeries { degree: 9 }),
        ("squares", Exponential::Horner { degree: 2, norm: 0.25 }),
        ("OL", Exponential::OptimalLinear),
        ("HYB 1", Exponential::Hybrid { threshold: 1.0 }),
    ];
    let rival = |(name, exponential): (&str, Exponential)| Rival {
        name: name.to_owned(),
        settings: plain(order, exponential),
        kernel: SphereKernel::Pass,
    };
    let mut rivals: Vec<Rival> =
        ways.into_iter().map(rival).filter(|rival| rival.settings.check().is_ok()).collect();
    rivals.push(products(order, "products".to_owned()));
    rivals
}

pub(super) fn plain(order: usize, exponential: Exponential) -> Settings {
    Settings { order, exponential, reach: 0.0, clamp: false, ..Settings::default() }
}

fn products(order: usize, name: String) -> Rival {
    Rival { name, settings: plain(order, Exponential::Adaptive), kernel: SphereKernel::Products }
}

/// A square of ground of 4 m about the origin.
pub(super) fn ground(side: usize) -> Vec<[f32; 3]> {
    let place = |at: usize| 4.0 * at as f32 / side as f32 - 2.0;
    (0..side * side).map(|at| [place(at % side), 0.0, place(at / side)]).collect()
}

/// Indices of the receivers whose error is measured.
fn probes(measurement: &Measurement<'_>, count: usize) -> impl Iterator<Item = usize> {
    let probes = measurement.effort.probes;
    (0..probes).map(move |probe| (probe * count / probes + 17 * probe % 61) % count)
}

/// What is really open at the probes, at the highest order.
fn truths(measurement: &Measurement<'_>, ground: &[[f32; 3]], spheres: &[Sphere]) -> Outcome<Vec<Vec<f64>>> {
    let at = |probe: usize| {
        let place = DVec3::from_array(ground[probe].map(f64::from));
        truth(MAX_ORDER, DEGREE, &caps(spheres, place))
    };
    let truths: Result<_, ShadowError> = probes(measurement, ground.len()).map(at).collect();
    truths.map_err(Failure::work)
}

/// Times of rivals with the error of each.
fn measured(
    measurement: &Measurement<'_>,
    rivals: &[Rival],
    ground: &[[f32; 3]],
    spheres: &[Sphere],
    truths: &[Vec<f64>],
) -> Outcome<Vec<Point>> {
    let blockers = Blockers::default();
    blockers.set(spheres, DMat4::IDENTITY).map_err(Failure::work)?;
    let timed = measurement.interleaved(rivals, ground, None, |_| blockers.clone())?;
    let with_error = |((mut point, values), rival): ((Point, Vec<f32>), &Rival)| {
        let width = rival.settings.order * rival.settings.order;
        let errors = probes(measurement, ground.len()).zip(truths).map(|(probe, truth)| {
            let found: Vec<f64> = values[probe * width..][..width].iter().map(|v| f64::from(*v)).collect();
            rms(&found, &truth[..width])
        });
        point.error.setting = Some(errors.sum::<f64>() / truths.len().max(1) as f64);
        point
    };
    Ok(timed.into_iter().zip(rivals).map(with_error).collect())
}

fn curve(knob: String, question: &str, points: Vec<Point>, chosen: &str) -> Outcome<Curve> {
    let comparisons = compare(&points, chosen).map_err(Failure::work)?;
    Ok(Curve {
        knob,
        question: question.to_owned(),
        norm: "root mean square over the sphere of the visibility's difference from what is really open, mean over receivers"
            .to_owned(),
        timed: "one frame of the pass".to_owned(),
        points,
        chosen: Some(Choice {
            setting: chosen.to_owned(),
            reason: "nearest to the exact exponential for any number of blockers".to_owned(),
        }),
        comparisons,
    })
}

/// The default, and the fastest of no more error than the thesis's, over chained products.
fn speeds(order: usize, points: &[Point]) -> Outcome<Vec<Number>> {
    let find = |name: &str| points.iter().find(|point| point.setting == name);
    let (Some(products), Some(default), Some(thesis)) = (find("products"), find("default"), find("PS*-2"))
    else {
        return Ok(Vec::new());
    };
    let times = |point: &Point| paired(products, point).map(|ratio| ratio.ratio).map_err(Failure::work);
    let good = |point: &&Point| point.error.setting <= thesis.error.setting && point.setting != "products";
    let mut fastest = (thesis, times(thesis)?);
    for point in points.iter().filter(good) {
        let ratio = times(point)?;
        if ratio > fastest.1 {
            fastest = (point, ratio);
        }
    }
    let asked = match order {
        4 => [Some(2.5), Some(3.4)],
        6 => [Some(6.0), Some(11.0)],
        _ => [None, None],
    };
    let number = |what: String, asked: Option<f64>, ratio: f64| Number {
        what,
        asked: asked.map_or("-".to_owned(), |asked| format!("at least {asked}")),
        measured: format!("{ratio:.2}"),
        holds: asked.is_none_or(|asked| ratio >= asked),
    };
    Ok(vec![
        number(
            format!("order {order}: time of chained products over the default's"),
            asked[0],
            times(default)?,
        ),
        number(
            format!("order {order}: the same of the fastest no worse than PS*-2, {}", fastest.0.setting),
            asked[1],
            fastest.1,
        ),
    ])
}

/// The default beside chained products by number of blockers, and from how many on it is the faster one.
fn crowds(measurement: &Measurement<'_>, ground: &[[f32; 3]], order: usize) -> Outcome<(Curve, Number)> {
    let (mut points, mut even) = (Vec::new(), None);
    for count in COUNTS {
        let spheres = crowd(count);
        let truths = truths(measurement, ground, &spheres)?;
        let rivals = [
            Rival {
                name: format!("default, {count}"),
                settings: plain(order, Exponential::Adaptive),
                kernel: SphereKernel::Pass,
            },
            products(order, format!("products, {count}")),
        ];
        let both = measured(measurement, &rivals, ground, &spheres, &truths)?;
        if even.is_none() && paired(&both[1], &both[0]).map_err(Failure::work)?.ratio > 1.0 {
            even = Some(count);
        }
        points.extend(both);
    }
    let number = Number {
        what: format!("order {order}: blockers from which the default is faster than products"),
        asked: "-".to_owned(),
        measured: even.map_or("none of those measured".to_owned(), |count| format!("{count} of {COUNTS:?}")),
        holds: true,
    };
    let question = "How do both ways grow with the number of blockers?";
    let title = format!("number of blockers, order {order}");
    Ok((curve(title, question, points, "default, 60")?, number))
}

/// A column of random spheres as tall as a person.
pub(super) fn crowd(count: usize) -> Vec<Sphere> {
    let mut random = Random::new(count as u32);
    let sphere = |_| {
        let around = random.direction();
        let center = DVec3::new(0.3 * around.x, 1.8 * random.unit(), 0.3 * around.z);
        Sphere { center, radius: 0.05 + 0.07 * random.unit() }
    };
    (0..count).map(sphere).collect()
}
