//! The table: its columns by name, its rows as text until an evaluator reads them.

use super::number;
use crate::failure::{Failure, Outcome};

/// A CSV table with a header; lines that start with `#` are comments and are left out.
#[derive(Debug)]
pub struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// What an evaluator makes of one row: values of the result columns, or why the row was refused.
pub type RowResult = Result<Vec<Vec<f64>>, String>;

impl Table {
    /// Reads CSV text; `name` is the file's, for errors.
    pub fn read(name: &str, text: &str) -> Outcome<Self> {
        let refuse = |error: csv::Error| Failure::input(format!("{name}: not a CSV table: {error}"));
        let mut reader =
            csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(text.as_bytes());
        let header: Vec<String> = reader.headers().map_err(refuse)?.iter().map(str::to_owned).collect();
        if header.is_empty() {
            return Err(Failure::input(format!("{name}: no header; the first line must name the columns")));
        }
        let rows = reader
            .records()
            .map(|record| record.map(|record| record.iter().map(str::to_owned).collect()).map_err(refuse))
            .collect::<Outcome<_>>()?;
        Ok(Self { header, rows })
    }

    /// Number of rows below the header.
    pub fn row_count(&self) -> usize {
        self.rows.len()
    }

    /// Checks that every column in `names` is there.
    pub fn require(&self, name: &str, names: &[&str]) -> Outcome {
        let missing: Vec<&str> =
            names.iter().copied().filter(|column| !self.header.iter().any(|have| have == column)).collect();
        if missing.is_empty() {
            return Ok(());
        }
        Err(Failure::input(format!(
            "{name}: column {} missing; the columns needed are {}",
            missing.join(", "),
            names.join(", ")
        )))
    }

    /// The text of a cell; an absent column reads as empty.
    fn cell(&self, row: usize, column: &str) -> &str {
        let place = self.header.iter().position(|name| name == column);
        place.and_then(|place| self.rows.get(row)?.get(place)).map_or("", String::as_str)
    }

    /// A cell as one number; the error names the column.
    pub fn number(&self, row: usize, column: &str) -> Result<f64, String> {
        number::parse(self.cell(row, column)).map_err(|problem| format!("{column} {problem}"))
    }

    /// A cell as one whole number in `range`.
    pub fn whole(
        &self,
        row: usize,
        column: &str,
        range: std::ops::RangeInclusive<usize>,
    ) -> Result<usize, String> {
        let value = self.number(row, column)?;
        let whole = value as usize;
        if value.fract() != 0.0 || value < 0.0 || !range.contains(&whole) {
            let (low, high) = (range.start(), range.end());
            return Err(format!("{column} is {value}; expected a whole number from {low} to {high}"));
        }
        Ok(whole)
    }

    /// A cell as exactly `length` finite numbers.
    pub fn finite_vector(&self, row: usize, column: &str, length: usize) -> Result<Vec<f64>, String> {
        let values =
            number::parse_vector(self.cell(row, column)).map_err(|problem| format!("{column} {problem}"))?;
        if values.len() != length {
            return Err(format!("{column} has {} values; expected {length}", values.len()));
        }
        if let Some(bad) = values.iter().find(|value| !value.is_finite()) {
            return Err(format!("{column} holds {bad}; expected finite numbers"));
        }
        Ok(values)
    }

    /// The table with `columns` added and a last column `error`; a refused row has empty results and its
    /// reason. `results` has one entry for each row.
    pub fn with_results(&self, columns: &[String], results: &[RowResult]) -> Outcome<Vec<u8>> {
        let broken = |error: csv::Error| Failure::work(format!("could not write CSV: {error}"));
        let mut writer = csv::Writer::from_writer(Vec::new());
        let names = self.header.iter().chain(columns).map(String::as_str);
        writer.write_record(names.chain(["error"])).map_err(broken)?;
        for (row, result) in self.rows.iter().zip(results) {
            let mut cells = row.clone();
            match result {
                Ok(values) => {
                    cells.extend(values.iter().map(|value| number::format_vector(value)));
                    cells.push(String::new());
                }
                Err(reason) => {
                    cells.resize(cells.len() + columns.len(), String::new());
                    cells.push(reason.clone());
                }
            }
            writer.write_record(&cells).map_err(broken)?;
        }
        writer.into_inner().map_err(|error| Failure::work(format!("could not write CSV: {error}")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# a comment\norder,f\n2,1;2;3;4\n# another\n9,1\n2,1;nan;3;4\n";

    #[test]
    fn rows_keep_their_order_and_refused_ones_say_why() {
        let table = Table::read("t.csv", TEXT).unwrap();
        assert_eq!(table.row_count(), 3);
        let results: Vec<RowResult> = (0..3)
            .map(|row| {
                let order = table.whole(row, "order", 1..=6)?;
                Ok(vec![table.finite_vector(row, "f", order * order)?])
            })
            .collect();
        let text = String::from_utf8(table.with_results(&["g".to_owned()], &results).unwrap()).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "order,f,g,error");
        assert_eq!(lines[1], "2,1;2;3;4,1.00000000;2.00000000;3.00000000;4.00000000,");
        assert_eq!(lines[2], "9,1,,order is 9; expected a whole number from 1 to 6");
        assert_eq!(lines[3], "2,1;nan;3;4,,f holds NaN; expected finite numbers");
    }

    #[test]
    fn missing_columns_and_ragged_rows_are_refused() {
        let table = Table::read("t.csv", TEXT).unwrap();
        let failure = table.require("t.csv", &["order", "qx"]).unwrap_err();
        assert!(failure.to_string().contains("column qx missing"), "{failure}");
        assert!(Table::read("t.csv", "a,b\n1\n").is_err());
    }
}
