//! `airglow stability`: extreme inputs and limits, beside the truth.

mod again;
#[cfg(feature = "fog")]
mod fog;
#[cfg(feature = "normals")]
mod normals;
#[cfg(feature = "radiance")]
mod radiance;
#[cfg(feature = "shadow")]
mod shadow;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use airglow::relight::stability::{self, Reproduce, Selection, Sweep};
use airglow::relight::{Bench, Relight, Settings};
use clap::Args;
use serde::Serialize;

use crate::failure::{Failure, Outcome};
use crate::files;
use crate::global::Global;
use crate::host::device;
use crate::host::machine::Machine;
use crate::output::Output;
use crate::report::pass::Pass;
use crate::report::sweep::{self, SweepPlot};
use crate::text::escape;
use again::Again;

/// Try a pass on extreme inputs and sweep its limits, and print each result beside the truth, with pass or fail.
///
/// A failure prints the `airglow eval` command and row that make it again (its environment is written as an EXR file
/// beside the report, or into the working folder), or the `--case` that does; the command ends with exit code 3.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  airglow stability relight
  airglow stability fog
  airglow stability radiance
  airglow stability normals
  airglow stability shadow
  airglow stability relight --case 'rotation: zero, order 6'
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
    /// Run only the input or the sweep of this name, as the table prints it.
    #[arg(long = "case", value_name = "NAME")]
    case: Option<String>,
}

#[derive(Serialize)]
struct Table {
    /// The pass that was tried.
    pass: &'static str,
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
    /// Command lines that run this input alone.
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
    /// Of each point that fails, in their order, the command lines that run it alone.
    reproduce: Vec<String>,
}

impl SweepTable {
    fn fails(&self, [.., error]: &[f64; 4]) -> bool {
        error.is_nan() || *error > self.bound
    }

    /// The point with the largest error, in words.
    fn worst(&self) -> String {
        let by_error = |a: &&[f64; 4], b: &&[f64; 4]| a[3].total_cmp(&b[3]);
        self.points.iter().max_by(by_error).map_or_else(String::new, point_in_words)
    }
}

fn point_in_words([at, value, truth, error]: &[f64; 4]) -> String {
    format!("at {at:.2e}: {value:.8e}, truth {truth:.8e}, error {error:.2e}")
}

/// Runs the command.
pub fn run(arguments: &Arguments, global: &Global, output: &Output) -> Outcome {
    let table = match arguments.pass {
        Pass::Relight => try_relight(arguments, global, output)?,
        #[cfg(feature = "fog")]
        Pass::Fog => fog::attempt(arguments, global, output)?,
        #[cfg(feature = "radiance")]
        Pass::Radiance => radiance::attempt(arguments, global, output)?,
        #[cfg(feature = "normals")]
        Pass::Normals => normals::attempt(arguments, global, output)?,
        #[cfg(feature = "shadow")]
        Pass::Shadow => shadow::attempt(arguments, global, output)?,
    };
    if table.rows.is_empty() && table.sweeps.is_empty() {
        let name = arguments.case.as_deref().unwrap_or_default();
        let mend = format!("`airglow stability {}` prints the names", table.pass);
        return Err(Failure::usage(format!("--case `{name}`: nothing has this name; {mend}")));
    }
    if let Some(folder) = &arguments.output {
        write(folder, &table)?;
        output.say(format!("wrote {}", folder.join("stability.html").display()));
    }
    output.result(&table, text)?;
    let failed = table.rows.iter().filter(|row| !row.pass).count()
        + table.sweeps.iter().filter(|sweep| !sweep.pass).count();
    if failed > 0 { Err(Failure::check(format!("{failed} rows or sweeps fail"))) } else { Ok(()) }
}

fn try_relight(arguments: &Arguments, global: &Global, output: &Output) -> Outcome<Table> {
    let requirements = Relight::requirements(&Settings { order: 6, ..Settings::default() });
    let selection = Selection { large: !arguments.quick, only: arguments.case.as_deref() };
    let again =
        Again { folder: arguments.output.as_deref().unwrap_or(Path::new("")), device: &global.device };
    device::with(global, &requirements, |device| {
        let run = device.bench();
        let bench = Bench { context: device.context(), run: &run };
        output.say("trying extreme inputs");
        let rows = stability::cases(&bench, &selection).map_err(Failure::work)?;
        output.say("sweeping limits");
        let sweeps = stability::sweeps(&bench, &selection).map_err(Failure::work)?;
        Ok(Table {
            pass: arguments.pass.name(),
            machine: device.machine(),
            rows: rows.into_iter().map(|outcome| row(outcome, &again)).collect::<Outcome<_>>()?,
            sweeps: sweeps.iter().map(|sweep| sweep_table(sweep, &again)).collect::<Outcome<_>>()?,
        })
    })
}

