//! How the error of the thesis's table falls with its size, in the thesis's own measure: Sun 2008, figure 3.6.

use std::f64::consts::{FRAC_PI_2, PI};

use airglow::fog::Phase;
use airglow::fog::reference::airlight::{Sight, airlight};
use airglow::fog::reference::table::{Filter, Table};
use airglow_math::statistics::percentiles;

use super::random::Range;
use crate::failure::{Failure, Outcome};
use crate::report::model::{Curve, Distribution, Errors, Point};

/// Optical distances, lengths of the ray and angles: together 40 000 inputs, as many as the thesis has.
const COUNTS: [usize; 3] = [20, 20, 100];

/// All angles of one optical distance and length.
struct Hemisphere {
    extinction: f64,
    extent: f64,
    /// The truth at each angle.
    truths: Vec<f64>,
    /// Its mean over the hemisphere about the light.
    mean: f64,
}

/// The tables of a curve by their size; times and bytes are the curve's.
pub fn curve(of_table: &Curve) -> Outcome<Curve> {
    let hemispheres = hemispheres()?;
    let tables = of_table.points.iter().filter(|point| point.setting.starts_with("table"));
    let points = tables.map(|point| {
        let (size, filter) = table(&point.setting)?;
        let errors = errors(&hemispheres, &Table::new(size, 0).map_err(Failure::work)?, filter);
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        let at = percentiles(&errors, &[50.0, 99.0, 100.0]).map_err(Failure::work)?;
        let distribution = Distribution { median: at[0], p99: at[1], largest: at[2], below: 0.0, bad: 0 };
        let error = Errors { setting: Some(mean), ..Errors::default() };
        Ok(Point { error, distribution: Some(distribution), ..point.clone() })
    });
    Ok(Curve {
        knob: "size of the table (figure 3.6)".to_owned(),
        question: "How does the error of the table of F(u, v) fall with its size, nearest and bilinear, where it \
                   neither ends nor overflows?"
            .to_owned(),
        norm: "setting: the mean, over 40 000 inputs, of the error over the mean airlight of the hemisphere about the \
               light, as in the thesis; that hides rays far from the light, whose own relative errors are in the curve \
               before this one"
            .to_owned(),
        timed: of_table.timed.clone(),
        points: points.collect::<Outcome<_>>()?,
        chosen: None,
        comparisons: Vec::new(),
    })
}

/// The size and the filter that a setting names.
fn table(setting: &str) -> Outcome<(usize, Filter)> {
    let filter = if setting.ends_with("nearest") { Filter::Nearest } else { Filter::Bilinear };
    let size = setting.split_whitespace().nth(1).and_then(|size| size.parse().ok());
    Ok((size.ok_or_else(|| Failure::work(format!("{setting} names no size")))?, filter))
}

/// The middle of place `at` of `count` in the range of angles.
fn angle(at: usize) -> f64 {
    let [low, high] = Range::OF_TABLE.gamma;
    low + (high - low) * (at as f64 + 0.5) / COUNTS[2] as f64
}

fn hemispheres() -> Outcome<Vec<Hemisphere>> {
    let between = |[low, high]: [f64; 2], at: usize, count: usize| {
        low * (high / low).powf((at as f64 + 0.5) / count as f64)
    };
    let mut all = Vec::with_capacity(COUNTS[0] * COUNTS[1]);
    for i in 0..COUNTS[0] * COUNTS[1] {
        let extinction = between(Range::OF_TABLE.optical, i % COUNTS[0], COUNTS[0]);
        let extent = between(Range::OF_TABLE.extent, i / COUNTS[0], COUNTS[1]);
        let truth = |at| {
            let sight = Sight::new(1.0, angle(at));
            let scattered =
                airlight(extinction, sight, 0.0, extent, Phase::Isotropic).map_err(Failure::work)?;
            Ok(4.0 * PI * scattered)
        };
        let truths = (0..COUNTS[2]).map(truth).collect::<Outcome<Vec<_>>>()?;
        let (mut sum, mut weight) = (0.0, 0.0);
        for (at, truth) in truths.iter().enumerate().filter(|(at, _)| angle(*at) < FRAC_PI_2) {
            sum += angle(at).sin() * truth;
            weight += angle(at).sin();
        }
        all.push(Hemisphere { extinction, extent, truths, mean: sum / weight });
    }
    Ok(all)
}

/// Over the mean of their hemispheres.
fn errors(hemispheres: &[Hemisphere], table: &Table, filter: Filter) -> Vec<f64> {
    let mut errors = Vec::with_capacity(COUNTS.iter().product());
    for Hemisphere { extinction, extent, truths, mean } in hemispheres {
        for (at, truth) in truths.iter().enumerate() {
            let found = table.airlight(*extinction as f32, 1.0, angle(at) as f32, *extent as f32, filter);
            errors.push((f64::from(found) - truth).abs() / mean);
        }
    }
    errors
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_of_64_errs_by_less_than_two_percent_as_the_thesis_says() {
        let hemispheres = hemispheres().unwrap();
        let mean = |size, filter| {
            let errors = errors(&hemispheres, &Table::new(size, 0).unwrap(), filter);
            errors.iter().sum::<f64>() / errors.len() as f64
        };
        let [coarse, bilinear] = [16, 64].map(|size| mean(size, Filter::Bilinear));
        let nearest = mean(64, Filter::Nearest);
        println!("16: {coarse:.1e}, 64: {bilinear:.1e}, nearest {nearest:.1e}");
        assert!(bilinear < 0.02 && bilinear < nearest && bilinear < coarse, "{coarse} {bilinear} {nearest}");
        assert_eq!(table("table 64 nearest").unwrap(), (64, Filter::Nearest));
        assert!(table("table").is_err());
    }
}
