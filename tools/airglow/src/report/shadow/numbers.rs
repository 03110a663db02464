//! Products, squares and the compiler, and how long spheres take to fit.

use std::path::Path;
use std::time::{Duration, Instant};

use airglow::shadow::bench::{Bench, RowKernel};
use airglow::shadow::spheres::FitSettings;
use airglow::shadow::{MAX_ORDER, MIN_ORDER};
use airglow_scene::geometry::subdivide;

use super::Measurement;
use crate::failure::{Failure, Outcome};
use crate::host::spheres::fitted;
use crate::report::model::Number;

/// Rows of a product.
const ROWS: usize = 16_384;
/// Runs, of which the least counts.
const RUNS: usize = 9;
/// The mesh that spheres are fitted to, and how often its triangles are cut into four: 101 120 of them.
const MESH: &str = "assets/mesh/teapot.glb";
const CUTS: usize = 2;

/// Time of the generated products and squares, and of their first run.
pub fn products(measurement: &Measurement<'_>) -> Outcome<Vec<Number>> {
    let run = measurement.device.bench();
    let bench = Bench { context: measurement.device.context(), run: &run };
    let mut numbers = Vec::new();
    for order in MIN_ORDER..=MAX_ORDER {
        let value = |at: usize| {
            if at.is_multiple_of(order * order) { 3.5 } else { ((at * 37 % 101) as f32 - 50.0) * 1e-5 }
        };
        let rows: Vec<f32> = (0..ROWS * order * order).map(value).collect();
        for (name, kernel) in
            [("product", RowKernel::Product as fn(u32) -> RowKernel), ("square", RowKernel::Square)]
        {
            let least =
                |times: &[Duration]| times.iter().map(Duration::as_secs_f64).fold(f64::INFINITY, f64::min);
            let (_, one) = bench.rows(order, kernel(1), &rows, RUNS).map_err(Failure::work)?;
            let (_, many) = bench.rows(order, kernel(9), &rows, RUNS).map_err(Failure::work)?;
            let each = (least(&many) - least(&one)) / (8 * ROWS) as f64;
            let first = one.first().map_or(0.0, Duration::as_secs_f64);
            numbers.push(Number {
                what: format!("order {order}: time of a {name}, and of its first run"),
                asked: "first run within 1 s".to_owned(),
                measured: format!("{:.1} ns, {:.0} ms", 1e9 * each, 1e3 * first),
                holds: first <= 1.0,
            });
        }
    }
    Ok(numbers)
}

/// 64 spheres for a mesh of a hundred thousand triangles.
pub fn fit(measurement: &Measurement<'_>) -> Outcome<Number> {
    let scene = airglow_scene::load(Path::new(MESH)).map_err(Failure::input)?;
    let Some(mesh) = scene.meshes.first() else { return Err(Failure::input(format!("{MESH}: no mesh"))) };
    let mesh = (0..CUTS).fold(mesh.clone(), |mesh, _| subdivide(&mesh));
    let begin = Instant::now();
    let set = fitted(&mesh, &FitSettings::default(), measurement.output)?;
    let seconds = begin.elapsed().as_secs_f64();
    Ok(Number {
        what: format!("{} spheres fitted to {} triangles ({MESH})", set.spheres.len(), mesh.triangle_count()),
        asked: "less than 20 s on 2 cores".to_owned(),
        measured: format!("{seconds:.1} s; {:.3} m3 outside of {:.3} m3", set.outside, set.volume),
        holds: seconds < 20.0,
    })
}