fn row(outcome: stability::Outcome, again: &Again<'_>) -> Outcome<Row> {
    let pass = outcome.pass();
    let stability::Outcome { name, input, result, truth, error, bound, reproduce } = outcome;
    let reproduce = match reproduce {
        // Only what fails is worth a file.
        Reproduce::Environment { .. } if pass => again.command(&name, &name, &Reproduce::Case)?,
        other => again.command(&name, &name, &other)?,
    };
    Ok(Row { name, input, result, truth, error, bound, pass, reproduce })
}

fn sweep_table(sweep: &Sweep, again: &Again<'_>) -> Outcome<SweepTable> {
    let mut table = SweepTable {
        name: sweep.name.to_owned(),
        parameter: sweep.parameter.to_owned(),
        measure: sweep.measure.to_owned(),
        bound: sweep.bound,
        pass: sweep.pass(),
        points: sweep.points.iter().map(|point| [point.at, point.value, point.truth, point.error]).collect(),
        reproduce: Vec::new(),
    };
    for (point, numbers) in sweep.points.iter().zip(&table.points) {
        if table.fails(numbers) {
            let file = format!("{} {:e}", sweep.name, point.at);
            table.reproduce.push(again.command(sweep.name, &file, &point.reproduce)?);
        }
    }
    Ok(table)
}

fn verdict(pass: bool) -> &'static str {
    if pass { "pass" } else { "FAIL" }
}

fn text(table: &Table) -> String {
    let mut text = format!("{} ({})\n", table.machine.device, table.machine.driver);
    for row in &table.rows {
        let Row { name, input, result, truth, error, bound, pass, reproduce } = row;
        let _ = writeln!(text, "{} {name:58} error {error:9.2e} of {bound:.0e}", verdict(*pass));
        let _ = writeln!(text, "     result {result}, truth {truth}");
        if !pass {
            let _ = writeln!(text, "     input  {input}\n     again  {}", indented(reproduce));
        }
    }
    for sweep in &table.sweeps {
        let name = format!("sweep: {} ({}, {} steps)", sweep.name, sweep.parameter, sweep.points.len());
        let _ = writeln!(text, "{} {name:58} bound {:.0e}", verdict(sweep.pass), sweep.bound);
        let _ = writeln!(text, "     worst  {}", sweep.worst());
        let failing = sweep.points.iter().filter(|point| sweep.fails(point));
        for (point, reproduce) in failing.zip(&sweep.reproduce) {
            let _ = writeln!(text, "     {}\n     again  {}", point_in_words(point), indented(reproduce));
        }
    }
    text
}

fn indented(lines: &str) -> String {
    lines.replace('\n', "\n            ")
}

fn write(folder: &Path, table: &Table) -> Outcome {
    let json = serde_json::to_vec_pretty(table).map_err(Failure::work)?;
    files::write(&folder.join("stability.json"), &json)?;
    files::write(&folder.join("stability.html"), page(table)?.as_bytes())
}

