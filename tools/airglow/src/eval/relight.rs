//! The evaluators of the relight pass: `environment-sh`, `sh-product`, `sh-rotate`.

use std::path::Path;

use airglow::relight::eval::{self, Evaluated, ProductRow, RotateRow, Rows};
use airglow::relight::{Bench, Texels};
use airglow::relight::{MAX_ORDER, RelightError};
use airglow_scene::image_io::read_image;
use glam::DQuat;

use super::table::{RowResult, Table};
use super::{Columns, Settings, accepted, rejoin};
use crate::failure::{Failure, Outcome};

/// `environment-sh`: order in, the environment's SH RGB out.
pub fn environment_sh(bench: &Bench<'_>, table: &Table, settings: &Settings) -> Outcome<Columns> {
    let path = settings.get("image").ok_or_else(|| {
        Failure::usage("environment-sh needs the image: --set image=FILE.exr (equirectangular)".to_owned())
    })?;
    let image = read_image(Path::new(path)).map_err(Failure::input)?;
    let texels = Texels { width: image.width as u32, height: image.height as u32, rgb: &image.pixels };
    let orders: Vec<Result<usize, String>> =
        (0..table.row_count()).map(|row| table.whole(row, "order", 1..=MAX_ORDER)).collect();
    let wanted: Vec<usize> = orders.iter().filter_map(|order| order.clone().ok()).collect();
    let results = eval::environment_sh(bench, &wanted, &texels).map_err(refused)?;
    let channels = |rgb: &[[f64; 3]]| (0..3).map(|c| rgb.iter().map(|rgb| rgb[c]).collect()).collect();
    let rows = rejoin(orders, results, |found| (channels(&found.values), channels(&found.reference)));
    Ok(Columns { rows })
}

/// `sh-product`: order, f, g in, product out.
pub fn sh_product(bench: &Bench<'_>, table: &Table) -> Outcome<Columns> {
    let read = |row| {
        let order = table.whole(row, "order", 1..=MAX_ORDER)?;
        let vector = |column| table.finite_vector(row, column, order * order);
        Ok(ProductRow { order, f: vector("f")?, g: vector("g")? })
    };
    let (places, rows) = accepted((0..table.row_count()).map(read).collect());
    let results = eval::sh_product(bench, &rows).map_err(Failure::work)?;
    Ok(Columns { rows: one_vector(places, results) })
}

/// `sh-rotate`: order, f, quaternion in, rotated out.
pub fn sh_rotate(bench: &Bench<'_>, table: &Table) -> Outcome<Columns> {
    let read = |row| {
        let order = table.whole(row, "order", 1..=MAX_ORDER)?;
        let f = table.finite_vector(row, "f", order * order)?;
        let number = |column| table.number(row, column);
        let rotation = DQuat::from_xyzw(number("qx")?, number("qy")?, number("qz")?, number("qw")?);
        Ok(RotateRow { order, f, rotation })
    };
    let (places, rows) = accepted((0..table.row_count()).map(read).collect());
    let results = eval::sh_rotate(bench, &rows).map_err(Failure::work)?;
    Ok(Columns { rows: one_vector(places, results) })
}

fn one_vector(places: Vec<Result<(), String>>, results: Rows<Evaluated>) -> Vec<(RowResult, RowResult)> {
    rejoin(places, results, |found| (vec![found.values], vec![found.reference]))
}

/// An image that the pass refuses is the input's fault; anything else is not.
fn refused(error: RelightError) -> Failure {
    match error {
        RelightError::Gpu(error) => Failure::work(error),
        other => Failure::input(other),
    }
}
