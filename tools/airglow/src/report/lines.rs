//! Lines over two logarithmic axes, as SVG text.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::plot::{self, COLOURS, axes, range};
use crate::failure::{Failure, Outcome};

const SIZE: (u32, u32) = (720, 400);

/// A line and its name.
pub struct Series {
    /// In the legend.
    pub name: String,
    /// Positive values.
    pub points: Vec<(f64, f64)>,
}

/// The SVG of some lines; the first is drawn broad, as the truth that others are seen against.
pub fn svg(x_label: &str, y_label: &str, series: &[Series]) -> Outcome<String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        draw(&area, [x_label, y_label], series)
            .map_err(|error| Failure::work(format!("could not draw a plot: {error}")))?;
    }
    Ok(svg)
}

fn draw(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    [x_label, y_label]: [&str; 2],
    series: &[Series],
) -> Result<(), Box<dyn std::error::Error>> {
    let all = || series.iter().flat_map(|series| &series.points);
    let (x, y) = (range(all().map(|point| point.0)), range(all().map(|point| point.1)));
    let mut chart = axes(area, (x_label, x), (y_label, y))?;
    for (index, line) in series.iter().enumerate() {
        let (colour, width) = match index {
            0 => (RGBColor(190, 190, 190), 7),
            _ => (COLOURS[(index - 1) % COLOURS.len()], 2),
        };
        plot::line(&mut chart, &line.name, line.points.iter().copied(), colour, width)?;
    }
    // Lines that rise end where the names would be.
    let rises =
        |line: &Series| line.points.first().zip(line.points.last()).is_some_and(|(a, b)| b.1 > 2.0 * a.1);
    let corner = match series.iter().any(rises) {
        true => SeriesLabelPosition::UpperLeft,
        false => SeriesLabelPosition::UpperRight,
    };
    plot::legend(&mut chart, corner)?;
    area.present()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plot_names_every_line_and_axis() {
        let line = |name: &str, slope: f64| Series {
            name: name.into(),
            points: (1..9).map(|x| (f64::from(x), slope * f64::from(x))).collect(),
        };
        let svg = svg("distance", "brightness", &[line("truth", 1.0), line("ours", 1.1)]).unwrap();
        for text in ["truth", "ours", "distance", "brightness", "<svg"] {
            assert!(svg.contains(text), "{text}");
        }
    }
}
