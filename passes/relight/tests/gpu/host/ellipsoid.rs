//! An ellipsoid with three different axes, so that no confusion of axes leaves it as it is.

use glam::Vec3;
use std::f32::consts::PI;

/// Rings and sectors of triangles, counter-clockwise seen from outside in right-handed axes.
pub struct Ellipsoid {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

const RADII: Vec3 = Vec3::new(1.0, 0.7, 0.5);

impl Ellipsoid {
    /// `parts` rings from pole to pole, twice as many sectors.
    pub fn new(parts: usize) -> Self {
        let (mut positions, mut normals, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
        for ring in 0..=parts {
            for sector in 0..2 * parts {
                let (theta, phi) = (PI * ring as f32 / parts as f32, PI * sector as f32 / parts as f32);
                let unit = Vec3::new(theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos());
                positions.push(unit * RADII);
                normals.push((unit / RADII).normalize());
            }
        }
        let at = |ring: usize, sector: usize| (ring * 2 * parts + sector % (2 * parts)) as u32;
        for (ring, sector) in (0..parts).flat_map(|ring| (0..2 * parts).map(move |sector| (ring, sector))) {
            let [a, b] = [at(ring, sector), at(ring, sector + 1)];
            let [c, d] = [at(ring + 1, sector), at(ring + 1, sector + 1)];
            triangles.extend([[a, c, b], [b, c, d]]);
        }
        Self { positions, normals, triangles }
    }

    /// The triangles, turned round for a host whose fronts wind clockwise.
    pub fn indices(&self, clockwise: bool) -> Vec<u32> {
        self.triangles.iter().flat_map(|&[a, b, c]| if clockwise { [a, c, b] } else { [a, b, c] }).collect()
    }
}
