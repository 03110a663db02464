//! The characters that scale bars and their titles need, drawn as 3 x 5 blocks: no font file is read or shipped.

use airglow_scene::FloatImage;

/// Height of a line of text before enlargement, including the gap below it.
pub const LINE: usize = 6;
const ADVANCE: usize = 4;

/// Rows of three from the top, most significant bit left; `None` leaves a gap.
fn rows(character: char) -> Option<[u8; 5]> {
    Some(match character {
        '0' => [0b111, 0b101, 0b101, 0b101, 0b111],
        '1' => [0b010, 0b110, 0b010, 0b010, 0b111],
        '2' => [0b111, 0b001, 0b111, 0b100, 0b111],
        '3' => [0b111, 0b001, 0b111, 0b001, 0b111],
        '4' => [0b101, 0b101, 0b111, 0b001, 0b001],
        '5' => [0b111, 0b100, 0b111, 0b001, 0b111],
        '6' => [0b111, 0b100, 0b111, 0b101, 0b111],
        '7' => [0b111, 0b001, 0b010, 0b010, 0b010],
        '8' => [0b111, 0b101, 0b111, 0b101, 0b111],
        '9' => [0b111, 0b101, 0b111, 0b001, 0b111],
        '+' => [0b000, 0b010, 0b111, 0b010, 0b000],
        '-' => [0b000, 0b000, 0b111, 0b000, 0b000],
        '.' => [0b000, 0b000, 0b000, 0b000, 0b010],
        'e' => [0b000, 0b111, 0b101, 0b110, 0b111],
        'a' => [0b010, 0b101, 0b111, 0b101, 0b101],
        'b' => [0b110, 0b101, 0b110, 0b101, 0b110],
        'c' => [0b011, 0b100, 0b100, 0b100, 0b011],
        'd' => [0b110, 0b101, 0b101, 0b101, 0b110],
        'E' => [0b111, 0b100, 0b110, 0b100, 0b111],
        'f' => [0b111, 0b100, 0b110, 0b100, 0b100],
        'g' => [0b011, 0b100, 0b101, 0b101, 0b011],
        'h' => [0b101, 0b101, 0b111, 0b101, 0b101],
        'i' => [0b111, 0b010, 0b010, 0b010, 0b111],
        'j' => [0b001, 0b001, 0b001, 0b101, 0b010],
        'k' => [0b101, 0b110, 0b100, 0b110, 0b101],
        'l' => [0b100, 0b100, 0b100, 0b100, 0b111],
        'm' => [0b101, 0b111, 0b111, 0b101, 0b101],
        'n' => [0b110, 0b101, 0b101, 0b101, 0b101],
        'o' => [0b010, 0b101, 0b101, 0b101, 0b010],
        'p' => [0b110, 0b101, 0b110, 0b100, 0b100],
        'q' => [0b010, 0b101, 0b101, 0b110, 0b011],
        'r' => [0b110, 0b101, 0b110, 0b110, 0b101],
        's' => [0b011, 0b100, 0b010, 0b001, 0b110],
        't' => [0b111, 0b010, 0b010, 0b010, 0b010],
        'u' => [0b101, 0b101, 0b101, 0b101, 0b111],
        'v' => [0b101, 0b101, 0b101, 0b101, 0b010],
        'w' => [0b101, 0b101, 0b111, 0b111, 0b101],
        'x' => [0b101, 0b101, 0b010, 0b101, 0b101],
        'y' => [0b101, 0b101, 0b010, 0b010, 0b010],
        'z' => [0b111, 0b001, 0b010, 0b100, 0b111],
        '\'' => [0b010, 0b010, 0b000, 0b000, 0b000],
        ':' => [0b000, 0b010, 0b000, 0b010, 0b000],
        '/' => [0b001, 0b001, 0b010, 0b100, 0b100],
        ',' => [0b000, 0b000, 0b000, 0b010, 0b100],
        '(' => [0b001, 0b010, 0b010, 0b010, 0b001],
        ')' => [0b100, 0b010, 0b010, 0b010, 0b100],
        _ => return None,
    })
}

/// Width in pixels of `text` at an enlargement of `scale`.
pub fn width(text: &str, scale: usize) -> usize {
    text.chars().count() * ADVANCE * scale
}

/// Draws `text` with its top left corner at (`left`, `top`); what falls outside the picture is cut off.
pub fn draw(picture: &mut FloatImage, text: &str, left: usize, top: usize, scale: usize, colour: [f32; 3]) {
    for (position, character) in text.chars().enumerate() {
        let Some(rows) = rows(character) else { continue };
        for (row, bits) in rows.iter().enumerate() {
            for column in (0..3).filter(|column| bits >> (2 - column) & 1 == 1) {
                block(
                    picture,
                    left + (position * ADVANCE + column) * scale,
                    top + row * scale,
                    scale,
                    colour,
                );
            }
        }
    }
}

fn block(picture: &mut FloatImage, left: usize, top: usize, size: usize, colour: [f32; 3]) {
    for y in top..(top + size).min(picture.height) {
        for x in left..(left + size).min(picture.width) {
            picture.pixels[y * picture.width + x] = colour;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::picture;

    #[test]
    fn all_characters_are_known_and_distinct() {
        let characters = "0123456789+-.abcdeEfghijklmnopqrstuvwxyz:/,()'";
        let mut shapes: Vec<_> = characters.chars().map(|c| rows(c).unwrap()).collect();
        shapes.sort_unstable();
        shapes.dedup();
        assert_eq!(shapes.len(), characters.len());
    }

    #[test]
    fn text_past_the_border_is_cut_off() {
        let mut picture = picture::from_fn(5, 4, |_, _| [0.0; 3]);
        draw(&mut picture, "88", 3, 2, 2, [1.0; 3]);
        assert!(picture.pixels[4 * 3 - 1 + 3][0] > 0.0);
    }
}
