//! Samples of near emitters on extreme inputs and through their limits.

use airglow::radiance::eval::{CubeRow, Method};
use airglow::radiance::gpu::Texels;
use airglow::radiance::gpu::bench::Bench;
use airglow::radiance::stability::{self, BOUND, FrameOutcome, Sweep};
use airglow::radiance::{PassSettings, Radiance};

use super::{Arguments, Row, SweepTable, Table};
use crate::failure::{Failure, Outcome};
use crate::global::Global;
use crate::host::device;
use crate::output::Output;

/// Runs the inputs and sweeps that were asked for.
pub(super) fn attempt(arguments: &Arguments, global: &Global, output: &Output) -> Outcome<Table> {
    let only = arguments.case.as_deref();
    let requirements = Texels::requirements().and(&Radiance::requirements(&PassSettings::default()));
    device::with(global, &requirements, |device| {
        let run = device.bench();
        let bench = Bench { context: device.context(), run: &run };
        output.say("trying extreme inputs");
        let rows = stability::cases(&bench, only).map_err(Failure::work)?;
        output.say("drawing frames of extreme receivers");
        let frames = stability::frames(&bench, only, !arguments.quick).map_err(Failure::work)?;
        output.say("sweeping limits");
        let sweeps = stability::sweeps(&bench, only).map_err(Failure::work)?;
        Ok(Table {
            pass: arguments.pass.name(),
            machine: device.machine(),
            rows: rows.into_iter().map(row).chain(frames.into_iter().map(frame)).collect(),
            sweeps: sweeps.into_iter().map(sweep).collect(),
        })
    })
}

fn row(outcome: stability::Outcome) -> Row {
    let pass = outcome.pass();
    let stability::Outcome { name, result, truth, error, row } = outcome;
    let input = format!("{} triangles, {:?}", row.triangles.len(), row.method);
    Row { name, input, result, truth, error, bound: BOUND, pass, reproduce: again(&row) }
}

fn frame(outcome: FrameOutcome) -> Row {
    let pass = outcome.pass();
    let FrameOutcome { name, input, result, truth, error, bound } = outcome;
    let reproduce = format!("airglow stability radiance --case '{name}'");
    Row { name: name.to_owned(), input, result, truth, error, bound, pass, reproduce }
}

fn sweep(sweep: Sweep) -> SweepTable {
    let pass = sweep.pass();
    let Sweep { name, parameter, points, rows } = sweep;
    let failing = points.iter().zip(&rows).filter(|([.., error], _)| error.is_nan() || *error > BOUND);
    let reproduce = failing.map(|(_, row)| again(row)).collect();
    let measure = "norm of the light vector".to_owned();
    SweepTable { name, parameter: parameter.to_owned(), measure, bound: BOUND, pass, points, reproduce }
}

/// The command lines that evaluate a row again.
fn again(row: &CubeRow) -> String {
    let CubeRow { order, face, rays, point, triangles, method } = row;
    let joined =
        |numbers: Vec<f64>| numbers.iter().map(|number| format!("{number:e}")).collect::<Vec<_>>().join(";");
    let corners = triangles.iter().flat_map(|triangle| triangle.corners).flat_map(|c| c.to_array());
    let (corners, radiance) =
        (joined(corners.collect()), joined(triangles.iter().map(|triangle| triangle.radiance.x).collect()));
    let method = match method {
        Method::Cube => "cube",
        Method::Analytic => "analytic",
    };
    let [x, y, z] = point.to_array();
    format!(
        "printf 'order,face,px,py,pz,triangles,radiance,method\\n\
         {order},{face},{x},{y},{z},{corners},{radiance},{method}\\n' > rows.csv\n\
         airglow eval radiance-cube --in rows.csv --out results.csv --reference --set rays={rays}"
    )
}
