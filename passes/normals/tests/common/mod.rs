//! Maps made here, and random rows to measure on.
#![allow(dead_code, reason = "each test uses some of it")]

use airglow_math::sequence::{sobol, uniform_hemisphere};
use airglow_normals::{Directions, NormalMap, Sample};
use airglow_scene::image_io::read_image;
use airglow_scene::srgb_encode;
use airglow_tests::data;
use glam::DVec3;

/// Reproducible numbers in [0, 1) (Steele, Lea and Flood's splitmix64).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    /// Of zero mean and variance 1/2, near enough to normal.
    pub fn bell(&mut self) -> f64 {
        (0..6).map(|_| self.next() - 0.5).sum()
    }

    pub fn hemisphere(&mut self) -> DVec3 {
        uniform_hemisphere([self.next(), self.next()])
    }
}

/// A map of `size` by `size` texels whose slope at a place is given.
pub fn map(size: usize, mut slope: impl FnMut(usize, usize, &mut Random) -> [f64; 2]) -> NormalMap {
    let mut random = Random(7);
    let mut vectors = Vec::new();
    for y in 0..size {
        for x in 0..size {
            let [dx, dy] = slope(x, y, &mut random);
            let normal = DVec3::new(-dx, -dy, 1.0).normalize().as_vec3();
            vectors.push(normal.to_array());
        }
    }
    NormalMap::from_vectors(size, size, &vectors).unwrap()
}

/// Grooves of eight texels with noise: two modes.
pub fn groove(size: usize) -> NormalMap {
    map(size, |x, _, random| {
        let side = if x & 4 == 0 { 0.7 } else { -0.7 };
        [side + 0.12 * random.bell(), 0.12 * random.bell()]
    })
}

/// Threads over and under, each with its two flanks: four modes.
pub fn weave(size: usize) -> NormalMap {
    map(size, |x, y, random| {
        let flank = |i: usize| if i & 2 == 0 { 0.8 } else { -0.8 };
        let along = (x ^ y) & 4 == 0;
        let [a, b] = [0.05 * random.bell(), 0.05 * random.bell()];
        if along { [flank(x) + a, b] } else { [a, flank(y) + b] }
    })
}

/// Noise about one normal.
pub fn grain(size: usize) -> NormalMap {
    map(size, |_, _, random| [0.25 * random.bell(), 0.25 * random.bell()])
}

/// Light and view of a row: every other one looks along the mirror of one of the normals, give or take `spread`.
pub fn directions(row: usize, footprint: &[Sample], spread: f64, random: &mut Random) -> Directions {
    loop {
        let light = random.hemisphere();
        let mut view = random.hemisphere();
        if row.is_multiple_of(2) {
            let offset = spread * DVec3::new(random.bell(), random.bell(), random.bell());
            let half = (footprint[random.below(footprint.len())].mean + offset).normalize();
            view = 2.0 * light.dot(half) * half - light;
        }
        if view.z > 0.02 && light.z > 0.02 {
            return Directions::new(light, view).unwrap();
        }
    }
}

/// Directions spread evenly over the upper hemisphere.
pub fn hemisphere(count: u32) -> impl Iterator<Item = DVec3> {
    (0..count).map(|i| uniform_hemisphere(sobol(i, 3)))
}

/// A map of the test data, where there is one; its components as stored: it was decoded from sRGB as a picture would be.
pub fn measured(name: &str) -> Option<NormalMap> {
    let image = read_image(&data::find(&format!("normalmap/{name}.png"))?).unwrap();
    let vectors: Vec<_> = image.pixels.iter().map(|rgb| rgb.map(|c| 2.0 * srgb_encode(c) - 1.0)).collect();
    Some(NormalMap::from_vectors(image.width, image.height, &vectors).unwrap())
}
