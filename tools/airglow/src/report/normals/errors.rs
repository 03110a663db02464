//! Errors of every method, on the device, over random texels, lights and views.

use airglow::math::sequence::{sobol, uniform_hemisphere};
use airglow::math::statistics::relative_l2;
use airglow::normals::eval::{Evaluated, TexelRow, texels};
use airglow::normals::{Bench, Brdf, Method, NormalsError};
use glam::DVec3;

use super::workload::Map;
use crate::failure::{Failure, Outcome};
use crate::host::device::Device;

/// Lights and views of a texel.
const ROWS: u32 = 10;
const LEVELS: std::ops::RangeInclusive<usize> = 2..=7;

/// The relative L2 error of each method, for each material.
pub fn of_map(device: &Device<'_>, map: &Map, brdfs: &[Brdf], count: u32) -> Outcome<Vec<Vec<f64>>> {
    let run = device.bench();
    let bench = Bench { context: device.context(), run: &run };
    let mut counts = Vec::new();
    let mut rows = Vec::new();
    for &brdf in brdfs {
        let seen = seen(map, brdf, count)?;
        counts.push(seen.len());
        rows.extend(seen.iter().flat_map(|row| Method::ALL.map(|method| TexelRow { method, ..*row })));
    }
    let values = texels(&bench, &map.normals, &rows).map_err(Failure::work)?;
    let values =
        values.into_iter().collect::<Result<Vec<Evaluated>, NormalsError>>().map_err(Failure::work)?;
    let mut rows = values.chunks(Method::ALL.len());
    let of_brdf = |count| {
        let rows: Vec<&[Evaluated]> = rows.by_ref().take(count).collect();
        let of_method = |at: usize| {
            let (ours, truths): (Vec<f64>, Vec<f64>) =
                rows.iter().map(|row| (row[at].value, row[at].reference)).unzip();
            relative_l2(&ours, &truths).map_err(Failure::work)
        };
        (0..Method::ALL.len()).map(of_method).collect()
    };
    counts.into_iter().map(of_brdf).collect()
}

/// Texels, lights and views, half of them near the highlight; the same in every run.
fn seen(map: &Map, brdf: Brdf, count: u32) -> Outcome<Vec<TexelRow>> {
    let mut rows = Vec::new();
    for texel in 0..count {
        let level = (LEVELS.start() + texel as usize % LEVELS.count()).min(map.normals.levels() - 1);
        let [u, v] = sobol(texel, 21);
        let size = map.normals.size(level);
        let [x, y] = [(u * size[0] as f64) as usize, (v * size[1] as f64) as usize];
        let footprint = map.normals.footprint(level, x, y).map_err(Failure::work)?;
        for row in 0..ROWS {
            let index = texel * ROWS + row;
            let (light, mut view) =
                (uniform_hemisphere(sobol(index, 22)), uniform_hemisphere(sobol(index, 23)));
            if row % 2 == 0 {
                let ([a, b], [c, d]) = (sobol(index, 24), sobol(index, 25));
                let normal = footprint[((a * footprint.len() as f64) as usize).min(footprint.len() - 1)].mean;
                let half = (normal + width(brdf) * DVec3::new(b - 0.5, c - 0.5, d - 0.5)).normalize();
                view = 2.0 * light.dot(half) * half - light;
            }
            if light.z > 0.02 && view.z > 0.02 {
                rows.push(TexelRow { level, x, y, light, view, brdf, method: Method::Mip });
            }
        }
    }
    Ok(rows)
}

/// About how wide a reflection is, radians.
fn width(brdf: Brdf) -> f64 {
    match brdf {
        Brdf::Lambert => 0.5,
        Brdf::BlinnPhong { exponent } => 2.0 / exponent.sqrt(),
        Brdf::Ggx { alpha } => 1.4 * alpha,
    }
}
