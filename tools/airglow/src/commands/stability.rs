//! `airglow stability`: extreme inputs and limits, beside the truth.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use airglow::relight::stability::{self, Sweep};
use airglow::relight::{Bench, Relight, Settings};
use clap::Args;
use serde::Serialize;

use crate::cli::Global;
use crate::commands::report::Pass;
use crate::failure::{Failure, Outcome};
use crate::files;
use crate::host::device;
use crate::output::Output;
use crate::report::html::escape;
use crate::report::model::Machine;
use crate::report::sweep::{self, SweepPlot};

/// Try a pass on extreme inputs and sweep its limits, and print each result beside the truth, with pass or fail.
///
/// A failure prints the row of `airglow eval` that makes it again, and the command ends with exit code 3.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  airglow stability relight
  airglow stability relight -o out/stability     the table and the sweeps' plots as a page")]
pub struct Arguments {
    /// The pass.
    #[arg(value_enum, default_value_t = Pass::Relight)]
    pass: Pass,
    /// Write `stability.html` with the table and the sweeps' plots, and `stability.json`, into this folder.
    #[arg(long, short = 'o', value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Leave out what takes a gigabyte of memory (two million vertices).
    #[arg(long)]
    quick: bool,
}

#[derive(Serialize)]
struct Table {
    machine: Machine,
    rows: Vec<Row>,
    sweeps: Vec<SweepTable>,
}

#[derive(Serialize)]
struct Row {
    name: String,
    input: String,
    result: String,
    truth: String,
    error: f64,
    bound: f64,
    pass: bool,
    reproduce: String,
}

#[derive(Serialize)]
struct SweepTable {
    name: String,
    parameter: String,
    measure: String,
    bound: f64,
    pass: bool,
    /// Parameter, the GPU's value, the truth, the error.
    points: Vec<[f64; 4]>,
}

/// Runs the command.
pub fn run(arguments: &Arguments, global: &Global, output: &Output) -> Outcome {
    let Pass::Relight = arguments.pass;
    let requirements = Relight::requirements(&Settings { order: 6, ..Settings::default() });
    let table = device::with(global, &requirements, |device| {
        let run = device.bench();
        let bench = Bench { context: device.context(), run: &run };
        output.say("trying extreme inputs");
        let rows = stability::cases(&bench, !arguments.quick).map_err(Failure::work)?;
        output.say("sweeping limits");
        let sweeps = stability::sweeps(&bench).map_err(Failure::work)?;
        Ok(Table {
            machine: device.machine(),
            rows: rows.into_iter().map(row).collect(),
            sweeps: sweeps.iter().map(sweep_table).collect(),
        })
    })?;
    if let Some(folder) = &arguments.output {
        write(folder, &table)?;
        output.say(format!("wrote {}", folder.join("stability.html").display()));
    }
    output.result(&table, text)?;
    let failed = table.rows.iter().filter(|row| !row.pass).count()
        + table.sweeps.iter().filter(|sweep| !sweep.pass).count();
    if failed > 0 { Err(Failure::check(format!("{failed} rows or sweeps fail"))) } else { Ok(()) }
}

fn row(outcome: stability::Outcome) -> Row {
    let pass = outcome.pass();
    let stability::Outcome { name, input, result, truth, error, bound, reproduce } = outcome;
    Row { name, input, result, truth, error, bound, pass, reproduce }
}

fn sweep_table(sweep: &Sweep) -> SweepTable {
    let point = |point: &stability::SweepPoint| [point.at, point.value, point.truth, point.error];
    SweepTable {
        name: sweep.name.to_owned(),
        parameter: sweep.parameter.to_owned(),
        measure: sweep.measure.to_owned(),
        bound: sweep.bound,
        pass: sweep.pass(),
        points: sweep.points.iter().map(point).collect(),
    }
}

fn verdict(pass: bool) -> &'static str {
    if pass { "pass" } else { "FAIL" }
}

fn text(table: &Table) -> String {
    let mut text = format!("{} ({})\n", table.machine.device, table.machine.driver);
    for row in &table.rows {
        let _ = writeln!(
            text,
            "{} {:58} error {:9.2e} of {:.0e}",
            verdict(row.pass),
            row.name,
            row.error,
            row.bound
        );
        if !row.pass {
            let _ = writeln!(
                text,
                "     input  {}\n     result {}\n     truth  {}",
                row.input, row.result, row.truth
            );
            let _ = writeln!(text, "     again  {}", row.reproduce.replace('\n', "\n            "));
        }
    }
    for sweep in &table.sweeps {
        let worst = sweep.points.iter().map(|point| point[3]).fold(0.0, f64::max);
        let name = format!("sweep: {} ({}, {} steps)", sweep.name, sweep.parameter, sweep.points.len());
        let _ = writeln!(text, "{} {name:58} error {worst:9.2e} of {:.0e}", verdict(sweep.pass), sweep.bound);
        if !sweep.pass {
            for [at, value, truth, error] in
                sweep.points.iter().filter(|point| point[3].is_nan() || point[3] > sweep.bound)
            {
                let _ = writeln!(text, "     at {at:e}: {value:.9e}, truth {truth:.9e}, error {error:.2e}");
            }
        }
    }
    text
}

fn write(folder: &Path, table: &Table) -> Outcome {
    let json = serde_json::to_vec_pretty(table).map_err(Failure::work)?;
    files::write(&folder.join("stability.json"), &json)?;
    files::write(&folder.join("stability.html"), page(table)?.as_bytes())
}

fn page(table: &Table) -> Outcome<String> {
    let mut html = format!(
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>airglow: stability of relight</title>\
         <style>body{{font:15px/1.5 system-ui,sans-serif;max-width:78em;margin:2em auto;padding:0 1em}}\
         table{{border-collapse:collapse}}td,th{{border:1px solid #ccc;padding:.2em .6em}}\
         .fail{{background:#fbdcd8}}</style></head><body><h1>Stability of relight</h1><p>{} ({})</p>\
         <table><tr><th>input</th><th>in words</th><th>GPU</th><th>truth</th><th>error</th><th>bound</th><th></th></tr>",
        escape(&table.machine.device),
        escape(&table.machine.driver)
    );
    for row in &table.rows {
        let _ = write!(
            html,
            "<tr class=\"{}\"><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.2e}</td><td>{:.0e}</td><td>{}</td></tr>",
            if row.pass { "" } else { "fail" },
            escape(&row.name),
            escape(&row.input),
            escape(&row.result),
            escape(&row.truth),
            row.error,
            row.bound,
            verdict(row.pass)
        );
    }
    html.push_str("</table>");
    for table in &table.sweeps {
        let _ = write!(html, "<h2>{}: {}</h2>", escape(&table.name), verdict(table.pass));
        html.push_str(&sweep::svg(&SweepPlot {
            parameter: &table.parameter,
            measure: &table.measure,
            points: table.points.clone(),
            bound: table.bound,
        })?);
    }
    html.push_str("</body></html>\n");
    Ok(html)
}
