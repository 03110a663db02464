//! Reports as one page that needs nothing beside it: tables and inline SVG.

use std::fmt::Write;

use super::frame;
use super::model::{Curve, Distribution, Errors, Number, Point, Report};
use super::plot::{self, Cost};
use super::ranking;
use crate::failure::Outcome;
use crate::text::{bytes, escape};

const STYLE: &str = "body{font:15px/1.5 system-ui,sans-serif;max-width:78em;margin:2em auto;padding:0 1em;color:#222}\
table{border-collapse:collapse;margin:1em 0}td,th{border:1px solid #ccc;padding:.2em .6em;text-align:right}\
td:first-child,th:first-child{text-align:left}tr.chosen{background:#e8f1fb;font-weight:600}\
.banner{background:#fff3cd;border:1px solid #e0c060;padding:.6em 1em}code{background:#f2f2f2;padding:.1em .3em}\
.plots{display:flex;flex-wrap:wrap;gap:1em}";

/// The page of one report, or of several overlaid (one colour for each device).
pub fn page(reports: &[Report]) -> Outcome<String> {
    let mut html = String::new();
    let title = format!("airglow: {}", reports.first().map_or("report", |report| report.pass.as_str()));
    let _ = write!(
        html,
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title><style>{STYLE}</style></head><body><h1>{0}</h1>",
        escape(&title)
    );
    for report in reports {
        header(&mut html, report);
        if let Some(frame) = &report.frame {
            frame::page::section(&mut html, frame)?;
        }
    }
    let mut knobs: Vec<&str> = Vec::new();
    for curve in reports.iter().flat_map(|report| &report.curves) {
        if !knobs.contains(&curve.knob.as_str()) {
            knobs.push(&curve.knob);
        }
    }
    for knob in knobs {
        let measured: Vec<(&Report, &Curve)> = reports
            .iter()
            .flat_map(|report| report.curves.iter().map(move |curve| (report, curve)))
            .filter(|(_, curve)| curve.knob == knob)
            .collect();
        section(&mut html, &measured)?;
    }
    html.push_str("</body></html>\n");
    Ok(html)
}

fn header(html: &mut String, report: &Report) {
    let machine = &report.machine;
    if machine.software {
        let _ = write!(
            html,
            "<p class=\"banner\">{} computes on the CPU: the order of rivals may differ on a GPU.</p>",
            escape(&machine.device)
        );
    }
    let clocks = machine.clocks.as_deref().unwrap_or("not known");
    let rows = [
        ("device", format!("{} ({})", machine.device, machine.kind)),
        ("driver", machine.driver.clone()),
        ("clocks", clocks.to_owned()),
        ("workload", report.workload.clone()),
        ("date", report.date.clone()),
    ];
    html.push_str("<table>");
    for (name, value) in rows {
        let _ = write!(html, "<tr><th>{name}</th><td>{}</td></tr>", escape(&value));
    }
    let _ =
        write!(html, "<tr><th>made by</th><td><code>{}</code></td></tr></table>", escape(&report.command));
    for remark in &report.remarks {
        let _ = write!(html, "<p>{}</p>", escape(remark));
    }
    numbers(html, &report.numbers);
}

fn section(html: &mut String, measured: &[(&Report, &Curve)]) -> Outcome {
    let Some((_, first)) = measured.first() else { return Ok(()) };
    let _ = write!(html, "<h2>{}</h2><p>{}</p>", escape(&first.knob), escape(&first.question));
    let _ = write!(html, "<p>Timed: {}. Error: {}.</p>", escape(&first.timed), escape(&first.norm));
    html.push_str("<div class=\"plots\">");
    for cost in [Cost::Time, Cost::Memory] {
        html.push_str(&plot::error_against(cost, measured)?.unwrap_or_default());
    }
    html.push_str("</div>");
    for (report, curve) in measured {
        if measured.len() > 1 {
            let _ = write!(html, "<h3>{}</h3>", escape(&report.machine.device));
        }
        if curve.points.iter().all(|point| point.error == Errors::default()) {
            html.push_str(&ranking::svg(curve).unwrap_or_default());
        }
        points(html, curve);
        comparisons(html, curve);
    }
    Ok(())
}

