//! Numbers over a picture as colours, with a legend.

use airglow_scene::{FloatImage, false_colour};

use super::difference::number;
use super::{glyphs, picture};

const NOTHING: [f32; 3] = [0.25; 3];
const PAPER: [f32; 3] = [1.0; 3];
const INK: [f32; 3] = [0.1; 3];
const BAR: usize = 12;
const MARGIN: usize = 6;
const TICKS: usize = 5;

/// Values over a picture; `None` where there is nothing to show.
pub struct Values {
    /// Columns.
    pub width: usize,
    /// Rows from the top.
    pub values: Vec<Option<f32>>,
}

impl Values {
    /// The largest value that is finite, 1 where there is none above 0.
    pub fn largest(&self) -> f32 {
        let finite = self.values.iter().flatten().copied().filter(|value| value.is_finite());
        let largest = finite.fold(0.0, f32::max);
        if largest > 0.0 { largest } else { 1.0 }
    }
}

/// The picture of values from 0 to `high`, encoded for display, above a title and a scale.
pub fn with_legend(values: &Values, high: f32, title: &str) -> FloatImage {
    let (width, height) = (values.width, values.values.len() / values.width.max(1));
    let scale = if width >= 480 { 2 } else { 1 };
    let text = glyphs::LINE * scale;
    let lines = wrapped(title, width.saturating_sub(2 * MARGIN), scale);
    let footer = 4 * MARGIN + BAR + (lines.len() + 1) * text;
    let mut drawn = picture::from_fn(width, height + footer, |x, y| match values.values.get(y * width + x) {
        Some(Some(value)) => false_colour(value / high),
        Some(None) => NOTHING,
        None => PAPER,
    });
    for (number, line) in lines.iter().enumerate() {
        glyphs::draw(&mut drawn, line, MARGIN, height + MARGIN + number * text, scale, INK);
    }
    let (top, span) = (height + 2 * MARGIN + lines.len() * text, width.saturating_sub(2 * MARGIN).max(1));
    for y in top..top + BAR {
        for x in 0..span.min(width) {
            drawn.pixels[y * width + MARGIN.min(width - 1) + x.min(width.saturating_sub(MARGIN + 1))] =
                false_colour(x as f32 / span as f32);
        }
    }
    for tick in 0..TICKS {
        let part = tick as f32 / (TICKS - 1) as f32;
        let label = number(part * high);
        let room = span.saturating_sub(glyphs::width(&label, scale));
        let left = MARGIN + (part * room as f32) as usize;
        glyphs::draw(&mut drawn, &label, left, top + BAR + MARGIN, scale, INK);
    }
    drawn
}

/// The lines of a title, none wider than there is room where a single word is not.
fn wrapped(title: &str, room: usize, scale: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    // The small e is that of numbers.
    for word in title.replace('e', "E").split(' ') {
        let Some(line) = lines.last_mut() else { continue };
        let longer = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
        match glyphs::width(&longer, scale) <= room || line.is_empty() {
            true => *line = longer,
            false => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_title_goes_on_as_many_lines_as_it_needs() {
        assert_eq!(wrapped("one two three", 40, 1), ["onE two", "thrEE"]);
        assert_eq!(wrapped("one", 1, 2), ["onE"]);
    }

    #[test]
    fn the_legend_is_below_the_picture_whatever_its_size() {
        for width in [1, 3, 64, 500] {
            let values = Values { width, values: vec![Some(1.0); 2 * width] };
            let drawn = with_legend(&values, values.largest(), "a title");
            assert!(drawn.height > 2 && drawn.pixels.len() == drawn.width * drawn.height);
            assert_eq!(drawn.pixels[0], false_colour(1.0));
        }
    }
}
