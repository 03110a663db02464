//! Extreme meshes: one vertex, two million, every ray blocked, the first and the last order.

use glam::DQuat;

use super::{Outcome, coefficients};
use crate::bench::{Bench, Case, CaseLight};
use crate::relight::Relight;
use crate::settings::{Settings, Storage};
use crate::{RelightError, reference};

/// Extreme meshes under one light.
pub(super) fn cases(bench: &Bench<'_>, large: bool) -> Result<Vec<Outcome>, RelightError> {
    let f32 = |order| Settings { order, ..Settings::default() };
    let f16 = |order| Settings { storage: Storage::F16, ..f32(order) };
    let mut outcomes = vec![
        mesh(bench, "every ray blocked", f32(4), 100, true)?,
        mesh(bench, "one vertex", f32(4), 1, false)?,
        mesh(bench, "one vertex", f16(4), 1, false)?,
        mesh(bench, "the lowest order", f32(1), 1000, false)?,
        mesh(bench, "the highest order", f32(6), 1000, false)?,
        mesh(bench, "the highest order", f16(6), 1000, false)?,
    ];
    if large {
        outcomes.push(mesh(bench, "two million vertices in chunks", f16(6), 2_000_000, false)?);
    }
    Ok(outcomes)
}

/// The worst vertex of a mesh: |error| / (|t| |l|), or the largest colour where every ray is blocked.
fn mesh(
    bench: &Bench<'_>,
    name: &str,
    settings: Settings,
    vertices: u32,
    blocked: bool,
) -> Result<Outcome, RelightError> {
    let count = settings.coefficients();
    let value = |i: usize| if blocked { 0.0 } else { (i % 2039) as f32 / 2039.0 - 0.4 };
    let vectors: Vec<f32> = (0..count * vertices as usize).map(value).collect();
    let light: Vec<[f32; 3]> =
        coefficients(settings.order).into_iter().map(|l| [l as f32, 1.0, 0.5]).collect();
    let wide: Vec<[f64; 3]> = light.iter().map(|rgb| rgb.map(f64::from)).collect();
    let turn = DQuat::from_xyzw(0.1, -0.7, 0.5, 0.5);
    let turned = reference::light(settings.order, &wide, turn, DQuat::IDENTITY)?;
    let mut relight = Relight::new(bench.context, settings)?;
    let mesh = relight.add_mesh(bench.context, name, vertices, Some(&vectors))?;
    let light = CaseLight::Uniform(&light, turn);
    let colours = bench.results(&mut relight, &Case::new(light, mesh))?;
    let light_length = super::length(turned.as_flattened());
    let (mut worst, mut result, mut truth) = (-1.0, [0.0; 3], [0.0; 3]);
    for (vector, colour) in vectors.chunks_exact(count).zip(colours.chunks_exact(4)) {
        let vector: Vec<f64> = vector.iter().map(|t| f64::from(*t)).collect();
        let expected = reference::colour(&vector, &turned);
        let scale = if blocked { 1.0 } else { super::length(&vector) * light_length };
        for (actual, expected_channel) in colour.iter().zip(expected) {
            let error = (f64::from(*actual) - expected_channel).abs() / scale;
            // A NaN is worse than anything.
            if error.is_nan() || error > worst {
                worst = if error.is_nan() { f64::INFINITY } else { error };
                result = [0, 1, 2].map(|i| f64::from(colour[i]));
                truth = expected;
            }
        }
    }
    let bound = match (blocked, settings.storage) {
        (true, _) => 0.0,
        (false, Storage::F32) => 1e-5,
        (false, Storage::F16) => 1e-3,
    };
    Ok(Outcome {
        name: format!("vertices: {name}, order {}, {:?}", settings.order, settings.storage),
        input: format!("{vertices} vertices in chunks of at most {}", relight.chunk_vertices),
        result: format!("{result:?} at the worst vertex"),
        truth: format!("{truth:?}"),
        error: worst,
        bound,
        reproduce: "airglow stability relight".to_owned(),
    })
}
