//! The sweep of the knob that reports and tests measure, and the error that is allowed along it.

use crate::{MAX_STOPS, Settings};

/// Largest relative error of a colour on the device: the factor and the product are rounded to f32, each by 2^-24 at
/// most. Colours below the normal range of f32 are excepted.
pub const RELATIVE_ERROR: f64 = 1.0 / (1u64 << 23) as f64;

/// Exposures from one end of the range to the other, whole stops and what lies between.
pub fn sweep() -> impl Iterator<Item = Settings> {
    const STEPS: u32 = 12;
    (0..=STEPS).map(|step| Settings { stops: MAX_STOPS * (2.0 * f64::from(step) / f64::from(STEPS) - 1.0) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sweep_goes_from_end_to_end_within_the_range() {
        let stops: Vec<f64> = sweep().map(|settings| settings.stops).collect();
        assert_eq!((stops[0], stops[stops.len() - 1]), (-MAX_STOPS, MAX_STOPS));
        assert!(sweep().all(|settings| settings.check().is_ok()));
    }
}
