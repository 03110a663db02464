//! The levels of normal maps on extreme inputs and through their limits.

use airglow::normals::stability::{self, Sweep};
use airglow::normals::{Bench, Normals, Settings};

use super::{Arguments, Row, SweepTable, Table};
use crate::failure::{Failure, Outcome};
use crate::global::Global;
use crate::host::device;
use crate::output::Output;

/// Runs the inputs and sweeps that were asked for.
pub(super) fn attempt(arguments: &Arguments, global: &Global, output: &Output) -> Outcome<Table> {
    let only = arguments.case.as_deref();
    device::with(global, &Normals::requirements(&Settings::default()), |device| {
        let run = device.bench();
        let bench = Bench { context: device.context(), run: &run };
        output.say("trying extreme inputs");
        let rows = stability::cases(&bench, only).map_err(Failure::work)?;
        output.say("sweeping limits");
        let sweeps = stability::sweeps(&bench, only).map_err(Failure::work)?;
        let (pass, machine) = (arguments.pass.name(), device.machine());
        let (rows, sweeps) = (rows.into_iter().map(row), sweeps.into_iter().map(sweep));
        Ok(Table { pass, machine, rows: rows.collect(), sweeps: sweeps.collect() })
    })
}

fn again(name: &str) -> String {
    format!("airglow stability normals --case '{name}'")
}

fn row(outcome: stability::Outcome) -> Row {
    let (pass, reproduce) = (outcome.pass(), again(&outcome.name));
    let stability::Outcome { name, input, result, truth, error, bound } = outcome;
    Row { name, input, result, truth, error, bound, pass, reproduce }
}

fn sweep(sweep: Sweep) -> SweepTable {
    let failing = sweep.points.iter().filter(|[.., error]| error.is_nan() || *error > sweep.bound);
    SweepTable {
        reproduce: failing.map(|_| again(sweep.name)).collect(),
        pass: sweep.pass(),
        name: sweep.name.to_owned(),
        parameter: sweep.parameter.to_owned(),
        measure: "radiance".to_owned(),
        bound: sweep.bound,
        points: sweep.points,
    }
}
