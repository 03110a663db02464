//! Plots as SVG text that is pasted into the page: error against time, and error against memory, both
//! logarithmic; the Pareto front joined by a line, the chosen point ringed.

use plotters::coord::combinators::WithKeyPoints;
use plotters::coord::{CoordTranslate, Shift};
use plotters::prelude::*;

use super::labels::Labels;
use super::model::{Column, Curve, Point, Report};
use super::pareto;
use crate::failure::{Failure, Outcome};

const SIZE: (u32, u32) = (720, 440);
/// Of lines and points, in their order.
pub(super) const COLOURS: [RGBColor; 6] = [
    RGBColor(31, 90, 166),
    RGBColor(196, 78, 34),
    RGBColor(34, 128, 70),
    RGBColor(128, 62, 150),
    RGBColor(150, 120, 20),
    RGBColor(90, 90, 90),
];

/// What lies along the horizontal axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// Median milliseconds.
    Time,
    /// Bytes of memory.
    Memory,
}

impl Cost {
    fn of(self, point: &Point) -> Option<f64> {
        match self {
            Cost::Time => point.time().map(|time| time.median),
            Cost::Memory => (point.memory > 0).then_some(point.memory as f64 / 1024.0),
        }
    }

    fn label(self) -> &'static str {
        match self {
            Cost::Time => "milliseconds (median; bars from 5th to 95th percentile)",
            Cost::Memory => "memory, KiB",
        }
    }
}

/// A point as the plot needs it.
struct Dot {
    cost: f64,
    error: f64,
    spread: Option<(f64, f64)>,
    setting: String,
    chosen: bool,
}

/// The SVG of one knob over all reports that measured it; `None` if no two points have a cost and an error.
pub fn error_against(cost: Cost, reports: &[(&Report, &Curve)]) -> Outcome<Option<String>> {
    let column = Column::telling(reports.iter().flat_map(|(_, curve)| &curve.points));
    let series: Vec<(String, Vec<Dot>)> = reports
        .iter()
        .map(|(report, curve)| (report.machine.device.clone(), dots(cost, column, curve)))
        .filter(|(_, dots)| !dots.is_empty())
        .collect();
    let all = || series.iter().flat_map(|(_, dots)| dots);
    if all().count() < 2 {
        return Ok(None);
    }
    let costs = range(all().flat_map(|dot| [dot.cost, dot.spread.map_or(dot.cost, |s| s.1)]));
    let errors = range(all().map(|dot| dot.error));
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        draw(&area, [cost.label(), column.label()], &series, costs, errors)
            .map_err(|error| Failure::work(format!("could not draw a plot: {error}")))?;
    }
    Ok(Some(svg))
}

fn dots(cost: Cost, column: Column, curve: &Curve) -> Vec<Dot> {
    let make = |point: &Point| {
        let (at, error) = (cost.of(point)?, column.of(&point.error)?);
        let spread = if cost == Cost::Time { point.time().map(|time| (time.p5, time.p95)) } else { None };
        let visible = at > 0.0 && error > 0.0 && at.is_finite() && error.is_finite();
        visible.then(|| Dot {
            cost: at,
            error,
            spread,
            setting: point.setting.clone(),
            chosen: curve.is_chosen(point),
        })
    };
    curve.points.iter().filter_map(make).collect()
}

/// The smallest and largest value with a margin that is even on a logarithmic axis, and wide enough to hold some ticks.
pub(super) fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::MAX, f64::MIN_POSITIVE), |(low, high), v| (low.min(v), high.max(v)));
    let margin = (high / low).powf(0.12).max(1.3).max((6.0 * low / high).sqrt());
    (low / margin, high * margin)
}

/// Round values within a range: 1, 2 and 5 times the powers of ten, or the powers alone where those are many.
pub(super) fn ticks((low, high): (f64, f64)) -> Vec<f64> {
    let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    let steps: &[f64] = if last - first > 3 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let all = (first..=last).flat_map(|power| steps.iter().map(move |step| step * 10.0_f64.powi(power)));
    all.filter(|tick| (low..=high).contains(tick)).collect()
}

/// A chart with two logarithmic axes.
type Chart<'a, 'b> =
    ChartContext<'a, SVGBackend<'b>, Cartesian2d<WithKeyPoints<LogCoord<f64>>, WithKeyPoints<LogCoord<f64>>>>;

