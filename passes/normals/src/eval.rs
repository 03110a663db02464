//! The room's own GPU code on rows of parameters, beside the truth: chains are built and lobes shaded on the device.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::NormalsError;
use crate::bench::{Bench, LevelLobes, Row};
use crate::brdf::{Brdf, Directions};
use crate::fit::FitSettings;
use crate::map::NormalMap;
use crate::mixture::WeightedLobe;
use crate::reference;
use crate::settings::Settings;

/// Lobes of the default method.
const DEFAULT_LOBES: usize = 4;

/// A row of `normals`: a texel of a level under a light of irradiance 1.
#[derive(Clone, Copy, Debug)]
pub struct TexelRow {
    /// The level; 0 is the map.
    pub level: usize,
    /// The texel's column.
    pub x: usize,
    /// The texel's row.
    pub y: usize,
    /// Towards the light, of any length.
    pub light: DVec3,
    /// Towards the view, of any length.
    pub view: DVec3,
    /// The material.
    pub brdf: Brdf,
    /// Lobes of a texel: 1, 2, 4 or 6.
    pub lobes: usize,
}

/// What a row gave, 1/sr.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluated {
    /// The device's value, exactly.
    pub value: f64,
    /// The truth: the mean over the normals of level 0.
    pub reference: f64,
}

/// The lobes of a method, `default` or `vmf:J`.
///
/// # Errors
/// [`NormalsError::Method`].
pub fn lobes(method: &str) -> Result<usize, NormalsError> {
    match method {
        "default" => Ok(DEFAULT_LOBES),
        "vmf:1" => Ok(1),
        "vmf:2" => Ok(2),
        "vmf:4" => Ok(4),
        "vmf:6" => Ok(6),
        _ => Err(NormalsError::Method { method: method.to_owned() }),
    }
}

/// Runs the rows; a refused one says why, the others still run.
///
/// # Errors
/// As [`Bench::build`] and [`Bench::radiance`].
pub fn texels(
    bench: &Bench<'_>,
    map: &NormalMap,
    rows: &[TexelRow],
) -> Result<Vec<Result<Evaluated, NormalsError>>, NormalsError> {
    let mut results: Vec<Result<Evaluated, NormalsError>> = rows.iter().map(|row| row.truth(map)).collect();
    let mut places: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (place, _) in results.iter().enumerate().filter(|(_, result)| result.is_ok()) {
        places.entry(rows[place].lobes).or_default().push(place);
    }
    for (lobes, places) in places {
        let fit = FitSettings { lobes, ..Default::default() };
        let levels = bench.build(map, &Settings { fit, budget: Some(u64::MAX), ..Default::default() })?;
        let shaded = places.iter().map(|&place| rows[place].shaded(map, &levels));
        let shaded: Vec<Row> = shaded.collect::<Result<_, _>>()?;
        for (place, value) in places.into_iter().zip(bench.radiance(&shaded)?) {
            if let Ok(result) = &mut results[place] {
                result.value = value.into();
            }
        }
    }
    Ok(results)
}

impl TexelRow {
    /// Checks the row and gives it its truth.
    fn truth(&self, map: &NormalMap) -> Result<Evaluated, NormalsError> {
        self.brdf.check()?;
        lobes(&format!("vmf:{}", self.lobes))?;
        let directions = Directions::new(self.light, self.view)?;
        let footprint = map.footprint(self.level, self.x, self.y)?;
        let reference = reference::radiance(&footprint, self.brdf, directions);
        Ok(Evaluated { value: f64::NAN, reference })
    }

    /// The row with its lobes: where a single texel is seen, its normal.
    fn shaded(&self, map: &NormalMap, levels: &[LevelLobes]) -> Result<Row, NormalsError> {
        let texel = self.y * map.size(self.level)[0] + self.x;
        let lobes = match self.level.checked_sub(1).and_then(|level| levels.get(level)) {
            None => vec![WeightedLobe { weight: 1.0, moment: map.normals()[texel] }],
            Some(level) => {
                level.lobes[texel * self.lobes..][..self.lobes].iter().map(|lobe| (*lobe).into()).collect()
            }
        };
        Ok(Row { lobes, brdf: self.brdf, directions: Directions::new(self.light, self.view)? })
    }
}
