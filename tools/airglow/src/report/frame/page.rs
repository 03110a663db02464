//! The part of the page that shows a whole frame.

use std::fmt::Write;

use crate::failure::Outcome;
use crate::report::lines::{self, Series};
use crate::report::model::frame::{FrameReport, PresetFrame, median_interval};
use crate::report::model::scaling::Scaling;
use crate::report::model::{Point, Summary};
use crate::text::{bytes, escape};

/// Appends it.
pub fn section(html: &mut String, frame: &FrameReport) -> Outcome {
    let [width, height] = frame.size;
    let _ = write!(
        html,
        "<h2>the frame, {width} x {height}</h2><p>Median device milliseconds of each pass with the 95 % bootstrap interval of \
         the median, by preset of all passes; frames of all presets run in turn, and near emitters are sampled anew in each. \
         Counts are dispatches, draws and barriers, the same on every machine.</p>"
    );
    times(html, frame);
    bars(html, &frame.presets);
    memory(html, &frame.presets);
    left_out(html, frame);
    if !frame.scalings.is_empty() {
        html.push_str("<h2>how time grows</h2><div class=\"plots\">");
        for scaling in &frame.scalings {
            html.push_str(&growth(scaling)?);
        }
        html.push_str("</div>");
        frame.scalings.iter().for_each(|scaling| sizes(html, scaling));
    }
    Ok(())
}

fn heading(html: &mut String, first: &str, presets: &[PresetFrame]) {
    let names: String = presets.iter().map(|frame| format!("<th>{}</th>", escape(&frame.preset))).collect();
    let _ = write!(html, "<table><tr><th>{first}</th>{names}</tr>");
}

fn row(html: &mut String, name: &str, cells: impl Iterator<Item = String>) {
    let cells: String = cells.map(|cell| format!("<td>{cell}</td>")).collect();
    let _ = write!(html, "<tr><td>{}</td>{cells}</tr>", escape(name));
}

/// The names of all passes of all presets, in the order in which they run.
fn names(presets: &[PresetFrame]) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for pass in presets.iter().flat_map(|frame| &frame.passes) {
        if !names.contains(&pass.name.as_str()) {
            names.push(&pass.name);
        }
    }
    names
}

fn interval(samples: &[f64]) -> String {
    median_interval(samples)
        .map_or("—".to_owned(), |[median, low, high]| format!("{median:.3} ({low:.3} – {high:.3})"))
}

fn times(html: &mut String, frame: &FrameReport) {
    heading(html, "pass", &frame.presets);
    for name in names(&frame.presets) {
        let of = |frame: &PresetFrame| {
            let pass = frame.passes.iter().find(|pass| pass.name == name);
            pass.map_or("—".to_owned(), |pass| {
                let [dispatches, draws, barriers] = pass.counts;
                format!("{}<br>{dispatches}, {draws}, {barriers}", interval(&pass.milliseconds))
            })
        };
        row(html, name, frame.presets.iter().map(of));
    }
    row(html, "all", frame.presets.iter().map(|frame| interval(&frame.total())));
    let error = |frame: &PresetFrame| frame.error.map_or("—".to_owned(), |error| format!("{error:.2e}"));
    row(html, "picture: relative L2 against the last preset's", frame.presets.iter().map(error));
    html.push_str("</table>");
}

/// A bar for each preset, of the medians of its passes.
fn bars(html: &mut String, presets: &[PresetFrame]) {
    const COLOURS: [&str; 8] =
        ["#1f5aa6", "#c44e22", "#228046", "#803e96", "#967814", "#5a5a5a", "#3aa6a6", "#a63a6a"];
    let median = |samples: &[f64]| Summary::of(samples).map_or(0.0, |time| time.median);
    let longest = presets.iter().map(|frame| median(&frame.total())).fold(0.0, f64::max);
    if longest <= 0.0 {
        return;
    }
    let names = names(presets);
    let height = 24 * presets.len() + 18 * names.len() + 10;
    let _ = write!(
        html,
        "<svg width=\"720\" height=\"{height}\" xmlns=\"http://www.w3.org/2000/svg\" font-family=\"sans-serif\" font-size=\"12\">"
    );
    for (line, frame) in presets.iter().enumerate() {
        let (mut left, top) = (100.0, 24 * line + 4);
        let _ = write!(html, "<text x=\"4\" y=\"{}\">{}</text>", top + 13, escape(&frame.preset));
        for pass in &frame.passes {
            let width = 600.0 * median(&pass.milliseconds) / longest;
            let place = names.iter().position(|name| *name == pass.name).unwrap_or(0);
            let colour = COLOURS[place % COLOURS.len()];
            let _ = write!(
                html,
                "<rect x=\"{left:.1}\" y=\"{top}\" width=\"{width:.1}\" height=\"18\" fill=\"{colour}\"/>"
            );
            left += width;
        }
    }
    for (line, name) in names.iter().enumerate() {
        let (top, colour) = (24 * presets.len() + 18 * line + 6, COLOURS[line % COLOURS.len()]);
        let _ = write!(
            html,
            "<rect x=\"100\" y=\"{top}\" width=\"12\" height=\"12\" fill=\"{colour}\"/><text x=\"118\" y=\"{}\">{}</text>",
            top + 11,
            escape(name)
        );
    }
    html.push_str("</svg>");
}

