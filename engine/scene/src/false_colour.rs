//! Colours for numbers: `shaders/glsl/common/false_colour.glsl` on the CPU.

/// sRGB-encoded colours at equal steps.
const STOPS: [[f32; 3]; 6] = [
    [0.06, 0.02, 0.22],
    [0.20, 0.18, 0.56],
    [0.09, 0.45, 0.60],
    [0.20, 0.67, 0.44],
    [0.68, 0.84, 0.24],
    [1.00, 0.97, 0.72],
];

/// The colour of a value from 0 to 1 for a display, sRGB-encoded: from dark blue through green to pale yellow, ever brighter.
/// Values outside take the colour of the nearest end; what is not a number is magenta.
#[must_use]
pub fn false_colour(value: f32) -> [f32; 3] {
    if value.is_nan() {
        return [1.0, 0.0, 1.0];
    }
    let place = 5.0 * value.clamp(0.0, 1.0);
    let below = (place as usize).min(4);
    let part = place - below as f32;
    [0, 1, 2].map(|c| STOPS[below][c] + part * (STOPS[below + 1][c] - STOPS[below][c]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_grow_brighter_and_ends_hold() {
        let ramp: Vec<f32> = (0..=50).map(|i| crate::luminance(false_colour(i as f32 / 50.0))).collect();
        assert!(ramp.is_sorted(), "{ramp:?}");
        assert_eq!((false_colour(-3.0), false_colour(9.0)), (STOPS[0], STOPS[5]));
        assert_eq!(false_colour(f32::NAN), [1.0, 0.0, 1.0]);
    }
}
