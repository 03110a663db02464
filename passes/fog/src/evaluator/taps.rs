//! Airlight by Gauss-Legendre taps: any phase function, and any factor of the place, at the cost of one exponential
//! and two divisions a tap.
//!
//! Equi-angular nodes (Kulla and Fajardo, "Importance Sampling Techniques for Path Tracing in Participating Media",
//! 2012) follow 1/d² alone, and miss the far end of long rays, where the exponential falls. With r the segment's
//! scale, the map
//!
//! ```text
//! q = s r y / (1 - y)²,    dq = s r (1 + y) / (1 - y)³ dy
//! ```
//!
//! is equi-angular's equal near the light, spreads as √q beyond, and needs no trigonometry. Over all angles, lengths and
//! optical distances from 1e-4 to 100 its Gauss rule errs by at most 7e-4 with 6 nodes, 2.4e-4 with 8, 3e-5 with 12 and 1e-5
//! with 16 (`examples/evaluators.rs` measures 6 and 16); equi-angular nodes by 5e-3, 3e-3, 1.4e-3 and 8e-4.

use super::Segment;

/// s of the map, chosen by scanning 0.5 to 2 for the smallest worst case of both rules.
const SPREAD: f32 = 1.5;

/// A Gauss-Legendre rule on [0, 1], and how far it reaches.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// Nodes, ascending and symmetric about 1/2, and weights of sum 1.
    pub nodes: &'static [(f32, f32)],
    /// Optical depth of excess path beyond which the integrand is left out; it is below exp(-reach) of the whole.
    pub reach: f32,
}

/// Half an 8-bit step of the pixel: the default preset.
pub const DEFAULT: Rule = Rule { nodes: &NODES_6, reach: 8.0 };

/// The exponent's own rounding: the `reference` preset.
pub const REFERENCE: Rule = Rule { nodes: &NODES_16, reach: 15.0 };

/// One point of the ray at which the integrand is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Tap {
    /// Distance along the ray from the light's foot; add [`super::Light::along`] for that from the eye.
    pub ahead: f32,
    /// Cosine of the scattering angle, 1 forward.
    pub cosine: f32,
    /// Path in excess of the segment's, in metres.
    pub excess: f32,
    /// Weight of the tap in an integral over dx/d², in 1/m.
    pub weight: f32,
}

/// By how much the scale of the taps differs from the light's offset where the phase function has a lobe: Henyey and
/// Greenstein's over the distances of the paths is √(h² + m²) / ((1 - g)² h² + (1 + g)² m²)^(3/2), of the size of
/// h (1 - g) / (1 + g). 1 without a lobe.
pub fn narrowing(g: f32) -> f32 {
    (1.0 - g) / (1.0 + g)
}

/// The taps of a rule: the sum of `weight * f` is the integral of f dx/d².
///
/// `extinction` says how far to reach; with several, the smallest. `narrowing` is that of the phase function.
pub fn taps(segment: Segment, extinction: f32, narrowing: f32, rule: Rule) -> impl Iterator<Item = Tap> {
    let Segment { offset, start, excess, .. } = segment;
    let square = offset * offset;
    let step = SPREAD * (square * narrowing * narrowing + start * start).sqrt();
    let reach = if extinction * excess > rule.reach { rule.reach / extinction } else { excess };
    let ratio = (reach / step).min(1e10);
    // y of the far end, from q there: v o² + o - 1 = 0 for o = 1 - y.
    let rest = 2.0 / (1.0 + (1.0 + 4.0 * ratio).sqrt());
    let end = if ratio > 1.0 { 1.0 - rest } else { ratio * rest * rest };
    let count = rule.nodes.len();
    (0..count).map(move |i| {
        let (node, weight) = rule.nodes[i];
        let y = end * node;
        let inverse = 1.0 / (rest + end * rule.nodes[count - 1 - i].0); // 1 / (1 - y), exact to the end
        let excess = step * y * inverse * inverse;
        let m = start + excess;
        let density = 1.0 / (square + m * m);
        Tap {
            ahead: 0.5 * (m - square / m),
            cosine: (square - m * m) * density,
            excess,
            weight: 2.0 * weight * end * step * (1.0 + y) * inverse * inverse * inverse * density,
        }
    })
}

/// K times a phase function of mean cosine `g` (of the scattering angle's cosine, 1/sr): multiply by
/// [`super::transmittance`] of the segment's path, scattering coefficient and intensity for radiance.
pub fn kernel(segment: Segment, extinction: f32, rule: Rule, g: f32, phase: impl Fn(f32) -> f32) -> f32 {
    taps(segment, extinction, narrowing(g), rule)
        .map(|tap| tap.weight * (-extinction * tap.excess).exp() * phase(tap.cosine))
        .sum()
}

/// Gauss-Legendre, 6 points.
const NODES_6: [(f32, f32); 6] = [
    (0.033_765_24, 0.085_662_246),
    (0.169_395_31, 0.180_380_79),
    (0.380_690_4, 0.233_956_96),
    (0.619_309_6, 0.233_956_96),
    (0.830_604_7, 0.180_380_79),
    (0.966_234_74, 0.085_662_246),
];

/// Gauss-Legendre, 16 points.
pub(super) const NODES_16: [(f32, f32); 16] = [
    (0.005_299_532_3, 0.013_576_23),
    (0.027_712_489, 0.031_126_762),
    (0.067_184_396, 0.047_579_255),
    (0.122_297_79, 0.062_314_484),
    (0.191_061_88, 0.074_797_995),
    (0.270_991_62, 0.084_578_26),
    (0.359_198_2, 0.091_301_71),
    (0.452_493_76, 0.094_725_3),
    (0.547_506_3, 0.094_725_3),
    (0.640_801_8, 0.091_301_71),
    (0.729_008_4, 0.084_578_26),
    (0.808_938_15, 0.074_797_995),
    (0.877_702_2, 0.062_314_484),
    (0.932_815_6, 0.047_579_255),
    (0.972_287_54, 0.031_126_762),
    (0.994_700_5, 0.013_576_23),
];
