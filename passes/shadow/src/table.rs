//! What the kernels look up: band factors of the logarithm of a cap, and the numbers of the optimal linear exponential over
//! the norm.
//!
//! The factors of a cap grow with the square of its sine from 0 on. Divided by that they are smooth down to 0, so that a far
//! sphere is as exact as a near one. Of a small cap they are cubic in that square, which is all that most spheres need; near
//! the first clipped eigenvalue, which has a kink, and beyond, a table over the cosine serves.

use airglow_math::sh::zonal::factors_from_coefficients;
use half::f16;

use crate::ShadowError;
use crate::linear::Linear;
use crate::logarithm::Logarithm;

/// Vectors of the table of large caps: with those of small ones 16 KiB, the smallest uniform range of any device.
const ENTRIES: usize = 1016;
/// Vectors before them: a polynomial for each band, and where they end.
const SMALL: usize = 7;
/// Vectors of both.
const VECTORS: usize = SMALL + ENTRIES + 1;
/// Steps of the norm in the table of the optimal linear exponential.
pub const LINEAR_STEPS: usize = 256;
/// The height of a cap that stands for 0, where factors are divided by the square of the sine.
const LEAST: f64 = 1e-7;
/// Squares of the sine up to which polynomials are tried, from 40 degrees down to 5.
const LIMITS: [f64; 8] = [0.41, 0.33, 0.25, 0.18, 0.12, 0.067, 0.03, 0.0076];
/// Largest error of the polynomials, over the size of the logarithm.
const TOLERANCE: f64 = 3e-4;

/// Factors of the bands, over the square of the sine; 0 beyond the order.
type Bands = [f64; 6];

/// The tables of one order.
#[derive(Clone, Debug)]
pub struct Tables {
    /// As `blockers.glsl` declares it: bits of the polynomials' coefficients, by band; the square of the sine where they
    /// end; words of four times two halves, the factors of the bands and their growth to the next step of the cosine, from
    /// order 5 on two words a step, the second for the growth.
    pub logarithm: Vec<[u32; 4]>,
    /// a and b at `LINEAR_STEPS` + 1 norms from 0 to [`Self::linear_end`].
    pub linear: Vec<[f32; 2]>,
    /// The largest norm of [`Self::linear`].
    pub linear_end: f32,
}

impl Tables {
    /// Makes the tables of an order with a clip of eigenvalues; see [`Logarithm::new`].
    ///
    /// # Errors
    /// As [`Logarithm::new`].
    pub fn new(order: usize, clip: f64) -> Result<Self, ShadowError> {
        let logarithm = caps(order, &Logarithm::new(order, clip)?)?;
        let fit = Linear::new(order)?;
        let at =
            |step: usize| fit.at(fit.end() * step as f64 / LINEAR_STEPS as f64).map(|value| value as f32);
        let linear = (0..=LINEAR_STEPS).map(at).collect();
        Ok(Self { logarithm, linear, linear_end: fit.end() as f32 })
    }
}

/// Factors at a height over the square of the sine.
fn factors(logarithm: &Logarithm, height: f64) -> Result<Bands, ShadowError> {
    let height = height.max(LEAST);
    let factors = factors_from_coefficients(&logarithm.of_cap(height)?)?;
    Ok(std::array::from_fn(|l| factors.get(l).map_or(0.0, |factor| factor / sine2(height))))
}

/// The square of the sine of a cap's angular radius.
fn sine2(height: f64) -> f64 {
    height * (2.0 - height)
}

/// The height of the cap with a square of the sine.
fn height(sine2: f64) -> f64 {
    sine2 / (1.0 + (1.0 - sine2).sqrt())
}

/// Polynomials and table.
fn caps(order: usize, logarithm: &Logarithm) -> Result<Vec<[u32; 4]>, ShadowError> {
    let (end, polynomials) = small(order, logarithm)?;
    let mut vectors: Vec<[u32; 4]> =
        polynomials.iter().map(|band| band.map(|value| (value as f32).to_bits())).collect();
    vectors.push([(end as f32).to_bits(), 0, 0, 0]);
    let steps = steps(order);
    let at = |step: usize| factors(logarithm, 1.0 - step as f64 / steps as f64);
    let mut here = at(0)?;
    for step in 1..=steps {
        let next = at(step)?;
        let pair = |l: usize, values: Bands| halves([values[l], values[l + 1]]);
        let growth = std::array::from_fn(|l| next[l] - here[l]);
        if order > 4 {
            vectors.push([pair(0, here), pair(2, here), pair(4, here), 0]);
            vectors.push([pair(0, growth), pair(2, growth), pair(4, growth), 0]);
        } else {
            vectors.push([pair(0, here), pair(2, here), pair(0, growth), pair(2, growth)]);
        }
        here = next;
    }
    vectors.resize(VECTORS, [0; 4]);
    Ok(vectors)
}

