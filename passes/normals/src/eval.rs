//! The room's own GPU code on rows of parameters, beside the truth: chains are built and lobes shaded on the device.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::NormalsError;
use crate::averages::RivalRow;
use crate::bench::{Bench, LevelLobes, Row};
use crate::brdf::{Brdf, Directions};
use crate::fit::FitSettings;
use crate::map::NormalMap;
use crate::method::{Method, below};
use crate::mixture::WeightedLobe;
use crate::reference;
use crate::settings::Settings;

/// A row of `normals`: a texel of a level under a light of irradiance 1.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// What is kept of the texel.
    pub method: Method,
}

/// What a row gave, 1/sr.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluated {
    /// The device's value, exactly.
    pub value: f64,
    /// The truth: the mean over the normals of level 0.
    pub reference: f64,
}

/// Runs the rows; a refused one says why, the others still run. Neighbours that differ in nothing but the method share their
/// truth.
///
/// # Errors
/// As [`Bench::build`], [`Bench::radiance`], [`Bench::averages`] and [`Bench::rival`].
pub fn texels(
    bench: &Bench<'_>,
    map: &NormalMap,
    rows: &[TexelRow],
) -> Result<Vec<Result<Evaluated, NormalsError>>, NormalsError> {
    let mut results: Vec<Result<Evaluated, NormalsError>> = Vec::with_capacity(rows.len());
    for (place, row) in rows.iter().enumerate() {
        let last =
            place.checked_sub(1).filter(|&last| rows[last] == TexelRow { method: rows[last].method, ..*row });
        let known = last.and_then(|last| results[last].as_ref().ok()).map(|found| found.reference);
        results.push(row.truth(map, known));
    }
    let mut places: BTreeMap<Method, Vec<usize>> = BTreeMap::new();
    for (place, _) in results.iter().enumerate().filter(|(_, result)| result.is_ok()) {
        places.entry(rows[place].method).or_default().push(place);
    }
    for (method, places) in places {
        let chosen: Vec<&TexelRow> = places.iter().map(|&place| &rows[place]).collect();
        let values = match method {
            Method::Lobes(lobes) => of_lobes(bench, map, lobes, &chosen)?,
            Method::Taps => of_taps(bench, map, &chosen)?,
            _ => of_rival(bench, map, method, &chosen)?,
        };
        for (place, value) in places.into_iter().zip(values) {
            if let Ok(result) = &mut results[place] {
                result.value = value.into();
            }
        }
    }
    Ok(results)
}

fn of_lobes(
    bench: &Bench<'_>,
    map: &NormalMap,
    lobes: usize,
    rows: &[&TexelRow],
) -> Result<Vec<f32>, NormalsError> {
    let fit = FitSettings { lobes, ..Default::default() };
    let levels = bench.build(map, &Settings { fit, budget: Some(u64::MAX), ..Default::default() })?;
    let shaded = rows.iter().map(|row| row.with_lobes(map, lobes, &levels));
    bench.radiance(&shaded.collect::<Result<Vec<_>, _>>()?)
}

/// The mean of the four texels below each.
fn of_taps(bench: &Bench<'_>, map: &NormalMap, rows: &[&TexelRow]) -> Result<Vec<f32>, NormalsError> {
    let four = |row: &&TexelRow| {
        let row = **row;
        below(map, [row.level, row.x, row.y]).map(|[level, x, y]| TexelRow { level, x, y, ..row })
    };
    let finer: Vec<TexelRow> = rows.iter().flat_map(four).collect();
    let values = of_lobes(bench, map, 4, &finer.iter().collect::<Vec<_>>())?;
    Ok(values.as_chunks::<4>().0.iter().map(|four| 0.25 * four.iter().sum::<f32>()).collect())
}

/// By a rival; where a single texel is seen, its normal, which every method shades alike.
fn of_rival(
    bench: &Bench<'_>,
    map: &NormalMap,
    method: Method,
    rows: &[&TexelRow],
) -> Result<Vec<f32>, NormalsError> {
    let levels = bench.averages(map, method)?;
    let row = |row: &&TexelRow| {
        let kept = match row.level.checked_sub(1).and_then(|level| levels.get(level)) {
            Some(level) => level.texel(row.x, row.y).to_vec(),
            None => vec![map.normals()[row.y * map.size(0)[0] + row.x].extend(0.0).as_vec4().to_array()],
        };
        Ok((row.level == 0, RivalRow { kept, brdf: row.brdf, directions: row.directions()? }))
    };
    let rows = rows.iter().map(row).collect::<Result<Vec<_>, NormalsError>>()?;
    let part = |single: bool| -> Vec<RivalRow> {
        rows.iter().filter(|(of, _)| *of == single).map(|(_, row)| row.clone()).collect()
    };
    let mut single = bench.rival(Method::Mip, &part(true))?.into_iter();
    let mut coarse = bench.rival(method, &part(false))?.into_iter();
    let next = |(of, _): &(bool, RivalRow)| if *of { single.next() } else { coarse.next() };
    Ok(rows.iter().filter_map(next).collect())
}

impl TexelRow {
    /// Checks the row and gives it its truth, which may be known.
    fn truth(&self, map: &NormalMap, known: Option<f64>) -> Result<Evaluated, NormalsError> {
        self.brdf.check()?;
        self.method.to_string().parse::<Method>()?;
        let reference = match known {
            Some(known) => known,
            None => {
                let directions = self.directions()?;
                reference::radiance(&map.footprint(self.level, self.x, self.y)?, self.brdf, directions)
            }
        };
        Ok(Evaluated { value: f64::NAN, reference })
    }

    fn directions(&self) -> Result<Directions, NormalsError> {
        Directions::new(self.light, self.view)
    }

    /// The row with its lobes: where a single texel is seen, its normal.
    fn with_lobes(&self, map: &NormalMap, count: usize, levels: &[LevelLobes]) -> Result<Row, NormalsError> {
        let texel = self.y * map.size(self.level)[0] + self.x;
        let lobes = match self.level.checked_sub(1).and_then(|level| levels.get(level)) {
            None => vec![WeightedLobe { weight: 1.0, moment: map.normals()[texel] }],
            Some(level) => level.lobes[texel * count..][..count].iter().map(|lobe| (*lobe).into()).collect(),
        };
        Ok(Row { lobes, brdf: self.brdf, directions: self.directions()? })
    }
}
