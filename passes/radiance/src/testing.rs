//! Emitters of the tests.

use glam::DVec3;

use crate::Triangle;

/// A parallelogram in two triangles.
pub fn square(corner: DVec3, x: DVec3, y: DVec3, radiance: DVec3) -> [Triangle; 2] {
    let corners = [corner, corner + x, corner + x + y, corner + y];
    [[0, 1, 2], [0, 2, 3]].map(|half| Triangle { corners: half.map(|i| corners[i]), radiance })
}

/// The twelve triangles of a box of half-side `half`, radiance 1.
pub fn block(centre: DVec3, half: f64) -> Vec<Triangle> {
    let side = |normal: DVec3, x: DVec3| {
        let y = normal.cross(x);
        square(centre + half * (normal - x - y), 2.0 * half * x, 2.0 * half * y, DVec3::ONE)
    };
    [(DVec3::X, DVec3::Y), (DVec3::Y, DVec3::Z), (DVec3::Z, DVec3::X)]
        .into_iter()
        .flat_map(|(normal, x)| [side(normal, x), side(-normal, x)])
        .flatten()
        .collect()
}