/// Cubics of the square of the sine, by band and growing power, and up to where they are good: 0 if nowhere.
fn small(order: usize, logarithm: &Logarithm) -> Result<(f64, [[f64; 4]; 6]), ShadowError> {
    for end in LIMITS {
        // At Chebyshev's nodes, where an interpolation is nearly the best polynomial.
        let node = |i: usize| {
            let angle = std::f64::consts::PI * (2 * i + 1) as f64 / 8.0;
            0.5 * end * (1.0 - angle.cos())
        };
        let nodes = [0, 1, 2, 3].map(node);
        let mut values = [[0.0; 6]; 4];
        for (values, node) in values.iter_mut().zip(nodes) {
            *values = factors(logarithm, height(node))?;
        }
        let polynomials = std::array::from_fn(|l| interpolated(nodes, values.map(|bands| bands[l])));
        let good = |at: usize| -> Result<bool, ShadowError> {
            let square = end * (at as f64 / 16.0);
            let truth = factors(logarithm, height(square))?;
            // Bands as long as their coefficients: those of the logarithm about the axis.
            let long = |values: Bands| {
                (0..order).map(|l| (2 * l + 1) as f64 * values[l] * values[l]).sum::<f64>().sqrt()
            };
            let error = std::array::from_fn(|l| cubic(polynomials[l], square) - truth[l]);
            Ok(long(error) <= TOLERANCE * long(truth))
        };
        let mut all = true;
        for at in 0..=16 {
            all = all && good(at)?;
        }
        if all {
            return Ok((end, polynomials));
        }
    }
    Ok((0.0, [[0.0; 4]; 6]))
}

/// The cubic through four points, by growing power: Newton's divided differences, multiplied out.
fn interpolated(nodes: [f64; 4], mut values: [f64; 4]) -> [f64; 4] {
    for step in 1..4 {
        for at in (step..4).rev() {
            values[at] = (values[at] - values[at - 1]) / (nodes[at] - nodes[at - step]);
        }
    }
    let mut powers = [0.0; 4];
    for at in (0..4).rev() {
        // (x - node) times what there is, and the next difference.
        powers = std::array::from_fn(|k| {
            let shifted = if k > 0 { powers[k - 1] } else { 0.0 };
            shifted - nodes[at] * powers[k]
        });
        powers[0] += values[at];
    }
    powers
}

fn cubic([a, b, c, d]: [f64; 4], x: f64) -> f64 {
    a + x * (b + x * (c + x * d))
}

/// Steps of the cosine.
fn steps(order: usize) -> usize {
    if order > 4 { ENTRIES / 2 } else { ENTRIES }
}

/// The factors of a cap's logarithm as the kernels look them up.
pub(crate) fn looked_up(order: usize, table: &[[u32; 4]], height: f64) -> Vec<f64> {
    let word = |at: usize| table.get(at).copied().unwrap_or_default();
    let float = |bits: u32| f64::from(f32::from_bits(bits));
    let square = sine2(height);
    if square < float(word(SMALL - 1)[0]) {
        return (0..order).map(|l| square * cubic(word(l).map(float), square)).collect();
    }
    let steps = steps(order);
    let place = (1.0 - height).max(0.0) * steps as f64;
    let entry = (place as usize).min(steps - 1);
    let t = place - entry as f64;
    let (values, growth) = match order > 4 {
        true => (word(SMALL + 2 * entry), word(SMALL + 2 * entry + 1)),
        false => {
            let both = word(SMALL + entry);
            (both, [both[2], both[3], 0, 0])
        }
    };
    (0..order).map(|l| square * (half(values[l / 2], l % 2) + t * half(growth[l / 2], l % 2))).collect()
}

/// The factors of a cap's visibility less 1 as the kernel of products has them: from those of eq. 5.36 the square of the
/// sine is taken out.
pub(crate) fn visibility(order: usize, height: f64) -> Vec<f64> {
    let c = 1.0 - height;
    let bands: Bands = [
        1.0 / (1.0 + c),
        0.5,
        0.5 * c,
        0.625 * c * c - 0.125,
        c * (0.875 * c * c - 0.375),
        c * c * (1.3125 * c * c - 0.875) + 0.0625,
    ];
    bands.iter().take(order).map(|band| -std::f64::consts::TAU * sine2(height) * band).collect()
}

/// Two numbers as halves, as `packHalf2x16` does.
fn halves(values: [f64; 2]) -> u32 {
    let [low, high] = values.map(|value| u32::from(f16::from_f64(value).to_bits()));
    low | high << 16
}

/// One of two halves.
fn half(word: u32, place: usize) -> f64 {
    f16::from_bits((word >> (16 * place)) as u16).to_f64()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CLIP;

    #[test]
    fn entries_between_steps_are_near_the_function() {
        for order in [3, 4, 6] {
            let tables = Tables::new(order, CLIP).unwrap();
            let inverse = Logarithm::new(order, CLIP).unwrap();
            for height in [1e-5, 0.01, 0.0595, 0.1231, 0.3777, 0.8, 0.9996] {
                let truth = factors_from_coefficients(&inverse.of_cap(height).unwrap()).unwrap();
                let size = truth.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
                let found = looked_up(order, &tables.logarithm, height);
                for (l, (found, truth)) in found.iter().zip(&truth).enumerate() {
                    assert!((found - truth).abs() < 2e-3 * size, "{height}, band {l}: {found} and {truth}");
                }
            }
        }
    }

    #[test]
    fn an_order_has_as_many_vectors_as_its_kernels_read_and_small_caps_have_polynomials() {
        for (order, least) in [(3, 40.0_f64), (4, 30.0), (5, 25.0), (6, 20.0)] {
            let tables = Tables::new(order, CLIP).unwrap();
            assert_eq!(tables.logarithm.len(), 1024);
            assert_eq!(tables.linear.len(), LINEAR_STEPS + 1);
            let end = f32::from_bits(tables.logarithm[SMALL - 1][0]);
            let degrees = end.sqrt().asin().to_degrees();
            println!("order {order}: polynomials up to {degrees:.1} degrees");
            assert!(f64::from(degrees) > least - 1.0, "order {order}: {degrees}");
        }
    }
}
