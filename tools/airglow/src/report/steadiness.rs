//! Differences from frame to frame, as SVG text.

use plotters::prelude::*;

use super::plot::{self, COLOURS};
use crate::failure::{Failure, Outcome};

const SIZE: (u32, u32) = (720, 360);

/// The SVG of a film: first and second differences where no figure is.
pub fn svg(first: &[f64], second: &[f64]) -> Outcome<String> {
    let mut svg = String::new();
    draw(&mut svg, first, second)
        .map_err(|error| Failure::work(format!("could not draw a plot: {error}")))?;
    Ok(svg)
}

fn draw(svg: &mut String, first: &[f64], second: &[f64]) -> Result<(), Box<dyn std::error::Error>> {
    let area = SVGBackend::with_string(svg, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    let top = 1.5 * first.iter().chain(second).copied().fold(1e-9, f64::max);
    let mut chart = ChartBuilder::on(&area)
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(70)
        .build_cartesian_2d(0.0..(first.len() + 2) as f64, 0.0..top)?;
    chart
        .configure_mesh()
        .x_desc("frame")
        .y_desc("RMS difference / mean radiance")
        .label_style(("sans-serif", 13))
        .x_label_formatter(&|frame| format!("{frame:.0}"))
        .y_label_formatter(&|value| format!("{value:.3}"))
        .light_line_style(WHITE)
        .bold_line_style(RGBColor(225, 225, 225))
        .draw()?;
    let lines = [
        ("ground that no figure covers: from the frame before", 2, first),
        ("second difference: of noise 1.73 times the first, of a steady motion far less", 2, second),
    ];
    for (index, (name, start, values)) in lines.into_iter().enumerate() {
        let colour = COLOURS[index % COLOURS.len()];
        let points = values.iter().enumerate().map(|(at, value)| ((at + start) as f64, *value));
        plot::line(&mut chart, name, points, colour, 2)?;
    }
    plot::legend(&mut chart, SeriesLabelPosition::UpperRight)?;
    area.present()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_plot_names_its_lines() {
        let svg = super::svg(&[0.01, 0.02], &[0.001, 0.0]).unwrap();
        assert!(svg.contains("second difference") && svg.contains("frame"), "{svg}");
    }
}
