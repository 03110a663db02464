//! Airlight in closed form for an isotropic phase function and a homogeneous medium: two values of the scaled
//! exponential integral.
//!
//! `∫ exp(-β q) / (h² + (m + q)²) dq` over all q >= 0 is `Im(exp(z) E1(z)) / h` at `z = β (m - i h)`, the airlight of an
//! endless stretch. Beyond |z| = 1 it is a short sum of simple poles, `β Σ c / (u² + (w + q)²)`: a quadrature of the
//! same integral whose nodes were fitted for the least largest relative error over the whole quarter plane, so every
//! term is positive and nothing cancels however close the ray passes. Within |z| = 1 it is the power series of E1
//! (Abramowitz and Stegun, 5.1.11), carried as real part and imaginary part divided by u.
//!
//! A finite stretch is the difference of two, and a short one, where they would cancel, Gauss-Legendre.

use super::Segment;

/// How finely to evaluate.
#[derive(Clone, Copy, Debug)]
pub struct Precision {
    /// Nodes and weights of the sum of poles.
    pub poles: &'static [(f32, f32)],
    /// Terms of the power series, at most 9.
    pub terms: usize,
    /// Gauss-Legendre nodes and weights on [0, 1] for short stretches.
    pub short: &'static [(f32, f32)],
}

/// Half an 8-bit step of the pixel.
pub const DEFAULT: Precision = Precision { poles: &POLES_4, terms: 6, short: &NODES_2 };

/// The exponent's own rounding.
pub const REFERENCE: Precision = Precision { poles: &POLES_7, terms: 9, short: &NODES_4 };

/// A stretch whose excess is below this part of the scale, and of 1/β, is short.
const SHORT: f32 = 0.5;

/// Optical depth beyond which a stretch is as good as endless: exp(-20) is below the precision of f32.
const ENDLESS: f32 = 20.0;

/// K: multiply by the phase function 1/(4 pi), [`super::transmittance`] of the segment's path, scattering coefficient
/// and intensity for radiance.
pub fn kernel(segment: Segment, extinction: f32, precision: Precision) -> f32 {
    let Segment { offset, start, scale, excess, .. } = segment;
    let depth = extinction * excess;
    if excess <= SHORT * scale && depth <= SHORT {
        let sum: f32 = precision
            .short
            .iter()
            .map(|&(node, weight)| {
                let q = excess * node;
                weight * (-extinction * q).exp() / (offset * offset + (start + q) * (start + q))
            })
            .sum();
        return 2.0 * excess * sum;
    }
    let near = endless(extinction, offset, start, precision);
    if depth >= ENDLESS {
        return 2.0 * near;
    }
    2.0 * (near - (-depth).exp() * endless(extinction, offset, start + excess, precision)).max(0.0)
}

/// `∫ exp(-β q) / (h² + (m + q)²) dq` over all q >= 0, in 1/m.
pub(super) fn endless(extinction: f32, offset: f32, start: f32, precision: Precision) -> f32 {
    let (u, w) = (extinction * offset, extinction * start);
    let (square, norm) = (u * u, u * u + w * w);
    if norm >= 1.0 {
        let pole = |&(q, c): &(f32, f32)| c / (square + (w + q) * (w + q));
        return extinction * precision.poles.iter().map(pole).sum::<f32>();
    }
    // Ein(z) = z - z²/4 + z³/18 - …, as real part a and imaginary part u b.
    let (mut a, mut b) = (0.0, 0.0);
    for coefficient in SERIES[..precision.terms].iter().rev() {
        (a, b) = (a * w + square * b + coefficient, b * w - a);
    }
    (a, b) = (a * w + square * b, b * w - a);
    let cosine =
        1.0 + square * (-1.0 / 2.0 + square * (1.0 / 24.0 - square * (1.0 / 720.0 - square / 40_320.0)));
    let sine_over_u =
        1.0 + square * (-1.0 / 6.0 + square * (1.0 / 120.0 - square * (1.0 / 5040.0 - square / 362_880.0)));
    let logarithm = EULER_GAMMA + 0.5 * norm.max(1e-37).ln();
    let angle_over_offset = quarter_angle(offset, start) / offset;
    w.exp() * (cosine * (angle_over_offset + extinction * b) + extinction * sine_over_u * (logarithm - a))
}

/// `atan2(y, x)` for x, y >= 0, to 1.5e-7: GLSL's may be off by 4096 units in the last place.
fn quarter_angle(y: f32, x: f32) -> f32 {
    let (low, high) = (x.min(y), x.max(y));
    // tan(a - pi/4) = (t - 1)/(t + 1) halves the range of the polynomial.
    let turned = low > 0.414_213_56 * high;
    let t = if turned { (low - high) / (low + high) } else { low / high };
    let s = t * t;
    let tail =
        s * (-0.333_332_8 + s * (0.199_989_11 + s * (-0.142_154_6 + s * (0.106_562_64 - s * 0.075_3))));
    let angle = t + t * tail + if turned { std::f32::consts::FRAC_PI_4 } else { 0.0 };
    if y > x { std::f32::consts::FRAC_PI_2 - angle } else { angle }
}

const EULER_GAMMA: f32 = 0.577_215_7;

/// Coefficients of Ein(z) / z: -(-1)^k / (k k!) for k from 1.
const SERIES: [f32; 9] = [
    1.0,
    -1.0 / 4.0,
    1.0 / 18.0,
    -1.0 / 96.0,
    1.0 / 600.0,
    -1.0 / 4320.0,
    1.0 / 35_280.0,
    -1.0 / 322_560.0,
    1.0 / 3_265_920.0,
];

/// Largest relative error 8.5e-5 for |z| >= 1, Re z >= 0.
const POLES_4: [(f32, f32); 4] = [
    (0.108_453_356, 0.250_638_04),
    (0.587_752_2, 0.389_190_64),
    (1.615_515_6, 0.288_814_04),
    (3.852_112_5, 0.071_272_86),
];

/// Largest relative error 4e-7 for |z| >= 1, Re z >= 0.
const POLES_7: [(f32, f32); 7] = [
    (0.042_866_476, 0.106_017_35),
    (0.231_136_1, 0.213_619_62),
    (0.592_156_1, 0.255_641_88),
    (1.187_230_6, 0.229_433_91),
    (2.166_113, 0.143_726_84),
    (3.833_615_5, 0.047_197_174),
    (6.881_910_3, 0.004_362_977_6),
];

/// Gauss-Legendre, 2 points.
const NODES_2: [(f32, f32); 2] = [(0.211_324_87, 0.5), (0.788_675_1, 0.5)];

/// Gauss-Legendre, 4 points.
const NODES_4: [(f32, f32); 4] = [
    (0.069_431_84, 0.173_927_43),
    (0.330_009_5, 0.326_072_57),
    (0.669_990_54, 0.326_072_57),
    (0.930_568_16, 0.173_927_43),
];
