//! The truth: the radiance of every normal under a texel, averaged. Sun 2008, eq. 5.4.

use crate::brdf::{Brdf, Directions};
use crate::map::Sample;

/// Box-filtered radiance of a footprint under a directional light of irradiance 1 on a surface that faces it:
/// `sum of w_q f(n_q.h) (n_q.l)+`, in 1/sr.
#[must_use]
pub fn radiance(footprint: &[Sample], brdf: Brdf, directions: Directions) -> f64 {
    let one = |sample: &Sample| {
        let cosine = sample.mean.dot(directions.light).max(0.0);
        sample.weight * cosine * brdf.value(sample.mean.dot(directions.half))
    };
    footprint.iter().map(one).sum()
}
