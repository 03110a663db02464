//! What a material needs to be kept of a map: measured, before anything is built.

use airglow_graph::LeftOut;
use airglow_math::sequence::{sobol, uniform_hemisphere};
use airglow_math::statistics::relative_l2;
use glam::DVec3;

use crate::NormalsError;
use crate::brdf::{Brdf, Directions};
use crate::fit::FitSettings;
use crate::map::{NormalMap, Sample};
use crate::method::{Method, below};
use crate::ordered::Ordered;
use crate::{reference, shade};

/// Texels looked at, from level 2 to level 5 in turn.
const TEXELS: u32 = 24;
const LEVELS: std::ops::RangeInclusive<usize> = 2..=5;
/// Lights and views of a texel, every other near the highlight.
const ROWS: u32 = 12;
/// What is tried, in the order of what it takes: bytes, then time.
const TRIED: [Method; 7] = [
    Method::Lobes(1),
    Method::Lobes(2),
    Method::Harmonics(3),
    Method::Lobes(4),
    Method::Harmonics(4),
    Method::Lobes(6),
    Method::Taps,
];
/// What is built unless something else was chosen.
const DEFAULT: Method = Method::Lobes(4);

/// What is kept, and why.
#[derive(Clone, Debug)]
pub struct Choice {
    /// The method that takes least of those within the target; the best where none is.
    pub method: Method,
    /// Its relative L2 error.
    pub error: f64,
    /// Whether that is within the target.
    pub within: bool,
    /// What the default of four lobes would have kept beyond it; none where it takes as much or more. For the plan.
    pub left_out: Option<LeftOut>,
}

/// A texel that is looked at: lights and views, and the truth under each.
struct Looked {
    texel: [usize; 3],
    rows: Vec<Directions>,
    truths: Vec<f64>,
}

/// Chooses for a map and a material, by the error over texels, lights and views spread evenly. Lobes are measured in the
/// order that a built texture has them in. The same input gives the same choice.
///
/// # Errors
/// [`NormalsError::Range`] for a material or a target out of range.
pub fn choose(map: &NormalMap, brdf: Brdf, target: f64) -> Result<Choice, NormalsError> {
    brdf.check()?;
    if !(target > 0.0 && target <= 1.0) {
        return Err(NormalsError::Range { what: "the error aimed at", value: target, range: "above 0 to 1" });
    }
    let looked = (0..TEXELS).map(|i| Looked::new(map, brdf, i)).collect::<Result<Vec<_>, _>>()?;
    let truths: Vec<f64> = looked.iter().flat_map(|looked| looked.truths.iter().copied()).collect();
    let mut best: Option<(Method, f64)> = None;
    for method in TRIED {
        // Nothing that reflects anywhere needs nothing.
        let error = relative_l2(&radiances(map, method, brdf, &looked)?, &truths).unwrap_or(0.0);
        if best.is_none_or(|(_, least)| error < least) {
            best = Some((method, error));
        }
        if error <= target {
            break;
        }
    }
    let (method, error) = best.unwrap_or((DEFAULT, f64::INFINITY));
    Ok(Choice { method, error, within: error <= target, left_out: left_out(map, method, error, target) })
}

impl Looked {
    /// The texel of a number.
    fn new(map: &NormalMap, brdf: Brdf, i: u32) -> Result<Self, NormalsError> {
        let level = (LEVELS.start() + i as usize % LEVELS.count()).min(map.levels() - 1);
        let [u, v] = sobol(i, 5);
        let place = |axis: usize, at: f64| (at * map.size(level)[axis] as f64) as usize;
        let texel = [level, place(0, u), place(1, v)];
        let footprint = map.footprint(level, texel[1], texel[2])?;
        let (mut rows, mut truths) = (Vec::new(), Vec::new());
        for row in 0..ROWS {
            if let Some(directions) = directions(&footprint, i * ROWS + row, brdf)? {
                truths.push(reference::radiance(&footprint, brdf, directions));
                rows.push(directions);
            }
        }
        Ok(Self { texel, rows, truths })
    }
}

/// What a method makes of all rows.
fn radiances(
    map: &NormalMap,
    method: Method,
    brdf: Brdf,
    looked: &[Looked],
) -> Result<Vec<f64>, NormalsError> {
    let lobes = if let Method::Lobes(lobes) = method { lobes } else { 4 };
    let mut ordered = Ordered::new(map, FitSettings { lobes, ..Default::default() });
    let mut values = Vec::new();
    for Looked { texel, rows, .. } in looked {
        let texels = match method {
            Method::Lobes(_) => vec![*texel],
            Method::Taps => below(map, *texel).to_vec(),
            _ => {
                let found = rows.iter().map(|&directions| method.radiance(map, *texel, brdf, directions));
                values.extend(found.collect::<Result<Vec<_>, _>>()?);
                continue;
            }
        };
        let mixtures =
            texels.into_iter().map(|texel| ordered.mixture(texel)).collect::<Result<Vec<_>, _>>()?;
        values.extend(rows.iter().map(|&directions| {
            let sum: f64 = mixtures.iter().map(|mixture| shade::radiance(mixture, brdf, directions)).sum();
            sum / mixtures.len() as f64
        }));
    }
    Ok(values)
}

/// A light from above, and a view: from above too, or along the mirror of a normal give or take the reflection's width.
fn directions(footprint: &[Sample], index: u32, brdf: Brdf) -> Result<Option<Directions>, NormalsError> {
    let (light, mut view) = (uniform_hemisphere(sobol(index, 11)), uniform_hemisphere(sobol(index, 12)));
    if index.is_multiple_of(2) && !footprint.is_empty() {
        let width = match brdf {
            Brdf::Lambert => 0.5,
            Brdf::BlinnPhong { exponent } => 1.0 / exponent.max(1.0).sqrt(),
            Brdf::Ggx { alpha } => alpha,
        };
        let ([a, b], [c, d]) = (sobol(index, 13), sobol(index, 14));
        let normal = footprint[((a * footprint.len() as f64) as usize).min(footprint.len() - 1)].mean;
        let half = (normal + width * DVec3::new(b - 0.5, c - 0.5, d - 0.5)).try_normalize().unwrap_or(normal);
        view = 2.0 * light.dot(half) * half - light;
    }
    if view.z > 0.02 && light.z > 0.02 { Directions::new(light, view).map(Some) } else { Ok(None) }
}

fn left_out(map: &NormalMap, method: Method, error: f64, target: f64) -> Option<LeftOut> {
    let numbers = DEFAULT.numbers().checked_sub(method.numbers()).filter(|&numbers| numbers > 0)?;
    let texels: usize = (1..map.levels()).map(|level| map.size(level).iter().product::<usize>()).sum();
    Some(LeftOut {
        what: format!("normals {DEFAULT} beyond {method}"),
        why: format!("{method} is within {:.1} % of {:.1} %", 100.0 * error, 100.0 * target),
        bytes: (2 * numbers * texels) as u64,
        time: None,
        would_return: "a glossier material, or a smaller error aimed at".to_owned(),
    })
    .filter(|_| error <= target)
}
