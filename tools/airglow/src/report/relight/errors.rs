//! The three errors of a setting, on all vertices of the workload.

use airglow::relight::{Bench, Case, CaseLight, Relight, Settings, reference};
use airglow_math::statistics::relative_l2;
use glam::DQuat;

use super::truth::flat;
use super::vectors::truncate;
use super::workload::Workload;
use crate::failure::{Failure, Outcome};
use crate::report::model::Errors;

/// How errors are measured, and the floor of the model error, for the report.
pub fn norm(workload: &Workload) -> String {
    format!(
        "arithmetic: largest |error| / (|t| |l|) of any vertex and channel; setting and model: root mean square error \
         over root mean square colour, of all vertices and channels. The model column is above the truth's own noise, \
         {:.1e}, which is estimated from two independent halves of its rays and subtracted in quadrature",
        workload.truth.noise()
    )
}

/// The pass's colours of the workload's vertices with these settings and vectors of full order.
pub fn colours(
    bench: &Bench<'_>,
    settings: Settings,
    workload: &Workload,
    vectors: &[f32],
) -> Outcome<Vec<[f32; 3]>> {
    let order = settings.order;
    let vectors = truncate(vectors, order);
    let light: Vec<[f32; 3]> = workload.light_of(order).iter().map(|rgb| rgb.map(|c| c as f32)).collect();
    let mut relight = Relight::new(bench.context, settings).map_err(Failure::work)?;
    let count = workload.vertex_count as u32;
    let mesh = relight.add_mesh(bench.context, "workload", count, Some(&vectors)).map_err(Failure::work)?;
    let light = CaseLight::Uniform(&light, DQuat::IDENTITY);
    let values = bench.results(&mut relight, &Case::new(light, mesh)).map_err(Failure::work)?;
    Ok(values.as_chunks::<4>().0.iter().take(workload.vertex_count).map(|&[r, g, b, _]| [r, g, b]).collect())
}

/// Errors of `colours`, made with `order` and `vectors`, against f64, against the `converged` setting's colours, and
/// against the ray-traced truth.
pub fn of(
    colours: &[[f32; 3]],
    order: usize,
    vectors: &[f32],
    converged: &[[f32; 3]],
    workload: &Workload,
) -> Outcome<Errors> {
    Ok(Errors {
        arithmetic: Some(arithmetic(colours, order, vectors, workload)),
        setting: Some(relative_l2(&flat(colours), &flat(converged)).map_err(Failure::work)?),
        model: Some(workload.truth.error(colours)?),
        model_p95: Some(workload.truth.error_p95(colours)?),
    })
}

/// The largest |error| / (|t| |l|) of any vertex and channel against the f64 dot product of the same vectors.
pub fn arithmetic(colours: &[[f32; 3]], order: usize, vectors: &[f32], workload: &Workload) -> f64 {
    let light = workload.light_of(order);
    let light_norms = [0, 1, 2].map(|c| light.iter().map(|rgb| rgb[c] * rgb[c]).sum::<f64>().sqrt());
    let vectors = truncate(vectors, order);
    let mut worst = 0.0_f64;
    for (colour, vector) in colours.iter().zip(vectors.chunks_exact(order * order)) {
        let transfer: Vec<f64> = vector.iter().map(|&value| f64::from(value)).collect();
        let norm = transfer.iter().map(|value| value * value).sum::<f64>().sqrt();
        let truth = reference::colour(&transfer, light);
        for channel in 0..3 {
            let error = (f64::from(colour[channel]) - truth[channel]).abs();
            if error > 0.0 {
                worst = worst.max(error / (norm * light_norms[channel]));
            }
        }
    }
    worst
}
