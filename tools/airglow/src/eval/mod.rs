//! A pass's own code on rows of parameters: a table in, the same table with result columns out.

pub mod number;
#[cfg(feature = "relight")]
pub mod relight;
pub mod table;

use std::collections::BTreeMap;

use table::RowResult;

/// `--set key=value`.
pub type Settings = BTreeMap<String, String>;

/// What an evaluator adds to the table: for each row the pass's values and the f64 reference's, in the order of
/// `names`, or why the row was refused.
pub struct Columns {
    /// Names of the result columns.
    pub names: Vec<&'static str>,
    /// The pass's values and the reference's.
    pub rows: Vec<(RowResult, RowResult)>,
}

impl Columns {
    /// Names and rows as they are written; with `reference` its columns follow, named with the suffix `_ref`.
    pub fn written(self, reference: bool) -> (Vec<String>, Vec<RowResult>) {
        let mut names: Vec<String> = self.names.iter().map(|name| (*name).to_owned()).collect();
        if reference {
            names.extend(self.names.iter().map(|name| format!("{name}_ref")));
        }
        let join = |(values, truth): (RowResult, RowResult)| {
            let mut values = values?;
            if reference {
                values.extend(truth?);
            }
            Ok(values)
        };
        (names, self.rows.into_iter().map(join).collect())
    }
}
