//! Two pictures of a scene in one.

use clap::ValueEnum;

use super::picture::Picture;

/// Where one picture ends and the other begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Split {
    /// Upright through the middle.
    Half,
    /// Aslant through the middle, from the upper right to the lower left.
    Diagonal,
}

/// Columns of a row that lie left of the line through the middle; the slant leaves out a fifth of the width at both sides.
fn left(split: Split, row: usize, [width, height]: [usize; 2]) -> usize {
    match split {
        Split::Half => width / 2,
        Split::Diagonal => {
            let down = (row as f64 + 0.5) / height as f64;
            ((0.8 - 0.6 * down) * width as f64) as usize
        }
    }
}

impl Picture {
    /// Puts the left part of another picture of the same size in place of this one's.
    pub fn replace_left(&mut self, other: &Self, split: Split) {
        let (width, height) = (self.linear.width, self.linear.height);
        for row in 0..height {
            let from = row * width;
            let left = from..from + left(split, row, [width, height]);
            self.linear.pixels[left.clone()].copy_from_slice(&other.linear.pixels[left.clone()]);
            self.display[left.clone()].copy_from_slice(&other.display[left]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_lines_halve_the_picture() {
        for split in [Split::Half, Split::Diagonal] {
            let columns: usize = (0..90).map(|row| left(split, row, [160, 90])).sum();
            assert!(columns.abs_diff(160 * 90 / 2) < 90, "{split:?}: {columns}");
        }
    }
}