fn memory(html: &mut String, presets: &[PresetFrame]) {
    html.push_str(
        "<h3>memory</h3><p>Resources of the plan: those that are there before, and those of the frame. Below, what the device \
         holds for each owner, frames' own memory with it.</p>",
    );
    heading(html, "bytes", presets);
    row(html, "imported", presets.iter().map(|frame| bytes(frame.imported)));
    row(html, "of the frame", presets.iter().map(|frame| bytes(frame.transient)));
    let mut owners: Vec<&str> = Vec::new();
    for (owner, _) in presets.iter().flat_map(|frame| &frame.memory) {
        if !owners.contains(&owner.as_str()) {
            owners.push(owner);
        }
    }
    for owner in owners {
        let held = |frame: &PresetFrame| {
            frame.memory.iter().find(|(name, _)| name == owner).map_or(0, |held| held.1)
        };
        row(html, owner, presets.iter().map(|frame| bytes(held(frame))));
    }
    html.push_str("</table>");
}

fn left_out(html: &mut String, frame: &FrameReport) {
    html.push_str("<h3>left out</h3>");
    if frame.left_out.is_empty() {
        html.push_str("<p>Nothing.</p>");
        return;
    }
    html.push_str("<table><tr><th>what</th><th>why</th><th>saves</th><th>returns with</th></tr>");
    for missing in &frame.left_out {
        let cells = [missing.why.clone(), bytes(missing.bytes), missing.would_return.clone()];
        row(html, &missing.what, cells.iter().map(|cell| escape(cell)));
    }
    html.push_str("</table>");
}

/// The plot of a sweep: a line of the larger half's slope through its last point, and the medians; nothing without times.
fn growth(scaling: &Scaling) -> Outcome<String> {
    let median = |(at, point): &(f64, Point)| Some((*at, Summary::of(&point.milliseconds)?.median));
    let measured: Vec<(f64, f64)> = scaling.points.iter().filter_map(median).collect();
    let (Some([_, upper]), Some(last)) = (scaling.slopes, measured.last().copied()) else {
        return Ok(String::new());
    };
    let fitted = measured.iter().map(|(at, _)| (*at, last.1 * (at / last.0).powf(upper[0]))).collect();
    let series = [
        Series { name: format!("slope {:.2}", upper[0]), points: fitted },
        Series { name: "median of the rounds".to_owned(), points: measured },
    ];
    lines::svg(&scaling.what, "milliseconds", &series)
}

fn sizes(html: &mut String, scaling: &Scaling) {
    let _ = write!(html, "<h3>{}</h3><p>Timed: {}.", escape(&scaling.what), escape(&scaling.timed));
    if let Some([all, larger]) = scaling.slopes {
        let words = |[slope, low, high]: [f64; 3]| format!("{slope:.2} ({low:.2} – {high:.2})");
        let _ = write!(
            html,
            " Slope of time over size in logarithms: {} over all, {} over the larger half.",
            words(all),
            words(larger)
        );
    }
    if !scaling.cut.is_empty() {
        let _ = write!(html, " Not measured: {}.", escape(&scaling.cut));
    }
    html.push_str(
        "</p><table><tr><th>size</th><th>milliseconds</th><th>each one more, us</th><th>dispatches</th><th>draws</th><th>memory</th></tr>",
    );
    let median = |place: usize| Summary::of(&scaling.points[place].1.milliseconds).map(|time| time.median);
    for (place, (at, point)) in scaling.points.iter().enumerate() {
        let before =
            place.checked_sub(1).and_then(|before| Some((scaling.points[before].0, median(before)?)));
        let more = before.zip(median(place)).map(|((size, time), own)| 1e3 * (own - time) / (at - size));
        let more = more.map_or("—".to_owned(), |more| format!("{more:.3}"));
        let counts =
            [point.counts.dispatches.to_string(), point.counts.draws.to_string(), bytes(point.memory)];
        row(html, &format!("{at}"), [interval(&point.milliseconds), more].into_iter().chain(counts));
    }
    html.push_str("</table>");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::model::testing;

    #[test]
    fn growth_is_drawn_with_its_slope_and_not_without_times() {
        let point = |at: f64| {
            let mut point = testing::report("a device").curves.remove(0).points.remove(0);
            point.milliseconds = vec![at * at];
            (at, point)
        };
        let of = |points| Scaling::new("things", "all".to_owned(), "", points);
        let svg = growth(&of([1.0, 10.0, 100.0, 1000.0].map(point).into())).unwrap();
        assert!(svg.contains("slope 2.00") && svg.contains("things"), "{svg}");
        assert!(growth(&of(Vec::new())).unwrap().is_empty());
    }
}
