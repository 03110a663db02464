//! Extreme environments: one texel, one row, one column, peaks where the map is singular, what is not finite.

use super::{Map, Outcome, Reproduce, Selection};
use crate::RelightError;
use crate::bench::Bench;
use crate::eval::{Evaluated, environment_sh};

/// Projects a map: 3 values for each coefficient. What is wrong with the map is the inner error.
pub(super) fn project(
    bench: &Bench<'_>,
    order: usize,
    map: &Map,
) -> Result<Result<Evaluated, RelightError>, RelightError> {
    let found = match environment_sh(bench, &[order], &map.texels()) {
        Ok(rows) => rows.into_iter().next().unwrap_or(Err(RelightError::Order { order })),
        Err(error) => Err(error),
    };
    match found {
        Err(RelightError::Gpu(error)) => Err(RelightError::Gpu(error)),
        other => {
            Ok(other.map(|row| Evaluated { values: row.values.concat(), reference: row.reference.concat() }))
        }
    }
}

/// Every extreme environment that is selected.
pub(super) fn cases(bench: &Bench<'_>, selection: &Selection<'_>) -> Result<Vec<Outcome>, RelightError> {
    // Directions of the last three: the pole, the seam behind the viewer, and the edge between +X and +Z of a cube.
    let maps = [
        ("one texel", 1, 1, 1.0, None),
        ("one column of 8192 texels", 1, 8192, 1.0, None),
        ("one row of 8192 texels", 8192, 1, 1.0, None),
        ("all zeros", 64, 32, 0.0, None),
        ("one texel of 1e5 at a pole", 64, 32, 0.01, Some((10, 0))),
        ("one texel of 1e5 at the seam", 64, 32, 0.01, Some((0, 16))),
        ("one texel of 1e5 at a cube edge", 64, 32, 0.01, Some((56, 16))),
    ];
    let mut outcomes = Vec::new();
    for (name, width, height, level, peak) in maps {
        for order in [1, 6] {
            let name = format!("environment: {name}, order {order}");
            if !selection.has(&name) {
                continue;
            }
            let map = ramp(width, height, level, peak);
            let input = format!("{width} x {height} texels of {level} to {}", 2.0 * level);
            let found = project(bench, order, &map)?;
            let reproduce = Reproduce::Environment { order, map };
            outcomes.push(Outcome::of_row(name, input, found, false, reproduce));
        }
    }
    outcomes.extend(not_finite(bench, selection)?);
    Ok(outcomes)
}

/// A gentle ramp, so that no coefficient is zero by symmetry, and a peak.
fn ramp(width: u32, height: u32, level: f32, peak: Option<(u32, u32)>) -> Map {
    let mut map = Map::new(width, height, level);
    for (i, texel) in map.rgb.iter_mut().enumerate() {
        *texel = texel.map(|value| value * (1.0 + (i % 97) as f32 / 97.0));
    }
    if let Some((x, y)) = peak {
        map.rgb[(y * width + x) as usize] = [1e5; 3];
    }
    map
}

fn not_finite(bench: &Bench<'_>, selection: &Selection<'_>) -> Result<Option<Outcome>, RelightError> {
    let name = "environment: NaN and infinite texels".to_owned();
    if !selection.has(&name) {
        return Ok(None);
    }
    let mut map = Map::new(64, 32, 1.0);
    map.rgb[7][0] = f32::NAN;
    map.rgb[77][1] = f32::INFINITY;
    map.rgb[777][2] = f32::NAN;
    let input = "64 x 32 texels, three of them not finite, the first at 7".to_owned();
    let found = project(bench, 4, &map)?;
    let counted = matches!(found, Err(RelightError::Values { count: 3, first: 7, .. }));
    let outcome = Outcome::of_row(name, input, found, true, Reproduce::Environment { order: 4, map });
    let error = if counted { 0.0 } else { f64::INFINITY };
    Ok(Some(Outcome { truth: "refused, with the count 3".to_owned(), error, bound: 0.0, ..outcome }))
}
