//! Error statistics of two pictures in scene-linear units.

use airglow_math::{MathError, statistics};
use airglow_scene::{FloatImage, luminance};
use serde::Serialize;

/// How far a test picture is from its reference. Differences are test minus reference.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Statistics {
    /// Root of the mean squared difference over pixels and channels.
    pub rmse: f64,
    /// Norm of the difference over the norm of the reference; infinite for a black reference.
    pub relative_l2: f64,
    /// Norm of the difference's gradient over that of the reference's (Ng 2003, 4.1.2); infinite for a flat
    /// reference.
    pub relative_h1: f64,
    /// Mean difference in luminance: the sign says which picture is brighter.
    pub mean_signed: f64,
    /// Largest difference of any channel of any pixel, absolute.
    pub max: f64,
    /// 50th percentile over pixels of the largest channel's absolute difference.
    pub p50: f64,
    /// 95th percentile.
    pub p95: f64,
    /// 99th percentile.
    pub p99: f64,
}

/// Statistics of `test` against `reference`, which must have the same size and at least one pixel.
pub fn of(test: &FloatImage, reference: &FloatImage) -> Result<Statistics, MathError> {
    let pairs = || test.pixels.iter().zip(&reference.pixels);
    let difference = |a: [f32; 3], b: [f32; 3]| [0, 1, 2].map(|c| f64::from(a[c]) - f64::from(b[c]));
    let largest: Vec<f64> = pairs()
        .map(|(&a, &b)| difference(a, b).into_iter().fold(0.0, |worst: f64, d| worst.max(d.abs())))
        .collect();
    let signed: f64 = pairs().map(|(&a, &b)| f64::from(luminance(a)) - f64::from(luminance(b))).sum();
    let norms = statistics::h1_image(&test.pixels, &reference.pixels, reference.width, reference.height)?;
    let percentiles = statistics::percentiles(&largest, &[50.0, 95.0, 99.0, 100.0])?;
    let count = reference.pixels.len() as f64;
    Ok(Statistics {
        rmse: norms.l2 / (3.0 * count).sqrt(),
        relative_l2: norms.relative_l2,
        relative_h1: norms.relative_h1,
        mean_signed: signed / count,
        p50: percentiles[0],
        p95: percentiles[1],
        p99: percentiles[2],
        max: percentiles[3],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::picture;

    #[test]
    fn a_picture_ten_percent_brighter() {
        let reference = picture::from_fn(8, 8, |x, y| [(x + y) as f32, 1.0, 0.5]);
        let test = picture::map(&reference, |p| p.map(|c| 1.1 * c));
        let found = of(&test, &reference).unwrap();
        for relative in [found.relative_l2, found.relative_h1] {
            assert!((relative - 0.1).abs() < 1e-6, "{relative} instead of 0.1");
        }
        assert!((found.max - 1.4).abs() < 1e-5, "{} instead of 1.4", found.max);
        assert!(found.mean_signed > 0.0);
    }

    #[test]
    fn equal_pictures_have_no_error_even_when_black() {
        let black = picture::from_fn(4, 4, |_, _| [0.0; 3]);
        let found = of(&black, &black).unwrap();
        assert_eq!((found.relative_l2, found.relative_h1, found.max), (0.0, 0.0, 0.0));
    }
}
