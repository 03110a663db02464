//! Families of random blockers, from one sphere to two hundred, small to huge: what errors are measured over.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::circle::{self, Cap};
use crate::{ShadowError, Sphere};

/// Random spheres around a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Family {
    /// What tables call it.
    pub name: &'static str,
    /// Blockers of a scene.
    pub count: usize,
    /// Smallest and largest angular radius, degrees.
    pub degrees: [f64; 2],
}

/// All families.
pub const FAMILIES: [Family; 6] = [
    Family { name: "1 sphere, 5-60 deg", count: 1, degrees: [5.0, 60.0] },
    Family { name: "4, 5-30 deg", count: 4, degrees: [5.0, 30.0] },
    Family { name: "16, 3-20 deg", count: 16, degrees: [3.0, 20.0] },
    Family { name: "64, 2-12 deg", count: 64, degrees: [2.0, 12.0] },
    Family { name: "200, 1-6 deg", count: 200, degrees: [1.0, 6.0] },
    Family { name: "30, 20-50 deg", count: 30, degrees: [20.0, 50.0] },
];

impl Family {
    /// The caps of one scene; the same for the same number.
    ///
    /// # Errors
    /// [`ShadowError::Range`] for degrees outside 0 to 90.
    pub fn scene(&self, number: u32) -> Result<Vec<Cap>, ShadowError> {
        let mut random = Random::new(number);
        let [low, high] = self.degrees;
        (0..self.count)
            .map(|_| {
                let axis = random.direction();
                let degrees = low + (high - low) * random.unit();
                Ok(Cap { axis, height: circle::height(degrees.to_radians())? })
            })
            .collect()
    }
}

impl Cap {
    /// A sphere at a distance from the origin that is seen as this cap.
    #[must_use]
    pub fn sphere(&self, distance: f64) -> Sphere {
        let sine = (self.height * (2.0 - self.height)).sqrt();
        Sphere { center: distance * self.axis, radius: distance * sine }
    }
}

/// Spheres of a standing figure, 1.8 m tall: legs, body, arms and head as rows of spheres, in turn.
#[must_use]
pub fn figure(count: usize) -> Vec<Sphere> {
    let mut random = Random::new(count as u32);
    let limbs = [
        ([0.15, 0.1, 0.0], [0.1, 0.9, 0.05], 0.09),
        ([-0.15, 0.1, 0.1], [-0.1, 0.9, -0.05], 0.09),
        ([0.0, 0.9, 0.0], [0.0, 1.45, 0.0], 0.17),
        ([0.2, 1.4, 0.0], [0.35, 0.8, 0.15], 0.06),
        ([-0.2, 1.4, 0.0], [-0.35, 0.8, -0.15], 0.06),
        ([0.0, 1.55, 0.0], [0.0, 1.75, 0.0], 0.11),
    ];
    let sphere = |(_, (from, to, radius)): (usize, ([f64; 3], [f64; 3], f64))| {
        let place = DVec3::from_array(from).lerp(DVec3::from_array(to), random.unit());
        Sphere { center: place + 0.02 * random.direction(), radius: radius * (0.8 + 0.4 * random.unit()) }
    };
    (0..count).zip(limbs.into_iter().cycle()).map(sphere).collect()
}

/// A sequence of pseudo-random numbers (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", 2014).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The same sequence for the same seed.
    #[must_use]
    pub fn new(seed: u32) -> Self {
        Self(u64::from(seed).wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform over the sphere, of length 1.
    pub fn direction(&mut self) -> DVec3 {
        let (z, azimuth) = (2.0 * self.unit() - 1.0, TAU * self.unit());
        let radius = ((1.0 - z) * (1.0 + z)).sqrt();
        DVec3::new(radius * azimuth.cos(), radius * azimuth.sin(), z)
    }
}
