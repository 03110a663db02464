//! How an input is run alone: as a row of an evaluator where one takes it, else by its name.

use std::fmt;

use crate::bench::Texels;
use crate::eval::{ProductRow, RotateRow};

/// How to run an input alone.
#[derive(Clone, Debug)]
pub enum Reproduce {
    /// `airglow eval` with this name on these lines: the header and one row.
    Row {
        /// The evaluator.
        evaluator: &'static str,
        /// Header and row.
        lines: String,
    },
    /// `airglow eval environment-sh` at this order, on this map.
    Environment {
        /// Bands.
        order: usize,
        /// The map.
        map: Map,
    },
    /// No evaluator takes the input: by its name.
    Case,
}

/// An equirectangular image.
#[derive(Clone)]
pub struct Map {
    /// Texels of a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Linear RGB, row by row from the top.
    pub rgb: Vec<[f32; 3]>,
}

impl Map {
    /// A map of one radiance.
    pub(super) fn new(width: u32, height: u32, radiance: f32) -> Self {
        Self { width, height, rgb: vec![[radiance; 3]; width as usize * height as usize] }
    }

    pub(super) fn texels(&self) -> Texels<'_> {
        Texels { width: self.width, height: self.height, rgb: &self.rgb }
    }
}

impl fmt::Debug for Map {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "Map({} x {})", self.width, self.height)
    }
}

fn vector(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|value| format!("{value:e}")).collect();
    values.join(";")
}

impl From<&RotateRow> for Reproduce {
    fn from(row: &RotateRow) -> Self {
        let [x, y, z, w] = row.rotation.to_array();
        let (order, f) = (row.order, vector(&row.f));
        let lines = format!("order,f,qx,qy,qz,qw\n{order},{f},{x:e},{y:e},{z:e},{w:e}");
        Self::Row { evaluator: "sh-rotate", lines }
    }
}

impl From<&ProductRow> for Reproduce {
    fn from(row: &ProductRow) -> Self {
        let lines = format!("order,f,g\n{},{},{}", row.order, vector(&row.f), vector(&row.g));
        Self::Row { evaluator: "sh-product", lines }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_carry_every_digit() {
        let row = ProductRow { order: 1, f: vec![1.0 / 3.0], g: vec![f64::NAN] };
        let Reproduce::Row { evaluator, lines } = Reproduce::from(&row) else { panic!("no row") };
        assert_eq!((evaluator, &lines[..]), ("sh-product", "order,f,g\n1,3.333333333333333e-1,NaN"));
        let text = lines.rsplit(',').nth(1).unwrap();
        assert_eq!(text.parse::<f64>().unwrap(), 1.0 / 3.0);
    }
}
