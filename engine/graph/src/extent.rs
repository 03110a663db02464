//! Extents that follow the frame's or another image's, resolved when the graph is compiled.

use crate::handle::{Handle, Image, ResourceId};

/// What a relative extent is measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ExtentBase {
    /// The frame ([`Options::frame_extent`](crate::Options::frame_extent)).
    Frame,
    /// Mip 0 of an image declared before.
    Image(ResourceId),
}

/// Width and height as a ratio of something else's: `base * numerator / denominator`, rounded up, at least 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct RelativeExtent {
    /// What it is measured in.
    pub base: ExtentBase,
    /// At least 1.
    pub numerator: u32,
    /// At least 1.
    pub denominator: u32,
}

impl RelativeExtent {
    /// `numerator / denominator` of the frame.
    pub const fn of_frame(numerator: u32, denominator: u32) -> Self {
        Self { base: ExtentBase::Frame, numerator, denominator }
    }

    /// `numerator / denominator` of mip 0 of an image.
    pub fn of_image(image: &Handle<Image>, numerator: u32, denominator: u32) -> Self {
        Self { base: ExtentBase::Image(image.resource()), numerator, denominator }
    }

    /// The ratio of `side`; `None` for a ratio with a zero, or past 32 bits.
    pub(crate) fn of_side(self, side: u32) -> Option<u32> {
        if self.numerator == 0 || self.denominator == 0 {
            return None;
        }
        let scaled = u64::from(side) * u64::from(self.numerator);
        u32::try_from(scaled.div_ceil(u64::from(self.denominator)).max(1)).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ratio_rounds_up_and_refuses_zeros_and_overflow() {
        let half = RelativeExtent::of_frame(1, 2);
        assert_eq!([1, 2, 641].map(|side| half.of_side(side)), [Some(1), Some(1), Some(321)]);
        assert_eq!(RelativeExtent::of_frame(1, 0).of_side(8), None);
        assert_eq!(RelativeExtent::of_frame(0, 2).of_side(8), None);
        assert_eq!(RelativeExtent::of_frame(u32::MAX, 1).of_side(2), None);
    }
}
