//! Which lights the fog pass evaluates, and which it leaves out.

use airglow::fog::Counts;
use serde::Serialize;

/// Lights of one view.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct LightStat {
    /// Those whose airlight passes the bound somewhere in the picture.
    evaluated: u32,
    /// Those left out of the frame.
    left_out: u32,
    /// Pairs of a tile of the picture and a light that is evaluated in it.
    pairs: u32,
    /// Pairs left out.
    pairs_left_out: u32,
}

impl From<Counts> for LightStat {
    fn from(Counts { evaluated, left_out, pairs, pairs_left_out }: Counts) -> Self {
        Self { evaluated, left_out, pairs, pairs_left_out }
    }
}

impl LightStat {
    /// A line of the text; nothing without a light.
    pub fn line(&self) -> String {
        let Self { evaluated, left_out, pairs, pairs_left_out } = self;
        let (lights, all) = (evaluated + left_out, pairs + pairs_left_out);
        if lights == 0 {
            return String::new();
        }
        format!(
            "  fog: {left_out} of {lights} lights left out, {pairs_left_out} of {all} pairs of a tile and a light\n"
        )
    }
}
