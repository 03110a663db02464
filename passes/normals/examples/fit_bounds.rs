//! How near fitted lobes are to the best that as many lobes can do: fits of four lobes by other limits and more steps, and
//! beside them four lobes that least squares of the radiance itself found, which no build could afford.
//!
//! `cargo run -p airglow-normals --example fit_bounds` prints relative L2 errors at the exponents 50 and 200, on made and, where
//! there are any, on measured maps.

#![expect(clippy::unwrap_used, reason = "the maps are shared with the tests, whose helpers unwrap")]

#[path = "../tests/common/mod.rs"]
mod common;

use airglow_math::statistics::relative_l2;
use airglow_normals::vmf::{concentration, mean_length};
use airglow_normals::{
    Brdf, FitSettings, Mixture, NormalsError, Sample, WeightedLobe, fit, reference, shade,
};
use common::{Random, directions};
use glam::DVec3;

const TEXELS: usize = 20;
const ROWS: usize = 20;
/// What the search is for.
const EXPONENT: f64 = 200.0;
const TRIALS: usize = 1500;
const METHODS: [&str; 5] = ["4 lobes", "sharpest 200", "100 steps", "least squares at 200", "6 lobes"];

/// A lobe as the search moves it.
#[derive(Clone, Copy)]
struct Moving {
    weight: f64,
    axis: DVec3,
    variance: f64,
}

/// The square of the difference between two sums of Gaussians as wide as the reflection, but for what the normals alone
/// give: what a highlight at the exponent is off by, over all half vectors.
fn loss(lobes: &[Moving], footprint: &[Sample]) -> f64 {
    let width = 1.0 / EXPONENT;
    let overlap =
        |a: DVec3, b: DVec3, variance: f64| (-0.5 * (a - b).length_squared() / variance).exp() / variance;
    let mut sum = 0.0;
    for a in lobes {
        for b in lobes {
            sum += a.weight * b.weight * overlap(a.axis, b.axis, a.variance + b.variance + 2.0 * width);
        }
        for b in footprint {
            sum -= 2.0 * a.weight * b.weight * overlap(a.axis, b.mean, a.variance + 2.0 * width);
        }
    }
    sum
}

/// A mixture after random steps that each lower the loss.
fn refined(mixture: &Mixture, footprint: &[Sample], random: &mut Random) -> Result<Mixture, NormalsError> {
    let moving = |lobe: &WeightedLobe| Moving {
        weight: lobe.weight,
        axis: lobe.mean().normalize(),
        variance: 1.0 / concentration(lobe.mean().length()),
    };
    let mut best: Vec<Moving> =
        mixture.lobes().iter().filter(|lobe| lobe.weight > 1e-6).map(moving).collect();
    let mut least = loss(&best, footprint);
    for trial in 0..TRIALS {
        let step = 0.5_f64.powi((5 * trial / TRIALS) as i32);
        let mut next = best.clone();
        let (i, j) = (random.below(next.len()), random.below(next.len()));
        match random.below(3) {
            0 => {
                let reach = 0.3 * step * (next[i].variance + 1.0 / EXPONENT).sqrt();
                let offset = reach * DVec3::new(random.bell(), random.bell(), random.bell());
                next[i].axis = (next[i].axis + offset).normalize();
            }
            1 => next[i].variance = (next[i].variance * (step * random.bell()).exp()).max(1e-7),
            _ => {
                let moved = (0.3 * step * random.bell() * next[i].weight).min(0.9 * next[j].weight);
                next[i].weight += moved;
                next[j].weight -= moved;
            }
        }
        let found = loss(&next, footprint);
        if found < least {
            (least, best) = (found, next);
        }
    }
    let stored = |lobe: &Moving| {
        let length = mean_length(1.0 / lobe.variance);
        WeightedLobe { weight: lobe.weight, moment: lobe.weight * length * lobe.axis }
    };
    Mixture::new(best.iter().map(stored).collect())
}

fn main() -> Result<(), NormalsError> {
    let mut maps = vec![("grain", common::grain(256))];
    let measured = ["leather_1024", "ripples_1024"];
    maps.extend(measured.into_iter().filter_map(|name| Some((name, common::measured(name)?))));
    let brdfs = [50.0, EXPONENT].map(|exponent| Brdf::BlinnPhong { exponent });
    for (name, map) in &maps {
        let mut random = Random(11);
        let mut values = [const { [const { Vec::new() }; METHODS.len()] }; 2];
        let mut truths = [const { Vec::new() }; 2];
        for texel in 0..TEXELS {
            let level = 2 + texel % 5;
            let [width, height] = map.size(level);
            let footprint = map.footprint(level, random.below(width), random.below(height))?;
            let plain = FitSettings::default();
            let four = fit(&footprint, &plain)?;
            let mixtures = [
                four.clone(),
                fit(&footprint, &FitSettings { sharpest: EXPONENT, ..plain })?,
                fit(&footprint, &FitSettings { iterations: 100, ..plain })?,
                refined(&four, &footprint, &mut random)?,
                fit(&footprint, &FitSettings { lobes: 6, ..plain })?,
            ];
            for ((values, truths), brdf) in values.iter_mut().zip(&mut truths).zip(brdfs) {
                let Brdf::BlinnPhong { exponent } = brdf else { continue };
                for row in 0..ROWS {
                    let directions = directions(row, &footprint, 1.0 / exponent.sqrt(), &mut random);
                    truths.push(reference::radiance(&footprint, brdf, directions));
                    for (values, mixture) in values.iter_mut().zip(&mixtures) {
                        values.push(shade::radiance(mixture, brdf, directions));
                    }
                }
            }
        }
        for ((values, truths), brdf) in values.iter().zip(&truths).zip(brdfs) {
            let error = |values: &Vec<f64>| format!("{:.1} %", 100.0 * relative_l2(values, truths).unwrap());
            let errors: Vec<_> = METHODS
                .iter()
                .zip(values)
                .map(|(method, values)| format!("{method}: {}", error(values)))
                .collect();
            println!("{name}, {brdf:?}: {}", errors.join(", "));
        }
    }
    Ok(())
}
