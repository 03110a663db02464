//! Low-discrepancy points of the unit square, deterministic per seed, and maps to sphere and hemisphere.
//!
//! Stands on Sobol (1967) for the sequence, Owen (1995) for the scrambling, and Burley, "Practical Hash-based
//! Owen Scrambling" (JCGT 2020), with the bit mixer of Vegdahl, "Building a Better LK Hash" (2021).

use std::f64::consts::{FRAC_1_PI, TAU};

use glam::DVec3;

/// Density of [`uniform_sphere`] per steradian.
pub const UNIFORM_SPHERE_DENSITY: f64 = 0.25 * FRAC_1_PI;
/// Density of [`uniform_hemisphere`] per steradian. [`cosine_hemisphere`]'s is the cosine over pi.
pub const UNIFORM_HEMISPHERE_DENSITY: f64 = 0.5 * FRAC_1_PI;

/// Point `index` of the two-dimensional Sobol sequence, Owen-scrambled by `seed`, in [0, 1)².
///
/// Every aligned run of 2^k points is stratified in all elementary intervals of area 2^-k; different seeds
/// give different randomisations of it. Components are multiples of 2^-32.
#[must_use]
pub fn sobol(index: u32, seed: u32) -> [f64; 2] {
    let unit = |bits: u32| f64::from(bits) / (1_u64 << 32) as f64;
    [unit(owen(index.reverse_bits(), mix(seed))), unit(owen(sobol_second(index), mix(seed ^ 0x5555_5555)))]
}

/// Point `index` of the `count` points of Hammersley, `((index + 1/2) / count, radical inverse)`, in [0, 1)²;
/// `count` 0 is taken as 1.
#[must_use]
pub fn hammersley(index: u32, count: u32) -> [f64; 2] {
    let radical_inverse = f64::from(index.reverse_bits()) / (1_u64 << 32) as f64;
    [(f64::from(index) + 0.5) / f64::from(count.max(1)), radical_inverse]
}

/// The second Sobol dimension, of the primitive polynomial x + 1: direction numbers are rows of Pascal's
/// triangle modulo 2.
fn sobol_second(mut index: u32) -> u32 {
    let (mut direction, mut bits) = (1 << 31, 0);
    while index != 0 {
        if index & 1 == 1 {
            bits ^= direction;
        }
        direction ^= direction >> 1;
        index >>= 1;
    }
    bits
}

/// Nested uniform scrambling: each bit is flipped by a hash of the bits above it and of the seed.
fn owen(bits: u32, seed: u32) -> u32 {
    let mut x = bits.reverse_bits();
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x.reverse_bits()
}

/// Spreads small seeds over all bits (the finaliser of MurmurHash3).
fn mix(mut x: u32) -> u32 {
    x = (x ^ (x >> 16)).wrapping_mul(0x85eb_ca6b);
    x = (x ^ (x >> 13)).wrapping_mul(0xc2b2_ae35);
    x ^ (x >> 16)
}

/// Maps [0, 1)² to unit directions, uniform over the sphere; v runs along z from +1 down.
#[must_use]
pub fn uniform_sphere([u, v]: [f64; 2]) -> DVec3 {
    let z = 1.0 - 2.0 * v;
    at_height(u, z)
}

/// Maps [0, 1)² to unit directions, uniform over the hemisphere about +Z.
#[must_use]
pub fn uniform_hemisphere([u, v]: [f64; 2]) -> DVec3 {
    at_height(u, 1.0 - v)
}

/// Maps [0, 1)² to unit directions about +Z, of density cosine over pi (Malley's method).
#[must_use]
pub fn cosine_hemisphere([u, v]: [f64; 2]) -> DVec3 {
    at_height(u, (1.0 - v).sqrt())
}

