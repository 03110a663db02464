//! The pass's knobs on the ground of a scene: time, and error against rays.

use airglow::shadow::bench::SphereKernel;
use airglow::shadow::{MAX_ORDER, MIN_ORDER, Settings};

use super::shading::Shading;
use super::{Measurement, Rival};
use crate::failure::{Failure, Outcome};
use crate::report::interleave::compare;
use crate::report::model::{Choice, Curve, Errors, Point};

/// All knobs.
pub fn curves(measurement: &Measurement<'_>, shading: &Shading) -> Outcome<Vec<Curve>> {
    let default = Settings { normals: true, ..Settings::default() };
    let named = |values: &[f64], set: fn(Settings, f64) -> Settings| {
        values.iter().map(|value| (format!("{value}"), set(default, *value))).collect::<Vec<_>>()
    };
    let orders =
        (MIN_ORDER..=MAX_ORDER).map(|order| (format!("order {order}"), Settings { order, ..default }));
    let clips = named(&[0.002, 0.01, 0.02, 0.05, 0.1, 0.3], |settings, clip| Settings { clip, ..settings });
    let reaches = named(&[0.0, 1e-5, 1e-4, 1e-3, 1e-2], |settings, reach| Settings { reach, ..settings });
    let cuts = named(&[0.0, 0.003, 0.01, 0.03, 0.1, 0.3], |settings, cut| Settings { cut, ..settings });
    let windows = named(&[0.0, 0.002, 0.005, 0.01, 0.03], |settings, window| Settings { window, ..settings });
    let clamps = [true, false].map(|clamp| (format!("{clamp}"), Settings { clamp, ..default }));
    let sweep = |knob, question, settings: Vec<_>, chosen: &str| {
        curve(measurement, shading, knob, question, settings, chosen)
    };
    let mut curves = vec![
        sweep("order", "How many bands do soft shadows need?", orders.collect(), "order 4")?,
        sweep(
            "clip",
            "Where are the eigenvalues of a visibility clipped before the logarithm?",
            clips,
            "0.02",
        )?,
        sweep("reach", "Which spheres may a cluster of receivers leave out?", reaches, "0.00001")?,
        sweep("cut", "When may a node of the hierarchy stand for what it holds?", cuts, "0.03")?,
        sweep("window", "Does deringing pay?", windows, "0")?,
        sweep("clamp", "Is a result made one that a visibility can be?", clamps.into(), "true")?,
    ];
    // What every order is to be seen against.
    if let Some(curve) = curves.first_mut() {
        let error = shading.error(MAX_ORDER, None)?;
        curve.points.push(Point {
            setting: "no shadow, order 6".to_owned(),
            milliseconds: Vec::new(),
            memory: 0,
            counts: Default::default(),
            error: Errors { model: Some(error), ..Errors::default() },
            distribution: None,
        });
    }
    Ok(curves)
}

pub(super) fn curve(
    measurement: &Measurement<'_>,
    shading: &Shading,
    knob: &str,
    question: &str,
    settings: Vec<(String, Settings)>,
    chosen: &str,
) -> Outcome<Curve> {
    let rival = |(name, settings): (String, Settings)| Rival { name, settings, kernel: SphereKernel::Pass };
    let rivals: Vec<Rival> = settings.into_iter().map(rival).collect();
    let (positions, normals) = (&shading.positions, Some(&shading.normals[..]));
    let timed = measurement
        .interleaved(&rivals, positions, normals, |rival| shading.blockers(rival.settings.order))?;
    let mut points = Vec::new();
    for ((mut point, values), rival) in timed.into_iter().zip(&rivals) {
        point.error.model = Some(shading.error(rival.settings.order, Some(&values))?);
        points.push(point);
    }
    Ok(Curve {
        knob: knob.to_owned(),
        question: question.to_owned(),
        norm: "root mean square of the ground's colour over the truth's, by rays to the figures' triangles"
            .to_owned(),
        timed: "one frame of the pass over the ground of the scene".to_owned(),
        comparisons: compare(&points, chosen).map_err(Failure::work)?,
        points,
        chosen: Some(Choice { setting: chosen.to_owned(), reason: "the pass's default".to_owned() }),
    })
}
