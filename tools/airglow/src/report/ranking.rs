//! Times of rivals that differ in nothing else, as SVG: a row for each, the fastest on top.

use std::fmt::Write;

use super::model::Curve;
use crate::text::escape;

/// Pixels: a row, where the bars begin, and their greatest length.
const ROW: f64 = 18.0;
const LEFT: f64 = 270.0;
const LENGTH: f64 = 380.0;

/// The SVG of a curve; `None` without times.
pub fn svg(curve: &Curve) -> Option<String> {
    let timed = curve.points.iter().filter_map(|point| Some((point, point.time()?)));
    let mut rows: Vec<_> = timed.collect();
    rows.sort_by(|a, b| a.1.median.total_cmp(&b.1.median));
    let longest = rows.iter().map(|(_, time)| time.p95).fold(0.0, f64::max);
    if longest <= 0.0 {
        return None;
    }
    let height = ROW * (rows.len() as f64 + 2.0);
    let mut svg = format!(
        "<svg width=\"720\" height=\"{height}\" viewBox=\"0 0 720 {height}\" xmlns=\"http://www.w3.org/2000/svg\" \
         font-family=\"sans-serif\" font-size=\"12\"><text x=\"{LEFT}\" y=\"13\">milliseconds: median; line from 5th to \
         95th percentile</text>"
    );
    for (row, (point, time)) in (1..).zip(&rows) {
        let y = ROW * (f64::from(row) + 0.5);
        let [low, middle, high] = [time.p5, time.median, time.p95].map(|ms| LEFT + LENGTH * ms / longest);
        let colour = if curve.is_chosen(point) { "#c44e22" } else { "#1f5aa6" };
        let _ = write!(
            svg,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text><rect x=\"{LEFT}\" y=\"{}\" width=\"{}\" height=\"8\" \
             fill=\"{colour}\"/><path d=\"M{low} {y}H{high}\" stroke=\"black\"/><text x=\"{}\" y=\"{}\">{:.3}</text>",
            LEFT - 8.0,
            y + 4.0,
            escape(&point.setting),
            y - 4.0,
            middle - LEFT,
            high + 6.0,
            y + 4.0,
            time.median
        );
    }
    svg.push_str("</svg>");
    Some(svg)
}

#[cfg(test)]
mod tests {
    use crate::report::model::testing;

    #[test]
    fn the_fastest_is_on_top() {
        let svg = super::svg(&testing::report("a device").curves[0]).unwrap();
        assert!(svg.find("coarse").unwrap() < svg.find("fine").unwrap(), "{svg}");
    }
}
