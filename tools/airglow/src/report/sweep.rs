//! Sweeps of a limit as a plot of two panels: the GPU's value over the truth, and the error under its bound.

use plotters::coord::Shift;
use plotters::coord::combinators::LogCoord;
use plotters::prelude::*;

use crate::failure::{Failure, Outcome};

/// A limit approached: what the plot needs of it.
pub struct SweepPlot<'a> {
    /// The parameter and its unit.
    pub parameter: &'a str,
    /// What the values measure.
    pub measure: &'a str,
    /// Parameter, the GPU's value, the truth, the error.
    pub points: Vec<[f64; 4]>,
    /// The largest error allowed.
    pub bound: f64,
}

const SIZE: (u32, u32) = (720, 300);
const GPU: RGBColor = RGBColor(196, 78, 34);
const TRUTH: RGBColor = RGBColor(31, 90, 166);

/// The SVG. Zeros lie on the floor of their logarithmic axis.
pub fn svg(sweep: &SweepPlot<'_>) -> Outcome<String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        let (left, right) = area.split_horizontally(SIZE.0 / 2);
        draw(&area, &left, &right, sweep)
            .map_err(|error| Failure::work(format!("could not draw a sweep: {error}")))?;
    }
    Ok(svg)
}

type Area<'s> = DrawingArea<SVGBackend<'s>, Shift>;

fn draw(
    whole: &Area<'_>,
    left: &Area<'_>,
    right: &Area<'_>,
    sweep: &SweepPlot<'_>,
) -> Result<(), Box<dyn std::error::Error>> {
    whole.fill(&WHITE)?;
    let at = range(sweep.points.iter().map(|point| point[0]));
    let values = range(sweep.points.iter().flat_map(|point| [point[1], point[2]]));
    let errors = range(sweep.points.iter().map(|point| point[3]).chain([sweep.bound]));
    let line = |column: usize, floor: f64| -> Vec<(f64, f64)> {
        sweep.points.iter().map(|point| (point[0], point[column].max(floor))).collect()
    };

    let mut chart = panel(left, at, values, sweep.parameter, sweep.measure)?;
    chart
        .draw_series(LineSeries::new(line(2, values.0), TRUTH.stroke_width(2)))?
        .label("truth")
        .legend(|(x, y)| PathElement::new([(x, y), (x + 14, y)], TRUTH.stroke_width(2)));
    chart
        .draw_series(line(1, values.0).into_iter().map(|point| Circle::new(point, 3, GPU.filled())))?
        .label("GPU")
        .legend(|(x, y)| Circle::new((x + 7, y), 3, GPU.filled()));
    chart.configure_series_labels().background_style(WHITE.mix(0.8)).label_font(("sans-serif", 12)).draw()?;

    let mut chart = panel(right, at, errors, sweep.parameter, "relative error")?;
    let bound = [(at.0, sweep.bound), (at.1, sweep.bound)];
    chart.draw_series(LineSeries::new(bound, BLACK.stroke_width(1)))?;
    chart.draw_series(line(3, errors.0).into_iter().map(|point| Circle::new(point, 3, GPU.filled())))?;
    whole.present()?;
    Ok(())
}

type Panel<'a, 's> = ChartContext<'a, SVGBackend<'s>, Cartesian2d<LogCoord<f64>, LogCoord<f64>>>;

fn panel<'a, 's>(
    area: &'a Area<'s>,
    x: (f64, f64),
    y: (f64, f64),
    x_label: &str,
    y_label: &str,
) -> Result<Panel<'a, 's>, Box<dyn std::error::Error>> {
    let mut chart = ChartBuilder::on(area)
        .margin(10)
        .x_label_area_size(40)
        .y_label_area_size(62)
        .build_cartesian_2d((x.0..x.1).log_scale(), (y.0..y.1).log_scale())?;
    chart
        .configure_mesh()
        .x_desc(x_label)
        .y_desc(y_label)
        .label_style(("sans-serif", 12))
        .x_labels(6)
        .y_labels(6)
        .x_label_formatter(&|value| format!("{value:.0e}"))
        .y_label_formatter(&|value| format!("{value:.0e}"))
        .light_line_style(WHITE)
        .bold_line_style(RGBColor(225, 225, 225))
        .draw()?;
    Ok(chart)
}

/// The span of the positive finite values, widened a little.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let positive = values.filter(|value| *value > 0.0 && value.is_finite());
    let (low, high) =
        positive.fold((f64::MAX, f64::MIN_POSITIVE), |(low, high), v| (low.min(v), high.max(v)));
    if low > high { (0.1, 1.0) } else { (low / 1.5, high * 1.5) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sweep_with_zeros_and_infinities_is_drawn() {
        let points = vec![[1.0, 1.0, 1.0, 0.0], [0.1, 0.0, 0.0, 1e-7], [0.01, f64::INFINITY, 1.0, f64::NAN]];
        let sweep = SweepPlot { parameter: "angle", measure: "norm", points, bound: 1e-5 };
        let svg = svg(&sweep).unwrap();
        assert!(svg.contains("angle") && svg.contains("truth") && svg.contains("GPU"));
    }
}
