//! The truth: the same in f64, one colour at a time.

use crate::Settings;

/// A colour exposed by [`Settings::stops`]; alpha stays. Any linear unit.
pub fn expose(colour: [f64; 4], settings: &Settings) -> [f64; 4] {
    let factor = settings.stops.exp2();
    let [red, green, blue, alpha] = colour;
    [factor * red, factor * green, factor * blue, alpha]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stop_doubles_and_alpha_stays() {
        assert_eq!(expose([1.0, 2.0, 3.0, 0.5], &Settings { stops: 1.0 }), [2.0, 4.0, 6.0, 0.5]);
        assert_eq!(expose([1.0, 2.0, 3.0, 0.5], &Settings { stops: -2.0 }), [0.25, 0.5, 0.75, 0.5]);
    }

    #[test]
    fn stops_add_up() {
        let colour = [0.1, 0.7, 3.0, 1.0];
        let twice = expose(expose(colour, &Settings { stops: 0.3 }), &Settings { stops: 1.1 });
        let once = expose(colour, &Settings { stops: 1.4 });
        for (twice, once) in twice.into_iter().zip(once) {
            assert!((twice / once - 1.0).abs() < 1e-15, "{twice} and {once}");
        }
    }
}
