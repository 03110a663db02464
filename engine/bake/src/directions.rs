//! The rays of a vertex, in the frame of its normal (+Z), and what each is worth.
//!
//! One set serves all vertices: a spherical Fibonacci lattice over the hemisphere (Marques et al. 2013), its
//! heights spread by the sampling density. A vertex turns it about its normal by an angle of its own.

use airglow_math::MathError;
use airglow_math::sh::{evaluate, zonal};
use glam::{DVec3, Vec3A};

use crate::analytic::cosine_factors;
use crate::settings::{MAX_ORDER, Settings};

/// Coefficients of one vector at most.
pub(crate) const MAX_COEFFICIENTS: usize = MAX_ORDER * MAX_ORDER;
/// A row holds a transfer and a visibility part.
pub(crate) const MAX_WIDTH: usize = 2 * MAX_COEFFICIENTS;
/// Rows are padded to whole vectors of this many lanes.
pub(crate) const LANES: usize = 8;

/// Directions with precomputed basis values: accumulation is a sum of rows over the rays that are free.
#[derive(Debug)]
pub(crate) struct Directions {
    /// Unit vectors with z > 0.
    pub local: Vec<Vec3A>,
    /// Per ray, `width` values: w_t y(s), then w_v y(s) if visibility is wanted, then zeros; with q the sampling
    /// density of N rays, w_v = 1 / (N q) and w_t = cos / π · w_v.
    pub rows: Vec<f32>,
    /// Length of a row, a multiple of [`LANES`].
    pub width: usize,
    /// What is missing from the sum of all rows to the exact integrals over the open hemisphere, transfer part
    /// then visibility part.
    pub residual: Vec<f64>,
}

/// Share of the samples spread by the cosine, the others being uniform. Half and half bounds the visibility
/// weights 1/q by 4π; the transfer's error is within 5 % of the best share's (0.75), smaller than that of the
/// pure cosine, and asking for visibility does not change the transfer.
const COSINE_SHARE: f64 = 0.5;

impl Directions {
    /// The set of `settings`, which have been checked.
    pub(crate) fn new(settings: &Settings) -> Result<Self, MathError> {
        Self::with_cosine_share(settings, COSINE_SHARE)
    }

    /// The set whose density is q(s) = (1 - share) / 2π + share · cos / π.
    pub(crate) fn with_cosine_share(settings: &Settings, share: f64) -> Result<Self, MathError> {
        let (count, rays) = (settings.coefficient_count(), settings.rays as usize);
        let parts = if settings.visibility.is_some() { 2 } else { 1 };
        let width = (parts * count).next_multiple_of(LANES);
        let mut set = Self {
            local: Vec::with_capacity(rays),
            rows: vec![0.0; rays * width],
            width,
            residual: open_hemisphere(settings.order, parts)?,
        };
        let mut basis = [0.0; MAX_COEFFICIENTS];
        for (direction, row) in lattice(rays, share).zip(set.rows.chunks_exact_mut(width)) {
            evaluate(settings.order, direction, &mut basis[..count])?;
            let density = ((1.0 - share) * 0.5 + share * direction.z) / std::f64::consts::PI;
            let visibility_weight = 1.0 / (rays as f64 * density);
            let weights = [direction.z / std::f64::consts::PI * visibility_weight, visibility_weight];
            for (part, weight) in weights.into_iter().enumerate().take(parts) {
                for (i, value) in basis[..count].iter().enumerate() {
                    row[part * count + i] = (weight * value) as f32;
                    set.residual[part * count + i] -= weight * value;
                }
            }
            set.local.push(direction.as_vec3a());
        }
        Ok(set)
    }
}

/// Integrals over the open hemisphere about +Z: of the clamped cosine over π, then, with two parts, of 1.
fn open_hemisphere(order: usize, parts: usize) -> Result<Vec<f64>, MathError> {
    let mut integrals = vec![0.0; order * order];
    zonal::rotate_to_direction(&cosine_factors(order)?, DVec3::Z, &mut integrals)?;
    if parts == 2 {
        integrals.extend(hemisphere(order, DVec3::Z)?);
    }
    Ok(integrals)
}

