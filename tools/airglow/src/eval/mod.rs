//! A pass's own code on rows of parameters: a table in, the same table with result columns out.

#[cfg(all(feature = "fog", feature = "relight"))]
pub mod fog;
#[cfg(all(feature = "normals", feature = "relight"))]
pub mod normals;
pub mod number;
#[cfg(all(feature = "radiance", feature = "relight"))]
pub mod radiance;
#[cfg(feature = "relight")]
pub mod relight;
#[cfg(all(feature = "relight", feature = "shadow"))]
pub mod shadow;
pub mod table;

use std::collections::BTreeMap;
use std::fmt::Display;

use table::RowResult;

/// `--set key=value`.
pub type Settings = BTreeMap<String, String>;

/// What an evaluator adds to the table: for each row the pass's values and the f64 reference's, one vector for each
/// result column, or why the row was refused.
pub struct Columns {
    /// The pass's values and the reference's.
    pub rows: Vec<(RowResult, RowResult)>,
}

impl Columns {
    /// Rows as they are written under [`names`]; with `reference` its values follow the pass's.
    pub fn written(self, reference: bool) -> Vec<RowResult> {
        let join = |(values, truth): (RowResult, RowResult)| {
            let mut values = values?;
            if reference {
                values.extend(truth?);
            }
            Ok(values)
        };
        self.rows.into_iter().map(join).collect()
    }
}

/// Names of the result columns; with `reference` its columns follow, named with the suffix `_ref`.
pub fn names(results: &[&str], reference: bool) -> Vec<String> {
    let mut names: Vec<String> = results.iter().map(|name| (*name).to_owned()).collect();
    if reference {
        names.extend(results.iter().map(|name| format!("{name}_ref")));
    }
    names
}

/// Splits the rows that could be read from the reasons of those that could not.
pub fn accepted<T>(read: Vec<Result<T, String>>) -> (Vec<Result<(), String>>, Vec<T>) {
    let mut rows = Vec::new();
    let places = read.into_iter().map(|row| row.map(|row| rows.push(row))).collect();
    (places, rows)
}

/// Puts results back among the rows that were refused before they reached the GPU.
pub fn rejoin<T, E>(
    places: Vec<Result<T, String>>,
    results: Vec<Result<E, impl Display>>,
    values: impl Fn(E) -> (Vec<Vec<f64>>, Vec<Vec<f64>>),
) -> Vec<(RowResult, RowResult)> {
    let mut results = results.into_iter();
    places
        .into_iter()
        .map(|place| {
            let result = place.and_then(|_| match results.next() {
                Some(result) => result.map_err(|error| error.to_string()),
                None => Err("the pass gave no result for this row".to_owned()),
            });
            match result {
                Ok(found) => {
                    let (values, reference) = values(found);
                    (Ok(values), Ok(reference))
                }
                Err(reason) => (Err(reason.clone()), Err(reason)),
            }
        })
        .collect()
}
