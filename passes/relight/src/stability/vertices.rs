//! Extreme meshes: one vertex, two million, every ray blocked, the first and the last order; normals of all lengths.

use glam::{DQuat, DVec3};

use super::{Outcome, Reproduce, Selection, coefficients, number};
use crate::bench::{Bench, Case, CaseLight};
use crate::relight::Relight;
use crate::rotation::Orientation;
use crate::settings::{Settings, Storage};
use crate::{RelightError, reference};

/// Extreme meshes under one light, those that are selected.
pub(super) fn cases(bench: &Bench<'_>, selection: &Selection<'_>) -> Result<Vec<Outcome>, RelightError> {
    let f32 = |order| Settings { order, ..Settings::default() };
    let f16 = |order| Settings { storage: Storage::F16, ..f32(order) };
    // The last number is how large the vectors are.
    let mut meshes = vec![
        ("every ray blocked", f32(4), 100, 0.0),
        ("next to every ray blocked", f16(4), 1000, 1e-4),
        ("one vertex", f32(4), 1, 1.0),
        ("one vertex", f16(4), 1, 1.0),
        ("the lowest order", f32(1), 1000, 1.0),
        ("the highest order", f32(6), 1000, 1.0),
        ("the highest order", f16(6), 1000, 1.0),
    ];
    if selection.large {
        meshes.push(("two million vertices in chunks", f16(6), 2_000_000, 1.0));
    }
    let mut outcomes = Vec::new();
    for (name, settings, vertices, seen) in meshes {
        let name = format!("vertices: {name}, order {}, {:?}", settings.order, settings.storage);
        if selection.has(&name) {
            outcomes.push(mesh(bench, name, settings, vertices, seen)?);
        }
    }
    if selection.has(NORMALS) {
        outcomes.push(normals(bench)?);
    }
    Ok(outcomes)
}

const NORMALS: &str = "normals: of length 1e-30 to 1e30, and zero, order 6";

/// The worst vertex of a mesh: |error| / (|t| |l|), or the largest colour where nothing is `seen`.
fn mesh(
    bench: &Bench<'_>,
    name: String,
    settings: Settings,
    vertices: u32,
    seen: f32,
) -> Result<Outcome, RelightError> {
    let count = settings.coefficients();
    let value = |i: usize| seen * ((i % 2039) as f32 / 2039.0 - 0.4);
    let vectors: Vec<f32> = (0..count * vertices as usize).map(value).collect();
    let light: Vec<[f32; 3]> =
        coefficients(settings.order).into_iter().map(|l| [l as f32, 1.0, 0.5]).collect();
    let wide: Vec<[f64; 3]> = light.iter().map(|rgb| rgb.map(f64::from)).collect();
    let turn = DQuat::from_xyzw(0.1, -0.7, 0.5, 0.5);
    let turned = reference::light(settings.order, &wide, turn, DQuat::IDENTITY)?;
    let mut relight = Relight::new(bench.context, settings)?;
    let mesh = relight.add_mesh(bench.context, &name, vertices, Some(&vectors))?;
    let light = CaseLight::Uniform(&light, turn);
    let colours = bench.results(&mut relight, &Case::new(light, mesh))?;
    let vectors = vectors.chunks_exact(count).map(|vector| vector.iter().map(|t| f64::from(*t)).collect());
    let (worst, result, truth) = worst(vectors, &turned, &colours);
    let bound = match settings.storage {
        _ if seen == 0.0 => 0.0,
        Storage::F32 => 1e-5,
        Storage::F16 => 1e-3,
    };
    Ok(Outcome {
        name,
        input: format!("{vertices} vertices in chunks of at most {}", relight.chunk_vertices),
        result: format!("worst channel {}", number(result)),
        truth: number(truth),
        error: worst,
        bound,
        reproduce: Reproduce::Case,
    })
}

/// Transfer from normals of length 1e-30 to 1e30 in a mirrored instance, and from a zero normal.
fn normals(bench: &Bench<'_>) -> Result<Outcome, RelightError> {
    let settings = Settings { order: 6, normals: true, ..Settings::default() };
    let direction = |i: i32| DVec3::new(0.1 * f64::from(i), 1.0, -0.7).normalize();
    let length = |i: i32| if i == 0 { 0.0 } else { 10f64.powi(i) };
    let normals: Vec<[f32; 3]> =
        (-30..=30).map(|i| (direction(i) * length(i)).as_vec3().to_array()).collect();
    let light: Vec<[f32; 3]> = coefficients(6).into_iter().map(|l| [l as f32, 1.0, 0.5]).collect();
    let wide: Vec<[f64; 3]> = light.iter().map(|rgb| rgb.map(f64::from)).collect();
    let turn = DQuat::from_xyzw(0.1, -0.7, 0.5, 0.5);
    let orientation = Orientation { rotation: DQuat::from_rotation_z(2.0), inverted: true };
    let turned = reference::light(6, &wide, turn, orientation)?;
    let mut relight = Relight::new(bench.context, settings)?;
    let mesh = relight.add_mesh(bench.context, "normals", normals.len() as u32, None)?;
    let light = CaseLight::Uniform(&light, turn);
    let case = Case { orientation, normals: Some(&normals), ..Case::new(light, mesh) };
    let colours = bench.results(&mut relight, &case)?;
    let vectors = normals.iter().map(|n| reference::unshadowed(6, DVec3::from_array(n.map(f64::from))));
    let (error, result, truth) =
        worst(vectors.collect::<Result<Vec<_>, _>>()?.into_iter(), &turned, &colours);
    Ok(Outcome {
        name: NORMALS.to_owned(),
        input: format!("{} vertices of a mirrored instance", normals.len()),
        result: format!("worst channel {}", number(result)),
        truth: number(truth),
        error,
        bound: 1e-5,
        reproduce: Reproduce::Case,
    })
}

/// The error |error| / (|t| |l|) of the worst channel of a vertex, its value and the truth; the value itself where t
/// is zero.
fn worst(vectors: impl Iterator<Item = Vec<f64>>, light: &[[f64; 3]], colours: &[f32]) -> (f64, f64, f64) {
    let light_length = super::length(light.as_flattened());
    let (mut worst, mut result, mut truth) = (-1.0, 0.0, 0.0);
    for (vector, colour) in vectors.zip(colours.chunks_exact(4)) {
        let expected = reference::colour(&vector, light);
        let scale = match super::length(&vector) * light_length {
            0.0 => 1.0,
            scale => scale,
        };
        for (actual, expected_channel) in colour.iter().zip(expected) {
            let error = (f64::from(*actual) - expected_channel).abs() / scale;
            // A NaN is worse than anything.
            if error.is_nan() || error > worst {
                worst = if error.is_nan() { f64::INFINITY } else { error };
                result = f64::from(*actual);
                truth = expected_channel;
            }
        }
    }
    (worst, result, truth)
}