fn page(table: &Table) -> Outcome<String> {
    let mut html = format!(
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>airglow: stability of {}</title>\
         <style>body{{font:15px/1.5 system-ui,sans-serif;max-width:78em;margin:2em auto;padding:0 1em}}\
         table{{border-collapse:collapse}}td,th{{border:1px solid #ccc;padding:.2em .6em}}\
         .fail{{background:#fbdcd8}}</style></head><body><h1>Stability of {}</h1><p>{} ({})</p>\
         <table><tr><th>input</th><th>in words</th><th>GPU</th><th>truth</th><th>error</th><th>bound</th><th></th><th>again</th></tr>",
        table.pass,
        table.pass,
        escape(&table.machine.device),
        escape(&table.machine.driver)
    );
    for row in &table.rows {
        let _ = write!(
            html,
            "<tr class=\"{}\"><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.2e}</td><td>{:.0e}</td><td>{}</td>\
             <td><pre>{}</pre></td></tr>",
            if row.pass { "" } else { "fail" },
            escape(&row.name),
            escape(&row.input),
            escape(&row.result),
            escape(&row.truth),
            row.error,
            row.bound,
            verdict(row.pass),
            if row.pass { String::new() } else { escape(&row.reproduce) }
        );
    }
    html.push_str("</table>");
    for table in &table.sweeps {
        let _ = write!(html, "<h2>{}: {}</h2>", escape(&table.name), verdict(table.pass));
        let _ = write!(html, "<p>worst {}</p>", escape(&table.worst()));
        for reproduce in &table.reproduce {
            let _ = write!(html, "<pre>{}</pre>", escape(reproduce));
        }
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

#[cfg(test)]
mod tests {
    use airglow::relight::stability::{Map, SweepPoint};

    use super::*;

    fn failing(reproduce: Reproduce) -> stability::Outcome {
        let text = |text: &str| text.to_owned();
        let (result, truth) = (text("value 3: 1.00000000e0"), text("value 3: 2.00000000e0"));
        let (name, input) = (text("a map, order 2"), text("in words"));
        stability::Outcome { name, input, result, truth, error: 1.0, bound: 1e-5, reproduce }
    }

    fn map() -> Reproduce {
        Reproduce::Environment {
            order: 2,
            map: Map { width: 2, height: 1, rgb: vec![[1.5; 3], [f32::NAN; 3]] },
        }
    }

    fn machine() -> Machine {
        let text = String::new;
        Machine { device: text(), kind: text(), driver: text(), clocks: None, software: true }
    }

    #[test]
    fn what_fails_prints_the_commands_that_make_it_again() {
        let folder = tempfile::tempdir().unwrap();
        let again = Again { folder: folder.path(), device: &Some("it's".to_owned()) };
        let lines = Reproduce::Row { evaluator: "sh-product", lines: "order,f,g\n1,2,3".to_owned() };
        assert_eq!(
            row(failing(lines), &again).unwrap().reproduce,
            "printf 'order,f,g\\n1,2,3\\n' > rows.csv\n\
             airglow eval sh-product --in rows.csv --out results.csv --reference --device 'it'\\''s'"
        );
        let case = row(failing(Reproduce::Case), &again).unwrap().reproduce;
        assert!(case.starts_with("airglow stability relight --case 'a map, order 2' --device"), "{case}");
        let file = folder.path().join("a-map--order-2.exr");
        let environment = row(failing(map()), &again).unwrap();
        let set = format!(
            "eval environment-sh --in rows.csv --out results.csv --reference --set 'image={}'",
            file.display()
        );
        assert!(environment.reproduce.contains(&set), "{}", environment.reproduce);
        let image = airglow_scene::image_io::read_image(&file).unwrap();
        assert!(image.pixels[0] == [1.5; 3] && image.pixels[1][0].is_nan(), "{image:?}");
        let rows = vec![environment];
        let text = text(&Table { pass: "relight", machine: machine(), rows, sweeps: Vec::new() });
        assert!(text.contains("result value 3: 1.00000000e0, truth value 3: 2.00000000e0"), "{text}");
        assert!(text.contains("again  printf 'order\\n2\\n'"), "{text}");
    }

    #[test]
    fn each_failing_point_of_a_sweep_prints_its_own() {
        let folder = tempfile::tempdir().unwrap();
        let again = Again { folder: folder.path(), device: &None };
        let point = |at, error| SweepPoint { at, value: 1.0, truth: 1.0, error, reproduce: map() };
        let points = vec![point(1.0, 0.0), point(10.0, f64::NAN), point(100.0, 1.0)];
        let sweep = Sweep { name: "a peak", parameter: "p", measure: "m", points, bound: 1e-5 };
        let table = sweep_table(&sweep, &again).unwrap();
        assert!(!table.pass);
        assert_eq!(table.reproduce.len(), 2, "{:?}", table.reproduce);
        assert!(
            folder.path().join("a-peak-1e1.exr").exists() && folder.path().join("a-peak-1e2.exr").exists()
        );
        assert!(!folder.path().join("a-peak-1e0.exr").exists(), "this one passes");
    }
}
