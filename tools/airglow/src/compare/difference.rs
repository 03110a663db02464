//! The signed difference of two pictures: red where the first is brighter, blue where it is darker, white
//! where they agree, with a scale bar that says what full colour means.

use super::glyphs;
use airglow_scene::{FloatImage, luminance};

use super::picture;

const BAR: usize = 10; // height of the colour bar in pixels
const MARGIN: usize = 4;
const INK: [f32; 3] = [0.1, 0.1, 0.1];

/// The picture of `first - second` in luminance, already encoded for display (not linear), and with a scale
/// bar below from `-range` to `+range`. `range` must be positive; larger differences keep the full colour.
/// The pictures must have the same size.
pub fn signed_difference(first: &FloatImage, second: &FloatImage, range: f32) -> FloatImage {
    let (width, height) = (first.width, first.height);
    let scale = if width >= 256 { 2 } else { 1 };
    let footer = MARGIN + BAR + MARGIN + glyphs::LINE * scale + MARGIN;
    let mut picture = picture::from_fn(width, height + footer, |x, y| {
        if y >= height {
            return [1.0; 3];
        }
        let at = y * width + x;
        diverging((luminance(first.pixels[at]) - luminance(second.pixels[at])) / range)
    });
    draw_bar(&mut picture, height + MARGIN);
    let labels_top = height + 2 * MARGIN + BAR;
    let texts = [format!("-{}", number(range)), "0".to_owned(), format!("+{}", number(range))];
    for (text, place) in texts.iter().zip([0.0, 0.5, 1.0]) {
        let room = width.saturating_sub(glyphs::width(text, scale) + 2 * MARGIN);
        let left = MARGIN + (room as f64 * place) as usize;
        glyphs::draw(&mut picture, text, left, labels_top, scale, INK);
    }
    picture
}

fn draw_bar(picture: &mut FloatImage, top: usize) {
    let last = picture.width.saturating_sub(2 * MARGIN + 1).max(1);
    for y in top..top + BAR {
        for x in MARGIN..picture.width.saturating_sub(MARGIN) {
            let signed = 2.0 * (x - MARGIN) as f32 / last as f32 - 1.0;
            picture.pixels[y * picture.width + x] = diverging(signed);
        }
    }
}

/// Blue, white, red for -1, 0, +1; black for what is not a number.
fn diverging(signed: f32) -> [f32; 3] {
    if signed.is_nan() {
        return [0.0; 3];
    }
    const NEGATIVE: [f32; 3] = [0.02, 0.19, 0.60];
    const POSITIVE: [f32; 3] = [0.65, 0.06, 0.10];
    let end = if signed < 0.0 { NEGATIVE } else { POSITIVE };
    // The square root shows small differences; the bar shows the same curve.
    let strength = signed.abs().min(1.0).sqrt();
    end.map(|c| 1.0 + (c - 1.0) * strength)
}

/// Three significant digits in the characters that `glyphs` knows.
pub(super) fn number(value: f32) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e4).contains(&value) {
        let digits = (2 - value.log10().floor() as i32).max(0) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.2e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sign_decides_the_colour_and_equal_pixels_are_white() {
        let first = picture::from_fn(64, 2, |x, _| [if x < 32 { 2.0 } else { 0.0 }; 3]);
        let second = picture::from_fn(64, 2, |_, y| [if y == 0 { 1.0 } else { 2.0 }; 3]);
        let shown = signed_difference(&first, &second, 1.0);
        let (brighter, darker, equal) = (shown.pixels[0], shown.pixels[63], shown.pixels[64]);
        assert!(brighter[0] > brighter[2], "{brighter:?}");
        assert!(darker[2] > darker[0], "{darker:?}");
        assert_eq!(equal, [1.0; 3]);
        assert!(shown.height > 2 + BAR);
    }

    #[test]
    fn numbers_keep_three_digits() {
        assert_eq!(number(0.0123), "0.0123");
        assert_eq!(number(1.5), "1.50");
        assert_eq!(number(250.0), "250");
        assert_eq!(number(8.1e4), "8.10e4");
    }
}
