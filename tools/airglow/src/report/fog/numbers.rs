//! The numbers that the pass is held to, each measured.

use airglow::fog::bench::{Ray, settings};
use airglow::fog::{Bench, Light, Medium, Phase, Preset};
use glam::DVec3;

use super::evaluators::{DEFAULT, Measurement};
use super::random::{self, Draw, Range};
use crate::failure::{Failure, Outcome};
use crate::report::interleave::paired;
use crate::report::model::{Curve, Distribution, Number, Point};

/// Rays of a dispatch and of its reference.
const BATCH: usize = 1 << 17;

impl Measurement<'_> {
    /// The pass's own functions on random rays, against quadrature.
    pub fn precision(&self) -> Outcome<Vec<Number>> {
        let draws = random::draws(&Range::WHOLE, self.effort.rays)?;
        let mut numbers = Vec::new();
        for (preset, name) in [(Preset::Reference, "reference"), (Preset::Default, "default")] {
            let found = self.pass_on(&draws, preset)?;
            let Distribution { median, p99, largest, below, bad } = found;
            let exact = preset == Preset::Reference;
            let holds = bad == 0 && (!exact || (p99 <= 1e-5 && largest <= 1e-3 && below <= 1e-36));
            let asked = match exact {
                true => {
                    "p99 at most 1e-5, largest at most 1e-3; below 1e-30 within 1e-36; all finite, none negative"
                }
                false => "all finite, none negative",
            };
            numbers.push(Number {
                what: format!("preset {name}, relative error over {} random rays on the device", draws.len()),
                asked: asked.to_owned(),
                measured: format!(
                    "median {median:.1e}, p99 {p99:.1e}, largest {largest:.1e}; below 1e-30 within {below:.1e}; {bad} \
                     not finite or negative"
                ),
                holds,
            });
        }
        Ok(numbers)
    }

    fn pass_on(&self, draws: &[Draw], preset: Preset) -> Outcome<Distribution> {
        let run = self.device.bench();
        let bench = Bench { context: self.device.context(), run: &run };
        let mut values = Vec::with_capacity(draws.len());
        for batch in draws.chunks(BATCH) {
            let rays: Vec<Ray> = batch.iter().map(ray).collect();
            let Some(first) = rays.first() else { continue };
            let airlight = bench.airlight(&settings(&first.medium, preset), &rays).map_err(Failure::work)?;
            // The pass multiplies with scattering, which is the extinction here, and 1 / (4 pi).
            let integral = |(draw, [red, ..]): (&Draw, [f32; 3])| {
                f64::from(red) * 4.0 * std::f64::consts::PI / draw.extinction
            };
            values.extend(batch.iter().zip(airlight).map(integral));
        }
        random::distribution(draws, values)
    }
}

/// A draw for the pass: a light of 1 W/sr a metre ahead, in a medium that absorbs nothing.
fn ray(draw: &Draw) -> Ray {
    let (sine, cosine) = draw.gamma.sin_cos();
    Ray {
        eye: DVec3::ZERO,
        medium: Medium {
            extinction: [draw.extinction; 3],
            albedo: [1.0; 3],
            phase: Phase::Isotropic,
            thinning: None,
        },
        light: Light::point(DVec3::new(sine, 0.0, cosine), [1.0; 3]),
        direction: DVec3::Z,
        distance: draw.extent,
    }
}

/// The evaluator's time against its rivals', from curves measured in turn.
pub fn times(whole: &Curve, of_table: &Curve) -> Outcome<Vec<Number>> {
    let mut numbers = Vec::new();
    let chosen = named(whole, &DEFAULT.to_string())?;
    let p99 = |point: &Point| point.distribution.map_or(f64::INFINITY, |found| found.p99);
    let marches = whole.points.iter().filter(|point| point.setting.starts_with("march"));
    let crossed = marches.clone().find(|march| p99(march) <= 1e-2).or(marches.clone().next_back());
    if let Some(march) = crossed {
        let ratio = paired(march, chosen).map_err(Failure::work)?;
        let crosses = p99(march) <= 1e-2;
        let not = if crosses { "" } else { " (the longest measured: it does not get there)" };
        numbers.push(Number {
            what: "time of a uniform march of p99 1e-2, over that of the default".to_owned(),
            asked: "at least 8".to_owned(),
            measured: format!(
                "{}, p99 {:.1e}{not}: {:.0} times ({:.0} to {:.0}); the default's p99 is {:.1e}",
                march.setting,
                p99(march),
                ratio.ratio,
                ratio.interval[0],
                ratio.interval[1],
                p99(chosen)
            ),
            holds: ratio.interval[0] >= 8.0,
        });
    }
    let table = p99(named(of_table, "table 64")?);
    for (curve, error, most, what) in
        [(of_table, table, 1.0, "the 64 x 64 table's own p99, in its domain"), (whole, 1e-5, 4.0, "p99 1e-5")]
    {
        let mut ours = curve.points.iter().filter(|point| point.setting.starts_with("taps"));
        let Some(point) = ours.find(|point| p99(point) <= error) else { continue };
        for rival in ["two fetches of 64", "table 64"] {
            let ratio = paired(point, named(curve, rival)?).map_err(Failure::work)?;
            numbers.push(Number {
                what: format!("time at {what} ({error:.1e}), over that of {rival}"),
                asked: format!("at most {most}"),
                measured: format!(
                    "{}, p99 {:.1e}: {:.2} times ({:.2} to {:.2})",
                    point.setting,
                    p99(point),
                    ratio.ratio,
                    ratio.interval[0],
                    ratio.interval[1]
                ),
                holds: ratio.ratio <= most,
            });
        }
    }
    Ok(numbers)
}

/// Cost by lights, and without a medium.
pub fn lights(curve: &Curve) -> Vec<Number> {
    let median = |point: &Point| point.time().map_or(f64::NAN, |time| time.median);
    let [.., few, many, clear] = curve.points.as_slice() else { return Vec::new() };
    let growth = median(many) / median(few);
    vec![
        Number {
            what: format!("time of {} over that of {}", many.setting, few.setting),
            asked: "2: linear".to_owned(),
            measured: format!("{growth:.2}"),
            holds: (growth - 2.0).abs() < 0.3,
        },
        Number {
            what: format!("draws of the pass, {}", clear.setting),
            asked: "0".to_owned(),
            measured: format!("{} draws, {:.4} ms", clear.counts.draws, median(clear)),
            holds: clear.counts.draws == 0,
        },
    ]
}

/// The default's error on a picture.
pub fn seen(preset: &Curve) -> Vec<Number> {
    let error = |point: &Point| Some((point.setting.clone(), point.error.setting?));
    let numbers = preset.points.iter().filter_map(error);
    numbers
        .map(|(name, error)| Number {
            what: format!("preset {name} on the picture, largest error"),
            asked: "at most 1 half step of 8 bits".to_owned(),
            measured: format!("{error:.2e} half steps"),
            holds: error <= 1.0,
        })
        .collect()
}

fn named<'a>(curve: &'a Curve, setting: &str) -> Outcome<&'a Point> {
    let found = curve.points.iter().find(|point| point.setting == setting);
    found.ok_or_else(|| Failure::work(format!("the curve of {} lacks {setting}", curve.knob)))
}
