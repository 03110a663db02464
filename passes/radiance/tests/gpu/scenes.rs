//! Emitters to sample, and points to sample them at.

use airglow_math::sequence::sobol;
use airglow_radiance::Triangle;
use glam::DVec3;

/// Nine coloured boxes of 12 triangles in a matrix, some hiding others.
pub fn blocks() -> Vec<Triangle> {
    (0..9)
        .flat_map(|i| {
            let (x, y) = (f64::from(i % 3) - 1.0, f64::from(i / 3) - 1.0);
            let radiance = DVec3::new(1.0 + x, 1.5, 1.0 - 0.5 * y);
            block(DVec3::new(0.75 * x, 0.75 * y, -1.5 + 0.25 * x * y), 0.3125, radiance)
        })
        .collect()
}

/// The twelve triangles of a box.
pub fn block(centre: DVec3, half: f64, radiance: DVec3) -> Vec<Triangle> {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut triangles = Vec::new();
    for i in 0..3 {
        let [normal, x, y] = [axes[i], axes[(i + 1) % 3], axes[(i + 2) % 3]].map(|axis| half * axis);
        for middle in [centre + normal, centre - normal] {
            let corners = [middle - x - y, middle + x - y, middle + x + y, middle - x + y];
            let half = |places: [usize; 3]| Triangle { corners: places.map(|p| corners[p]), radiance };
            triangles.extend([half([0, 1, 2]), half([0, 2, 3])]);
        }
    }
    triangles
}

/// Points about the origin, exact in f32.
pub fn points(count: u32) -> Vec<DVec3> {
    let at = |i| DVec3::new(sobol(i, 1)[0], sobol(i, 1)[1], sobol(i, 2)[0]) - 0.5;
    (0..count).map(|i| at(i).as_vec3().as_dvec3()).collect()
}
