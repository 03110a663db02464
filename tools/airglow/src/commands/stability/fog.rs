//! The fog pass on extreme inputs and through its limits.

use airglow::fog::eval::AirlightRow;
use airglow::fog::stability::{self, Sweep};
use airglow::fog::{Bench, Fog, Phase, Preset, Settings};

use super::{Arguments, Row, SweepTable, Table};
use crate::failure::{Failure, Outcome};
use crate::global::Global;
use crate::host::device;
use crate::output::Output;

/// Runs the inputs and sweeps that were asked for.
pub(super) fn attempt(arguments: &Arguments, global: &Global, output: &Output) -> Outcome<Table> {
    let only = arguments.case.as_deref();
    device::with(global, &Fog::requirements(&Settings::default()), |device| {
        let run = device.bench();
        let bench = Bench { context: device.context(), run: &run };
        output.say("trying extreme inputs");
        let rows = stability::cases(&bench, only).map_err(Failure::work)?;
        output.say("sweeping limits");
        let sweeps = stability::sweeps(&bench, only).map_err(Failure::work)?;
        Ok(Table {
            pass: arguments.pass.name(),
            machine: device.machine(),
            rows: rows.into_iter().map(row).collect(),
            sweeps: sweeps.into_iter().map(sweep).collect(),
        })
    })
}

fn row(outcome: stability::Outcome) -> Row {
    let pass = outcome.pass();
    let stability::Outcome { name, input, result, truth, error, bound, row } = outcome;
    let reproduce = row.as_ref().map_or_else(|| format!("airglow stability fog --case '{name}'"), again);
    Row { name, input, result, truth, error, bound, pass, reproduce }
}

fn sweep(sweep: Sweep) -> SweepTable {
    let pass = sweep.pass();
    let Sweep { name, parameter, points, rows, bound } = sweep;
    let failing = points.iter().zip(&rows).filter(|([.., error], _)| error.is_nan() || *error > bound);
    let reproduce = failing.map(|(_, row)| again(row)).collect();
    let measure = "radiance".to_owned();
    let (name, parameter) = (name.to_owned(), parameter.to_owned());
    SweepTable { name, parameter, measure, bound, pass, points, reproduce }
}

/// The command lines that evaluate a row again.
fn again(row: &AirlightRow) -> String {
    let AirlightRow { extinction, light_distance, gamma, distance, radius, phase, preset } = row;
    let phase = match phase {
        Phase::Isotropic => "isotropic".to_owned(),
        Phase::Polynomial([a, b, c, d]) => format!("poly:{a};{b};{c};{d}"),
        Phase::HenyeyGreenstein { g } => format!("hg:{g}"),
        Phase::Draine { g, alpha } => format!("draine:{g};{alpha}"),
    };
    let method = match preset {
        Preset::Default => "default",
        Preset::Reference => "reference",
    };
    format!(
        "printf 'beta,d_sv,d_vp,gamma,light_radius,phase,method\\n\
         {extinction:e},{light_distance},{distance},{gamma},{radius},{phase},{method}\\n' > rows.csv\n\
         airglow eval fog-airlight --in rows.csv --out results.csv --reference"
    )
}