/// The function that is 1 within the hemisphere about `axis`, projected.
pub(crate) fn hemisphere(order: usize, axis: DVec3) -> Result<Vec<f64>, MathError> {
    let factors: Vec<f64> = (0..order).map(hemisphere_factor).collect();
    let mut vector = vec![0.0; order * order];
    zonal::rotate_to_direction(&factors, axis, &mut vector)?;
    Ok(vector)
}

/// 2π ∫ P_l(t) dt over t in [0, 1], from the integral (P_{l-1}(0) - P_{l+1}(0)) / (2l+1).
fn hemisphere_factor(l: usize) -> f64 {
    let at_zero = |l: usize| -> f64 {
        if l % 2 == 1 { 0.0 } else { (1..=l / 2).map(|k| -((2 * k - 1) as f64) / (2 * k) as f64).product() }
    };
    let integral = match l {
        0 => 1.0,
        _ => (at_zero(l - 1) - at_zero(l + 1)) / (2 * l + 1) as f64,
    };
    2.0 * std::f64::consts::PI * integral
}

/// `count` directions with z > 0.
fn lattice(count: usize, cosine_share: f64) -> impl Iterator<Item = DVec3> {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    (0..count).map(move |i| {
        let z = height((i as f64 + 0.5) / count as f64, cosine_share);
        let radius = (1.0 - z * z).max(0.0).sqrt();
        let (sin, cos) = (std::f64::consts::TAU * (i as f64 * golden).fract()).sin_cos();
        DVec3::new(radius * cos, radius * sin, z)
    })
}

/// Solves (1 - share) z + share z² = u for z in [0, 1].
fn height(u: f64, share: f64) -> f64 {
    let linear = 1.0 - share;
    2.0 * u / (linear + (linear * linear + 4.0 * share * u).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BelowHorizon;

    /// The lattice alone integrates the open hemisphere to its own accuracy, for both densities.
    #[test]
    fn residual_is_small_and_falls() {
        for (share, visibility) in
            [(1.0, None), (0.5, Some(BelowHorizon::Blocked)), (0.0, Some(BelowHorizon::Blocked))]
        {
            let mut last = f64::INFINITY;
            for rays in [64, 256, 1024, 4096] {
                let settings = Settings { order: 6, rays, visibility, ..Settings::default() };
                let set = Directions::with_cosine_share(&settings, share).unwrap();
                let residual = set.residual.iter().map(|x| x * x).sum::<f64>().sqrt();
                println!("share {share} rays {rays}: residual {residual:.2e}");
                assert!(residual < 0.5 * last, "{residual} after {last}");
                last = residual;
            }
        }
    }

    #[test]
    fn directions_are_unit_and_above_the_plane() {
        for (count, share) in [(1, 1.0), (2, 0.0), (1000, 0.5), (16384, 0.0)] {
            for direction in lattice(count, share) {
                assert!((direction.length() - 1.0).abs() < 1e-12 && direction.z > 0.0, "{direction}");
            }
        }
    }

    #[test]
    fn hemisphere_factors_agree_with_quadrature() {
        for l in 0..6 {
            let mut basis = [0.0; MAX_COEFFICIENTS];
            let mut sum = 0.0;
            for (t, weight) in airglow_math::quadrature::gauss_legendre(8).unwrap() {
                let z = 0.5 + 0.5 * t;
                evaluate(6, DVec3::new((1.0 - z * z).sqrt(), 0.0, z), &mut basis).unwrap();
                let norm = ((2 * l + 1) as f64 / (4.0 * std::f64::consts::PI)).sqrt();
                sum += 0.5 * weight * 2.0 * std::f64::consts::PI * basis[l * (l + 1)] / norm;
            }
            assert!((hemisphere_factor(l) - sum).abs() < 1e-13, "{} for {sum}", hemisphere_factor(l));
        }
    }
}
