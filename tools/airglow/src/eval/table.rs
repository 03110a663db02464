//! The table: its columns by name, its rows as text until an evaluator reads them.

use super::number;
use crate::failure::{Failure, Outcome};

/// A CSV table with a header; lines that start with `#` are comments and are left out. Cells are kept as they were
/// written; spaces around them are left out only when they are read.
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
            csv::ReaderBuilder::new().comment(Some(b'#')).flexible(true).from_reader(text.as_bytes());
        let header: Vec<String> = reader.headers().map_err(refuse)?.iter().map(str::to_owned).collect();
        if header.is_empty() {
            return Err(Failure::input(format!("{name}: no header; the first line must name the columns")));
        }
        for (place, column) in header.iter().enumerate() {
            if header[..place].iter().any(|earlier| earlier.trim() == column.trim()) {
                let column = column.trim();
                return Err(Failure::input(format!("{name}: column `{column}` is there twice; rename one")));
            }
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
            names.iter().copied().filter(|column| self.place(column).is_none()).collect();
        if missing.is_empty() {
            return Ok(());
        }
        Err(Failure::input(format!(
            "{name}: column {} missing; the columns needed are {}",
            missing.join(", "),
            names.join(", ")
        )))
    }

    /// Checks that no input column has the name of a column that is added: one of `results`, or `error`.
    pub fn leave_free(&self, name: &str, results: &[String]) -> Outcome {
        let mut added = results.iter().map(String::as_str).chain(["error"]);
        match added.find(|column| self.place(column).is_some()) {
            None => Ok(()),
            Some(taken) => Err(Failure::input(format!(
                "{name}: the input column `{taken}` has the name of a result column; rename or remove it"
            ))),
        }
    }

    /// The position of a column.
    fn place(&self, column: &str) -> Option<usize> {
        self.header.iter().position(|name| name.trim() == column)
    }

    /// The text of a cell; an absent column reads as empty. Refuses a row that is not as long as the header.
    fn cell(&self, row: usize, column: &str) -> Result<&str, String> {
        let cells = self.rows.get(row).map_or(&[][..], Vec::as_slice);
        let (count, columns) = (cells.len(), self.header.len());
        if count != columns {
            return Err(format!("the row has {count} cells; the header names {columns} columns"));
        }
        Ok(self.place(column).and_then(|place| cells.get(place)).map_or("", String::as_str))
    }

    /// The text of a cell without the spaces around it, or `otherwise` where it is empty or its column is absent.
    #[cfg(any(feature = "fog", feature = "normals", feature = "radiance", feature = "shadow"))]
    pub fn word<'a>(&'a self, row: usize, column: &str, otherwise: &'a str) -> Result<&'a str, String> {
        let word = self.cell(row, column)?.trim();
        Ok(if word.is_empty() { otherwise } else { word })
    }

    /// A cell as one number; the error names the column.
    pub fn number(&self, row: usize, column: &str) -> Result<f64, String> {
        number::parse(self.cell(row, column)?).map_err(|problem| format!("{column} {problem}"))
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

    /// A cell as any number of numbers; an empty one has none.
    #[cfg(feature = "radiance")]
    pub fn numbers(&self, row: usize, column: &str) -> Result<Vec<f64>, String> {
        match self.cell(row, column)?.trim() {
            "" => Ok(Vec::new()),
            text => number::parse_vector(text).map_err(|problem| format!("{column} {problem}")),
        }
    }

    /// A cell as exactly `length` finite numbers.
    pub fn finite_vector(&self, row: usize, column: &str, length: usize) -> Result<Vec<f64>, String> {
        let values =
            number::parse_vector(self.cell(row, column)?).map_err(|problem| format!("{column} {problem}"))?;
        if values.len() != length {
            return Err(format!("{column} has {} values; expected {length}", values.len()));
        }
        if let Some(bad) = values.iter().find(|value| !value.is_finite()) {
            return Err(format!("{column} holds {bad}; expected finite numbers"));
        }
        Ok(values)
    }

    /// The table with `columns` added and a last column `error`; a refused row has empty results and its
    /// reason, and as many input cells as the header. `results` has one entry for each row.
    pub fn with_results(&self, columns: &[String], results: &[RowResult]) -> Outcome<Vec<u8>> {
        let broken = |error: csv::Error| Failure::work(format!("could not write CSV: {error}"));
        let mut writer = csv::WriterBuilder::new().comment(Some(b'#')).from_writer(Vec::new());
        let names = self.header.iter().chain(columns).map(String::as_str);
        writer.write_record(names.chain(["error"])).map_err(broken)?;
        for (row, result) in self.rows.iter().zip(results) {
            let mut cells = row.clone();
            cells.resize(self.header.len(), String::new());
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
    fn missing_duplicate_and_taken_columns_are_refused() {
        let table = Table::read("t.csv", TEXT).unwrap();
        let failure = table.require("t.csv", &["order", "qx"]).unwrap_err();
        assert!(failure.to_string().contains("column qx missing"), "{failure}");
        let failure = Table::read("t.csv", "order,f, order\n1,2,3\n").unwrap_err();
        assert!(failure.to_string().contains("column `order` is there twice; rename"), "{failure}");
        let results = ["g".to_owned(), "g_ref".to_owned()];
        table.leave_free("t.csv", &results).unwrap();
        for taken in ["g", " g_ref", "error"] {
            let table = Table::read("t.csv", &format!("order,{taken}\n1,2\n")).unwrap();
            let failure = table.leave_free("t.csv", &results).unwrap_err().to_string();
            assert!(failure.contains(&format!("`{}` has the name of a result", taken.trim())), "{failure}");
        }
    }

    #[test]
    fn a_ragged_row_is_refused_alone() {
        let table = Table::read("t.csv", "order,f\n1\n1,2\n1,2,3\n").unwrap();
        let results: Vec<RowResult> =
            (0..3).map(|row| Ok(vec![vec![table.whole(row, "order", 1..=6)? as f64]])).collect();
        let text = String::from_utf8(table.with_results(&["n".to_owned()], &results).unwrap()).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[1], "1,,,the row has 1 cells; the header names 2 columns");
        assert_eq!(lines[2], "1,2,1.00000000,");
        assert_eq!(lines[3], "1,2,,the row has 3 cells; the header names 2 columns");
    }

    #[test]
    fn input_cells_are_written_unchanged() {
        let table = Table::read("t.csv", " order ,note\n 1 ,  a  b \n2,\"#, \"\"c\"\"\"\n\"#2\",\n").unwrap();
        assert_eq!(table.whole(0, "order", 1..=6), Ok(1));
        let results: Vec<RowResult> = vec![Ok(vec![vec![1.0]]); 3];
        let text = String::from_utf8(table.with_results(&["n".to_owned()], &results).unwrap()).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], " order ,note,n,error");
        assert_eq!(lines[1], " 1 ,  a  b ,1.00000000,");
        assert_eq!(lines[2], "2,\"#, \"\"c\"\"\",1.00000000,");
        assert_eq!(lines[3], "\"#2\",,1.00000000,", "no comment, when it is read again");
    }
}
