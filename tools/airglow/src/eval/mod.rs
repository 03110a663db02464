//! A pass's own code on rows of parameters: a table in, the same table with result columns out.

pub mod number;
#[cfg(feature = "relight")]
pub mod relight;
pub mod table;

use std::collections::BTreeMap;

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