/// Two logarithmic axes on a white ground, each with its label and range.
pub(super) fn axes<'a, 'b>(
    area: &'a DrawingArea<SVGBackend<'b>, Shift>,
    (x_label, x): (&str, (f64, f64)),
    (y_label, y): (&str, (f64, f64)),
) -> Result<Chart<'a, 'b>, Box<dyn std::error::Error>> {
    area.fill(&WHITE)?;
    let mut chart =
        ChartBuilder::on(area).margin(12).x_label_area_size(42).y_label_area_size(70).build_cartesian_2d(
            (x.0..x.1).log_scale().with_key_points(ticks(x)),
            (y.0..y.1).log_scale().with_key_points(ticks(y)),
        )?;
    chart
        .configure_mesh()
        .x_desc(x_label)
        .y_desc(y_label)
        .label_style(("sans-serif", 13))
        .x_label_formatter(&|value| short(*value))
        .y_label_formatter(&|value| short(*value))
        .light_line_style(WHITE)
        .bold_line_style(RGBColor(215, 215, 215))
        .draw()?;
    Ok(chart)
}

fn draw(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    [x_label, y_label]: [&str; 2],
    series: &[(String, Vec<Dot>)],
    costs: (f64, f64),
    errors: (f64, f64),
) -> Result<(), Box<dyn std::error::Error>> {
    let mut chart = axes(area, (x_label, costs), (y_label, errors))?;
    for (index, (device, dots)) in series.iter().enumerate() {
        let colour = COLOURS[index % COLOURS.len()];
        let pairs: Vec<(f64, f64)> = dots.iter().map(|dot| (dot.cost, dot.error)).collect();
        let front: Vec<(f64, f64)> = pareto::front(&pairs).into_iter().map(|i| pairs[i]).collect();
        line(&mut chart, device, front, colour, 2)?;
        let bars = dots.iter().filter_map(|dot| dot.spread.map(|spread| (dot, spread)));
        chart.draw_series(bars.map(|(dot, (p5, p95))| {
            PathElement::new([(p5, dot.error), (p95, dot.error)], colour.mix(0.5).stroke_width(1))
        }))?;
        chart.draw_series(dots.iter().map(|dot| Circle::new((dot.cost, dot.error), 4, colour.filled())))?;
        let ringed = dots.iter().filter(|dot| dot.chosen);
        chart.draw_series(ringed.map(|dot| Circle::new((dot.cost, dot.error), 9, BLACK.stroke_width(2))))?;
    }
    let dots = || series.iter().flat_map(|(_, dots)| dots);
    let mut labels = Labels::new(SIZE, dots().map(|dot| chart.backend_coord(&(dot.cost, dot.error))));
    for dot in dots() {
        let offset = labels.place(chart.backend_coord(&(dot.cost, dot.error)), &dot.setting);
        chart.draw_series(std::iter::once(
            EmptyElement::at((dot.cost, dot.error))
                + Text::new(dot.setting.clone(), offset, ("sans-serif", 13)),
        ))?;
    }
    legend(&mut chart, SeriesLabelPosition::UpperRight)?;
    area.present()?;
    Ok(())
}

/// A line that the legend names.
pub(super) fn line<'a, C: CoordTranslate<From = (f64, f64)>>(
    chart: &mut ChartContext<'a, SVGBackend<'_>, C>,
    name: &str,
    points: impl IntoIterator<Item = (f64, f64)>,
    colour: RGBColor,
    width: u32,
) -> Result<(), Box<dyn std::error::Error>> {
    chart
        .draw_series(LineSeries::new(points, colour.stroke_width(width)))?
        .label(name)
        .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(width)));
    Ok(())
}

/// The names of all lines, in a corner.
pub(super) fn legend<'a, 'b: 'a, C: CoordTranslate>(
    chart: &mut ChartContext<'a, SVGBackend<'b>, C>,
    corner: SeriesLabelPosition,
) -> Result<(), Box<dyn std::error::Error>> {
    chart
        .configure_series_labels()
        .position(corner)
        .background_style(WHITE.mix(0.85))
        .border_style(RGBColor(200, 200, 200))
        .label_font(("sans-serif", 13))
        .draw()?;
    Ok(())
}

/// A number in few digits.
pub(super) fn short(value: f64) -> String {
    if (0.01..1e6).contains(&value) {
        format!("{}", (value * 1e4).round() / 1e4)
    } else {
        format!("{value:.0e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::model::testing;

    #[test]
    fn the_plot_names_every_setting_and_device() {
        let report = testing::report("a test device");
        let svg = error_against(Cost::Time, &[(&report, &report.curves[0])]).unwrap().unwrap();
        for text in ["coarse", "fine", "a test device", "<svg"] {
            assert!(svg.contains(text), "{text}");
        }
    }

    #[test]
    fn ticks_are_round_and_within() {
        assert_eq!(ticks((0.9, 6.0)), [1.0, 2.0, 5.0]);
        assert_eq!(ticks((1e-8, 2e-4)).len(), 5);
    }

    #[test]
    fn nothing_to_plot_is_no_plot() {
        let mut report = testing::report("a test device");
        report.curves[0].points.truncate(1);
        assert!(error_against(Cost::Time, &[(&report, &report.curves[0])]).unwrap().is_none());
    }
}
