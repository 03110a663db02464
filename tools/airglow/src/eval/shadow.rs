//! The evaluators of the shadow pass: `sh-circle`, `sh-log`, `sh-exp`, `shadow-spheres`.

use airglow::shadow::eval::{self, Evaluated, ExponentialRow, Rows, SpheresRow};
use airglow::shadow::{Bench, MAX_ORDER, MAX_SPHERES, MIN_ORDER, ShadowError, Sphere};
use glam::DVec3;

use super::table::{RowResult, Table};
use super::{Columns, accepted, number, rejoin};
use crate::failure::{Failure, Outcome};

/// The result columns of a row, and the reference's.
type Both = (Vec<Vec<f64>>, Vec<Vec<f64>>);

/// `sh-circle`: order and theta in, zonal visibility and log out.
pub fn circle(table: &Table) -> Outcome<Columns> {
    let row = |row| {
        let order = order(table, row)?;
        let [visibility, log] = eval::circle(order, table.number(row, "theta")?).map_err(text)?;
        Ok((vec![visibility.values, log.values], vec![visibility.reference, log.reference]))
    };
    Ok(Columns { rows: (0..table.row_count()).map(|at| apart(row(at))).collect() })
}

/// `sh-log`: order and g in, f out.
pub fn logarithm(table: &Table) -> Outcome<Columns> {
    let row = |row| {
        let order = order(table, row)?;
        let g = table.finite_vector(row, "g", order * order)?;
        let Evaluated { values, reference } = eval::logarithm(order, &g).map_err(text)?;
        Ok((vec![values], vec![reference]))
    };
    Ok(Columns { rows: (0..table.row_count()).map(|at| apart(row(at))).collect() })
}

/// `sh-exp`: order, f and, if there, method in, g out.
pub fn exponential(bench: &Bench<'_>, table: &Table) -> Outcome<Columns> {
    let read = |row| {
        let order = order(table, row)?;
        let f = table.finite_vector(row, "f", order * order)?;
        let method = eval::exponential(table.word(row, "method", "default")?).map_err(text)?;
        Ok(ExponentialRow { order, f, method })
    };
    let (places, rows) = accepted((0..table.row_count()).map(read).collect());
    joined(places, eval::exponentials(bench, &rows))
}

/// `shadow-spheres`: order, point, spheres and, if there, method in, visibility out.
pub fn spheres(bench: &Bench<'_>, table: &Table) -> Outcome<Columns> {
    let read = |row| {
        let number = |column| table.number(row, column);
        let point = DVec3::new(number("px")?, number("py")?, number("pz")?);
        if !point.is_finite() {
            return Err(format!("the point is {point}; expected finite numbers"));
        }
        Ok(SpheresRow {
            order: order(table, row)?,
            point,
            spheres: sphere_list(&numbers(table.word(row, "spheres", "")?)?)?,
            method: eval::method(table.word(row, "method", "default")?).map_err(text)?,
        })
    };
    let (places, rows) = accepted((0..table.row_count()).map(read).collect());
    joined(places, eval::spheres(bench, &rows))
}

/// Any number of numbers; none in an empty cell.
fn numbers(cell: &str) -> Result<Vec<f64>, String> {
    if cell.is_empty() {
        return Ok(Vec::new());
    }
    number::parse_vector(cell).map_err(|problem| format!("spheres {problem}"))
}

/// `x;y;z;r`, repeated.
fn sphere_list(values: &[f64]) -> Result<Vec<Sphere>, String> {
    let (quadruples, rest) = values.as_chunks::<4>();
    if !rest.is_empty() || quadruples.len() > MAX_SPHERES {
        let count = values.len();
        return Err(format!("spheres has {count} values; expected x;y;z;r of up to {MAX_SPHERES} spheres"));
    }
    let sphere = |&[x, y, z, radius]: &[f64; 4]| match radius >= 0.0 {
        true => Ok(Sphere { center: DVec3::new(x, y, z), radius }),
        false => Err(format!("a sphere has the radius {radius}; expected 0 or more")),
    };
    quadruples.iter().map(sphere).collect()
}

fn order(table: &Table, row: usize) -> Result<usize, String> {
    table.whole(row, "order", MIN_ORDER..=MAX_ORDER)
}

fn text(error: ShadowError) -> String {
    error.to_string()
}

/// Values and reference of one row, or its reason in both.
fn apart(row: Result<Both, String>) -> (RowResult, RowResult) {
    match row {
        Ok((values, reference)) => (Ok(values), Ok(reference)),
        Err(reason) => (Err(reason.clone()), Err(reason)),
    }
}

fn joined(
    places: Vec<Result<(), String>>,
    results: Result<Rows<Evaluated>, ShadowError>,
) -> Outcome<Columns> {
    let results = results.map_err(Failure::work)?;
    let rows = rejoin(places, results, |found| (vec![found.values], vec![found.reference]));
    Ok(Columns { rows })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_spheres_are_read_or_refused() {
        let found = sphere_list(&[1.0, 2.0, 3.0, 0.5, 0.0, 0.0, 0.0, 0.0]).unwrap();
        assert_eq!(found[0], Sphere { center: DVec3::new(1.0, 2.0, 3.0), radius: 0.5 });
        assert_eq!(found.len(), 2);
        assert!(sphere_list(&[1.0; 3]).unwrap_err().contains("3 values"));
        assert!(sphere_list(&[1.0, 1.0, 1.0, -1.0]).unwrap_err().contains("radius -1"));
        assert!(sphere_list(&[1.0; 4 * (MAX_SPHERES + 1)]).is_err());
    }
}
