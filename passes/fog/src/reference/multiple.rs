//! How far single scattering is from all orders: a deterministic Monte Carlo of an isotropic point light in an endless
//! medium that scatters alike in all directions and absorbs nothing, everything in optical distances.
//!
//! The medium is symmetric about the light, so the walks need only record at what distance from it they are scattered;
//! the radiance towards a viewer is then an integral along the ray, as of single scattering. Walks end at a distance
//! where diffusion holds: an absorbing sphere there takes the constant `3 / (R + 0.71)` from the density inside (Case and
//! Zweifel, *Linear Transport Theory*, 1967), which is given back.

use std::f64::consts::{FRAC_PI_2, PI};

use airglow_math::MathError;
use airglow_math::quadrature::gauss_legendre;

use super::closed_form::glow;

/// Optical distance at which walks end.
const HORIZON: f64 = 12.0;

/// Distance beyond a plane at which the diffuse density would vanish, in mean free paths.
const EXTRAPOLATION: f64 = 0.7104;

/// Bins of the distance from the light.
const BINS: usize = 240;

/// Density of scattering events after the first, over distance from a light of 1 W/sr, per unit of optical volume.
#[derive(Clone, Debug)]
pub struct LaterOrders {
    density: Vec<f64>,
}

/// The two radiances of one direction, per extinction coefficient squared, for a light of 1 W/sr.
#[derive(Clone, Copy, Debug)]
pub struct Orders {
    /// Scattered once.
    pub single: f64,
    /// Scattered once or more.
    pub all: f64,
}

impl LaterOrders {
    /// Follows that many walks; the same number gives the same result. The density's standard error is a few percent of
    /// it per bin at 10 000, far less along a ray.
    #[must_use]
    pub fn simulate(walks: u32) -> Self {
        let mut random = Random(0x9E37_79B9_7F4A_7C15);
        let mut counts = vec![0_u64; BINS];
        for _ in 0..walks {
            let (direction, step) = (random.direction(), random.free_path());
            let mut place = direction.map(|x| x * step);
            loop {
                let (direction, step) = (random.direction(), random.free_path());
                for (x, d) in place.iter_mut().zip(direction) {
                    *x += step * d;
                }
                let distance = place.iter().map(|x| x * x).sum::<f64>().sqrt();
                if distance >= HORIZON {
                    break;
                }
                counts[bin(distance)] += 1;
            }
        }
        // The whole light is 4 π W.
        let returned = 3.0 / (HORIZON + EXTRAPOLATION);
        let density = (0..BINS).map(|i| {
            let volume = 4.0 / 3.0 * PI * (edge(i + 1).powi(3) - edge(i).powi(3));
            4.0 * PI * counts[i] as f64 / f64::from(walks) / volume + returned
        });
        Self { density: density.collect() }
    }

    /// The density at a distance: linear between the middles of bins, the diffuse one beyond the horizon.
    fn at(&self, distance: f64) -> f64 {
        if distance >= HORIZON {
            return 3.0 / distance;
        }
        let position = (distance / HORIZON).sqrt() * BINS as f64 - 0.5;
        let low = (position.max(0.0) as usize).min(BINS - 2);
        let part = (position - low as f64).clamp(0.0, 1.0);
        self.density[low] + part * (self.density[low + 1] - self.density[low])
    }

    /// Radiance of an endless ray at `gamma` radians (above 0) from a light at an optical distance above 0.
    ///
    /// # Errors
    /// [`MathError::Range`] for others.
    pub fn orders(&self, optical_distance: f64, gamma: f64) -> Result<Orders, MathError> {
        let single = (-optical_distance).exp() * glow(optical_distance, gamma)? / (2.0 * PI);
        // ∫ exp(-s) density / (4 π) ds, in panels that follow both the exponential and the light's neighbourhood.
        let (along, offset) = (optical_distance * gamma.cos(), optical_distance * gamma.sin());
        let rule = gauss_legendre(8)?;
        let mut later = 0.0;
        let panels = 160;
        for panel in 0..panels {
            let end = |i: i32| 40.0 * (f64::from(i) / f64::from(panels)).powi(2);
            let (a, b) = (end(panel), end(panel + 1));
            for (x, w) in &rule {
                let s = 0.5 * (a + b) + 0.5 * (b - a) * x;
                later += 0.5 * (b - a) * w * (-s).exp() * self.at(offset.hypot(s - along)) / (4.0 * PI);
            }
        }
        Ok(Orders { single, all: single + later })
    }

    /// Root mean square, over directions each `step` degrees up to 90, of what single scattering leaves out, over the
    /// glow's peak at the first of them: the measure of the thesis's figure 3.7. It hides errors away from the light, and
    /// depends on the step, since the glow grows without end.
    ///
    /// # Errors
    /// As [`Self::orders`].
    pub fn rms_over_peak(&self, optical_distance: f64, step: f64) -> Result<f64, MathError> {
        let count = (90.0 / step) as u32;
        let (mut squares, mut peak) = (0.0, 0.0_f64);
        for i in 1..=count {
            let orders = self.orders(optical_distance, (f64::from(i) * step).to_radians().min(FRAC_PI_2))?;
            squares += (orders.all - orders.single).powi(2);
            peak = peak.max(orders.all);
        }
        Ok((squares / f64::from(count)).sqrt() / peak)
    }
}

/// Bins grow with distance: their edges are squares.
fn edge(bin: usize) -> f64 {
    HORIZON * (bin as f64 / BINS as f64).powi(2)
}

fn bin(distance: f64) -> usize {
    (((distance / HORIZON).sqrt() * BINS as f64) as usize).min(BINS - 1)
}

/// SplitMix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    /// In (0, 1].
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64 + 1.0 / (1_u64 << 54) as f64
    }

    fn free_path(&mut self) -> f64 {
        -self.uniform().ln()
    }

    fn direction(&mut self) -> [f64; 3] {
        let z = 2.0 * self.uniform() - 1.0;
        let (sine, cosine) = (2.0 * PI * self.uniform()).sin_cos();
        let radius = (1.0 - z * z).max(0.0).sqrt();
        [radius * cosine, radius * sine, z]
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::assert_relative;
    use super::*;

    #[test]
    fn the_density_becomes_the_diffuse_one() {
        let later = LaterOrders::simulate(3000);
        for distance in [4.0, 7.0, 10.0] {
            // What is scattered for the first time is no part of it.
            let first = f64::exp(-distance) / (distance * distance);
            assert_relative(&format!("at {distance}"), later.at(distance) + first, 3.0 / distance, 0.05);
        }
    }

    /// The thesis's measure at an optical distance of 2, which tells little: the first direction decides it.
    #[test]
    fn the_error_over_the_peak_is_small_where_the_peak_is_sharp() {
        let later = LaterOrders::simulate(3000);
        let (fine, coarse) = (later.rms_over_peak(2.0, 0.1).unwrap(), later.rms_over_peak(2.0, 1.0).unwrap());
        assert_relative("at 0.1 degrees", fine, 0.016, 0.2);
        assert_relative("at 1 degree", coarse, 0.13, 0.2);
    }

    #[test]
    fn single_scattering_falls_behind_as_the_medium_thickens() {
        let later = LaterOrders::simulate(3000);
        // Shares of the whole at 90 degrees, by an independent computation: 38, 8 and 1.7 percent.
        for (optical, share) in [(0.25, 0.38), (1.0, 0.08), (2.0, 0.017)] {
            let orders = later.orders(optical, FRAC_PI_2).unwrap();
            assert_relative(&format!("share at T {optical}"), orders.single / orders.all, share, 0.08);
        }
    }
}