/// The direction of azimuth `2 pi u` and height z in [-1, 1].
fn at_height(u: f64, z: f64) -> DVec3 {
    let radius = ((1.0 - z) * (1.0 + z)).sqrt();
    let (sine, cosine) = (TAU * u).sin_cos();
    DVec3::new(radius * cosine, radius * sine, z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::assert_close;
    use std::f64::consts::PI;

    /// A (0, 2)-sequence: each box of area 2^-8 and sides powers of two holds one of 256 aligned points.
    #[test]
    fn sobol_is_stratified_in_every_elementary_interval() {
        for (seed, run) in [(0, 0), (1, 0), (99, 3), (u32::MAX, 1000)] {
            for level in 0..=8 {
                let (columns, rows) = (1 << level, 1 << (8 - level));
                let mut hits = vec![0; 256];
                for i in 0..256 {
                    let [u, v] = sobol(256 * run + i, seed);
                    hits[(v * f64::from(rows)) as usize * columns as usize
                        + (u * f64::from(columns)) as usize] += 1;
                }
                assert!(hits.iter().all(|&h| h == 1), "seed {seed}, run {run}, {columns} x {rows}: {hits:?}");
            }
        }
    }

    #[test]
    fn sobol_begins_as_published_before_scrambling() {
        let quarters: Vec<u32> = (0..8).map(|i| sobol_second(i) >> 29).collect();
        assert_eq!(quarters, [0, 4, 6, 2, 5, 1, 3, 7]);
    }

    #[test]
    fn seeds_differ_and_repeat() {
        assert_eq!(sobol(5, 1), sobol(5, 1));
        assert_ne!(sobol(5, 1), sobol(5, 2));
        let mean = |seed| (0..4).map(|i| sobol(i, seed)[0]).sum::<f64>() / 4.0;
        let spread: Vec<f64> = (0..1000).map(mean).collect();
        assert_close("mean over seeds", spread.iter().sum::<f64>() / 1000.0, 0.5, 0.01);
    }

    #[test]
    fn hammersley_is_stratified() {
        let mut hits = [0; 64];
        for i in 0..64 {
            let [u, v] = hammersley(i, 64);
            hits[(v * 8.0) as usize * 8 + (u * 8.0) as usize] += 1;
        }
        assert_eq!(hits, [1; 64]);
    }

    /// First and second moments of the three densities in closed form.
    #[test]
    fn maps_have_their_densities() {
        type Map = fn([f64; 2]) -> DVec3;
        let n = 1 << 12;
        let moment =
            |map: Map, f: fn(DVec3) -> f64| (0..n).map(|i| f(map(sobol(i, 3)))).sum::<f64>() / f64::from(n);
        let cases: [(&str, Map, f64, f64); 3] = [
            ("sphere", uniform_sphere, 0.0, 1.0 / 3.0),
            ("hemisphere", uniform_hemisphere, 0.5, 1.0 / 3.0),
            ("cosine", cosine_hemisphere, 2.0 / 3.0, 0.5),
        ];
        for (name, map, first, second) in cases {
            assert_close(&format!("{name}: z"), moment(map, |d| d.z), first, 1e-3);
            assert_close(&format!("{name}: z²"), moment(map, |d| d.z * d.z), second, 1e-3);
            assert_close(&format!("{name}: x"), moment(map, |d| d.x), 0.0, 1e-3);
            assert_close(&format!("{name}: xy"), moment(map, |d| d.x * d.y), 0.0, 1e-3);
            assert_close(&format!("{name}: length"), moment(map, |d| (d.length() - 1.0).abs()), 0.0, 1e-15);
        }
        assert_close("sphere density", UNIFORM_SPHERE_DENSITY * 4.0 * PI, 1.0, 1e-15);
        assert_close("hemisphere density", UNIFORM_HEMISPHERE_DENSITY * 2.0 * PI, 1.0, 1e-15);
    }

    #[test]
    fn corners_of_the_square_stay_on_the_sphere() {
        let last = 1.0 - (-32_f64).exp2();
        for u in [0.0, last] {
            for v in [0.0, last] {
                for map in [uniform_sphere, uniform_hemisphere, cosine_hemisphere] {
                    assert_close("length", map([u, v]).length(), 1.0, 1e-15);
                }
            }
        }
    }
}
