//! Direct light of near emitters at each vertex, by rays to points on them, without any basis.

use airglow::radiance::Triangle;
use airglow_bake::Probe;
use airglow_math::sequence::sobol;
use glam::DVec3;

use super::parallel;

/// Points on each emitter triangle that are asked for a vertex.
const POINTS: u32 = 4;

/// Colours of a white diffuse surface at each vertex of `probe`, whose space is the world: 1/pi times the integral of
/// radiance and cosine over what a vertex sees of the emitters. They hide one another; what hides them from a vertex does so
/// from beyond them, too, as it does in transfer vectors. Different seeds give independent estimates.
pub fn colours(probe: &Probe<'_>, points: &[DVec3], emitters: &[Triangle], seed: u32) -> Vec<[f32; 3]> {
    let vertex = |vertex: usize| colour(probe, vertex, points[vertex], emitters, seed).as_vec3().to_array();
    parallel(points.len(), vertex)
}

fn colour(probe: &Probe<'_>, vertex: usize, point: DVec3, emitters: &[Triangle], seed: u32) -> DVec3 {
    let Some(normal) = probe.normal(vertex) else { return DVec3::ZERO };
    let mut sum = DVec3::ZERO;
    for (number, emitter) in emitters.iter().enumerate().filter(|(_, emitter)| emitter.emits()) {
        let [a, b, c] = emitter.corners;
        let across = (b - a).cross(c - a);
        let scramble =
            (vertex as u32).wrapping_mul(0x9e37_79b9) ^ seed.rotate_right(3) ^ (number as u32) << 20;
        for index in 0..POINTS {
            let [mut u, mut v] = sobol(index, scramble);
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let way = a + u * (b - a) + v * (c - a) - point;
            let square = way.length_squared();
            let direction = way / square.sqrt();
            let cosine = direction.dot(normal);
            if square == 0.0 || cosine <= 0.0 {
                continue;
            }
            // The area is half of the product's length, which the cosine at the emitter takes with it.
            let form = 0.5 * across.dot(direction).abs() * cosine / (std::f64::consts::PI * square);
            if form > 0.0 && !hidden(point, way, emitters, number) && probe.sees(vertex, direction) {
                sum += form / f64::from(POINTS) * emitter.radiance;
            }
        }
    }
    sum
}

/// Whether another triangle stands before the end of the way.
fn hidden(point: DVec3, way: DVec3, emitters: &[Triangle], itself: usize) -> bool {
    let others = emitters.iter().enumerate().filter(|(number, _)| *number != itself);
    others.into_iter().any(|(_, other)| {
        let [a, b, c] = other.corners.map(|corner| corner - point);
        let edges = [b.cross(c), c.cross(a), a.cross(b)];
        let along = edges.map(|edge| edge.dot(way));
        let inside = along.iter().all(|x| *x >= 0.0) || along.iter().all(|x| *x <= 0.0);
        let (sum, volume) = (along.iter().sum::<f64>(), a.dot(edges[0]));
        inside && sum != 0.0 && (1e-9..1.0 - 1e-9).contains(&(volume / sum))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use airglow_bake::{Mesh, Occluders};
    use glam::Mat4;

    /// A square above a point: its form factor in closed form, and nothing when another square hides it.
    #[test]
    fn a_square_gives_its_form_factor() {
        let floor = [[0.0, 0.0, 0.0], [0.0, 0.0, 1e-3], [1e-3, 0.0, 0.0]];
        let mesh =
            Mesh { name: "floor", positions: &floor, normals: &[[0.0, 1.0, 0.0]; 3], indices: &[0, 1, 2] };
        let occluders = Occluders::build(&[]).unwrap();
        let probe = Probe::new(&mesh, Mat4::IDENTITY, &occluders, f32::INFINITY).unwrap();
        let square = |height: f64, radiance: f64| {
            let at = |x: f64, z: f64| DVec3::new(x, height, z);
            let half = |corners| Triangle { corners, radiance: DVec3::splat(radiance) };
            [
                half([at(-0.5, -0.5), at(0.5, -0.5), at(0.5, 0.5)]),
                half([at(-0.5, -0.5), at(0.5, 0.5), at(-0.5, 0.5)]),
            ]
        };
        // Howell, factor B-3 of a differential element to a parallel rectangle over its corner, four times.
        let (x, root) = (0.5_f64, 1.25_f64.sqrt());
        let expected = 4.0 * (2.0 * (x / root) * (x / root).atan()) / std::f64::consts::TAU;
        let mean = |emitters: &[Triangle]| {
            let colour = |seed| colour(&probe, 0, DVec3::ZERO, emitters, seed).x;
            (0..256).map(colour).sum::<f64>() / 256.0
        };
        let found = mean(&square(1.0, 1.0));
        assert!((found / expected - 1.0).abs() < 0.01, "{found} instead of {expected}");
        assert_eq!(mean(&[square(1.0, 1.0), square(0.5, 0.0)].concat()), 0.0);
    }
}