fn points(html: &mut String, curve: &Curve) {
    html.push_str(
        "<table><tr><th>setting</th><th>median ms</th><th>p5</th><th>p95</th><th>n</th><th>memory held</th>\
         <th>read + written</th><th>bound</th><th>invocations</th><th>dispatches</th><th>draws</th><th>copies</th>\
         <th>barriers</th>\
         <th>arithmetic error</th><th>setting error</th><th>model error</th>",
    );
    let random = curve.points.iter().any(|point| point.distribution.is_some());
    html.push_str(if random {
        "<th>median</th><th>p99</th><th>largest</th><th>below</th><th>not finite or negative</th></tr>"
    } else {
        "</tr>"
    });
    for point in &curve.points {
        let class = if curve.is_chosen(point) { " class=\"chosen\"" } else { "" };
        let _ = write!(html, "<tr{class}><td>{}</td>", escape(&point.setting));
        for cell in cells(point) {
            let _ = write!(html, "<td>{cell}</td>");
        }
        if random {
            html.push_str(&spread(point.distribution));
        }
        html.push_str("</tr>");
    }
    html.push_str("</table>");
    if let Some(choice) = &curve.chosen {
        let _ = write!(html, "<p>Chosen: <b>{}</b>. {}</p>", escape(&choice.setting), escape(&choice.reason));
    }
}

fn cells(point: &Point) -> Vec<String> {
    let time = point.time();
    let milliseconds = |value: Option<f64>| value.map_or("—".to_owned(), |value| format!("{value:.4}"));
    let error = |value: Option<f64>| value.map_or("—".to_owned(), |value| format!("{value:.2e}"));
    let count = |value: Option<u64>| value.map_or("—".to_owned(), |value| value.to_string());
    vec![
        milliseconds(time.map(|t| t.median)),
        milliseconds(time.map(|t| t.p5)),
        milliseconds(time.map(|t| t.p95)),
        point.milliseconds.len().to_string(),
        bytes(point.memory),
        bytes(point.counts.bytes),
        point.counts.bound.map_or("—".to_owned(), bytes),
        point.counts.invocations.to_string(),
        point.counts.dispatches.to_string(),
        point.counts.draws.to_string(),
        count(point.counts.copies),
        count(point.counts.barriers),
        error(point.error.arithmetic),
        error(point.error.setting),
        error(point.error.model),
    ]
}

/// The cells of errors over random inputs.
fn spread(distribution: Option<Distribution>) -> String {
    let Some(Distribution { median, p99, largest, below, bad }) = distribution else {
        return "<td>—</td>".repeat(5);
    };
    let errors = [median, p99, largest, below].map(|error| format!("<td>{error:.1e}</td>")).concat();
    format!("{errors}<td>{bad}</td>")
}

/// What the pass is held to.
fn numbers(html: &mut String, numbers: &[Number]) {
    if numbers.is_empty() {
        return;
    }
    html.push_str(
        "<h2>numbers</h2><table><tr><th>what</th><th>asked for</th><th>measured</th><th></th></tr>",
    );
    for Number { what, asked, measured, holds } in numbers {
        let verdict = if *holds { "holds" } else { "<b>missed</b>" };
        let cells = [what, asked, measured].map(|text| format!("<td>{}</td>", escape(text))).concat();
        let _ = write!(html, "<tr>{cells}<td>{verdict}</td></tr>");
    }
    html.push_str("</table>");
}

fn comparisons(html: &mut String, curve: &Curve) {
    if curve.comparisons.is_empty() {
        return;
    }
    html.push_str(
        "<table><tr><th>time of</th><th>against</th><th>ratio</th><th>95 % interval</th><th>verdict</th></tr>",
    );
    for comparison in &curve.comparisons {
        let [low, high] = comparison.interval;
        let _ = write!(
            html,
            "<tr><td>{}</td><td>{}</td><td>{:.3}</td><td>{low:.3} – {high:.3}</td><td>{}</td></tr>",
            escape(&comparison.setting),
            escape(&comparison.against),
            comparison.ratio,
            comparison.verdict()
        );
    }
    html.push_str("</table>");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::model::testing;

    #[test]
    fn the_page_is_self_contained_and_warns_of_a_software_device() {
        let html = page(&[testing::report("llvm"), testing::report("another")]).unwrap();
        assert!(html.contains("may differ on a GPU"));
        assert!(html.contains("&lt;yes&gt;"), "text must be escaped");
        assert!(html.contains("<svg"));
        assert!(!html.contains("src=") && !html.contains("href="), "nothing beside the page is needed");
    }
}
