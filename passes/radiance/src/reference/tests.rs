//! The closed forms against quadrature, and the cube against the closed forms.

use std::f64::consts::PI;

use airglow_math::quadrature::gauss_legendre;
use airglow_math::sh::evaluate;
use glam::{DMat3, DVec3};
use proptest::prelude::*;

use super::{Cube, polygon, sphere, triangles};
use crate::{Incident, RadianceError, Sphere, Triangle};

const ORDER: usize = 6;

#[track_caller]
fn assert_same(what: &str, actual: &Incident, expected: &Incident, tolerance: f64) {
    for (i, (a, e)) in actual.coefficients.iter().zip(&expected.coefficients).enumerate() {
        assert!(a.distance(*e) <= tolerance, "{what}, coefficient {i}: {a} is not {e} to {tolerance:e}");
    }
    let numbers = |incident: &Incident| [incident.solid_angle, incident.nearness, incident.slope.x];
    for (a, e) in numbers(actual).into_iter().zip(numbers(expected)) {
        assert!((a - e).abs() <= tolerance * e.abs().max(1.0), "{what}: {a} is not {e} to {tolerance:e}");
    }
}

/// A triangle integrated over its area by a product rule: dω = cos dA / d².
fn by_quadrature(point: DVec3, triangle: &Triangle) -> Incident {
    let rule = gauss_legendre(128).unwrap();
    let [a, b, c] = triangle.corners.map(|corner| corner - point);
    let area = (b - a).cross(c - a);
    let mut incident = Incident::dark(ORDER).unwrap();
    let mut basis = [0.0; ORDER * ORDER];
    for (x, weight_x) in &rule {
        for (y, weight_y) in &rule {
            let (u, v) = (0.5 + 0.5 * x, 0.5 + 0.5 * y);
            let s = a + u * ((b - a) + v * (c - b)); // the square folded on the triangle, of Jacobian u
            let distance = s.length();
            let solid_angle = 0.25 * weight_x * weight_y * u * (area.dot(s)).abs() / distance.powi(3);
            evaluate(ORDER, s / distance, &mut basis).unwrap();
            let power = solid_angle * triangle.radiance;
            incident.coefficients.iter_mut().zip(&basis).for_each(|(l, y)| *l += *y * power);
            incident.solid_angle += solid_angle;
            incident.nearness += solid_angle / distance;
            incident.slope += power / distance;
        }
    }
    incident
}

fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    (-size..size, -size..size, -size..size).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_triangle_is_its_quadrature(a in vector(2.0), b in vector(2.0), c in vector(2.0), point in vector(2.0)) {
        let triangle = Triangle { corners: [a, b, c], radiance: DVec3::new(1.0, 2.0, 0.5) };
        // Where the point is near the plane, quadrature fails and not the closed form.
        let area = (b - a).cross(c - a);
        prop_assume!(area.length() > 0.1 && (a - point).dot(area.normalize()).abs() > 0.4);
        let exact = polygon(ORDER, point, &triangle.corners, triangle.radiance).unwrap();
        assert_same("triangle", &exact, &by_quadrature(point, &triangle), 1e-9);
    }

    /// The direction of the corners does not matter, nor into which triangles a polygon is cut.
    #[test]
    fn a_square_is_two_triangles(x in vector(1.0), y in vector(1.0), at in vector(2.0)) {
        prop_assume!(x.cross(y).length() > 0.1 && at.dot(x.cross(y)).abs() > 1e-3);
        let corners = [at, at + x, at + x + y, at + y];
        let square = polygon(ORDER, DVec3::ZERO, &corners, DVec3::ONE).unwrap();
        let half = |corners| Triangle { corners, radiance: DVec3::ONE };
        let halves = [half([corners[2], corners[1], corners[0]]), half([corners[0], corners[2], corners[3]])];
        assert_same("halves", &triangles(ORDER, DVec3::ZERO, &halves).unwrap(), &square, 1e-11);
    }

    #[test]
    fn a_cube_tends_to_the_closed_form(a in vector(2.0), b in vector(2.0), c in vector(2.0)) {
        let triangle = Triangle { corners: [a, b, c], radiance: DVec3::ONE };
        prop_assume!(a.dot(b.cross(c)).abs() > 0.3);
        let exact = polygon(4, DVec3::ZERO, &triangle.corners, DVec3::ONE).unwrap();
        let cube = Cube::new(4, 128).unwrap().sample(DVec3::ZERO, &[triangle]).unwrap();
        for (l, e) in cube.coefficients.iter().zip(&exact.coefficients) {
            prop_assert!(l.distance(*e) < 6e-3, "{l} is not {e}");
        }
        prop_assert!((cube.nearness / exact.nearness - 1.0).abs() < 0.05, "{} {}", cube.nearness, exact.nearness);
    }

    #[test]
    fn a_sphere_is_its_quadrature(centre in vector(3.0), radius in 1e-3..1.0_f64) {
        prop_assume!(centre.length() > 1.2 * radius);
        let lamp = Sphere { centre, radius, radiance: DVec3::new(1.0, 3.0, 0.1) };
        let exact = sphere(ORDER, DVec3::ZERO, &lamp).unwrap();
        let (distance, axis) = (centre.length(), centre.normalize());
        let across = axis.any_orthonormal_vector();
        let frame = DMat3::from_cols(across, axis.cross(across), axis);
        let mut sum = Incident::dark(ORDER).unwrap();
        let mut basis = [0.0; ORDER * ORDER];
        let edge = (1.0 - (radius / distance).powi(2)).sqrt();
        for (x, weight) in gauss_legendre(64).unwrap() {
            // w = sqrt(t - edge) removes the root at the rim.
            let w = (1.0 - edge).sqrt() * (0.5 + 0.5 * x);
            let t = edge + w * w;
            let near = distance * t - (radius * radius - distance * distance * (1.0 - t * t)).max(0.0).sqrt();
            let ring = (1.0 - edge).sqrt() * 0.5 * weight * 2.0 * w * 2.0 * PI / 16.0;
            for k in 0..16 {
                let (sine, cosine) = (2.0 * PI * f64::from(k) / 16.0).sin_cos();
                let side = (1.0 - t * t).max(0.0).sqrt();
                evaluate(ORDER, frame * DVec3::new(side * cosine, side * sine, t), &mut basis).unwrap();
                sum.coefficients.iter_mut().zip(&basis).for_each(|(l, y)| *l += ring * *y * lamp.radiance);
                sum.solid_angle += ring;
                sum.nearness += ring / near;
                sum.slope += ring / near * lamp.radiance;
            }
        }
        assert_same("sphere", &exact, &sum, 1e-9);
    }
}

/// Gradients of a cube against differences of the closed form.
#[test]
fn gradients_are_differences() {
    let corners = [DVec3::new(-0.5, 1.0, -0.3), DVec3::new(0.9, 1.2, 0.0), DVec3::new(0.1, 1.5, 1.1)];
    let triangle = Triangle { corners, radiance: DVec3::new(1.0, 0.5, 2.0) };
    let cube = Cube::new(4, 256).unwrap().with_gradients();
    let gradients = cube.sample(DVec3::ZERO, &[triangle]).unwrap().gradients;
    assert_eq!(gradients.len(), 16);
    let at = |point: DVec3| polygon(4, point, &corners, triangle.radiance).unwrap().coefficients;
    for axis in 0..3 {
        let step = 1e-4 * DVec3::AXES[axis];
        for (i, (after, before)) in at(step).into_iter().zip(at(-step)).enumerate() {
            let (expected, actual) = ((after - before) / 2e-4, gradients[i].col(axis));
            assert!(
                actual.distance(expected) < 1e-2,
                "axis {axis}, coefficient {i}: {actual} is not {expected}"
            );
        }
    }
}

/// A closed box around the point, or a sphere, is a uniform sky.
#[test]
fn from_inside_light_comes_from_everywhere() {
    let sky = (4.0 * PI).sqrt();
    let lamp = Sphere { centre: DVec3::new(0.1, 0.2, 0.0), radius: 1.0, radiance: DVec3::ONE };
    let within = sphere(ORDER, DVec3::ZERO, &lamp).unwrap();
    let room =
        triangles(ORDER, DVec3::new(0.3, -0.4, 0.2), &crate::testing::block(DVec3::ZERO, 1.0)).unwrap();
    let cube = Cube::new(ORDER, 32).unwrap();
    let mapped = cube.sample(DVec3::new(0.3, -0.4, 0.2), &crate::testing::block(DVec3::ZERO, 1.0)).unwrap();
    for (what, incident, tolerance) in
        [("sphere", within, 1e-12), ("box", room, 1e-12), ("map", mapped, 2e-3)]
    {
        for (i, l) in incident.coefficients.iter().enumerate() {
            let expected = if i == 0 { sky } else { 0.0 };
            assert!((l.x - expected).abs() < tolerance, "{what} {i}: {} is not {expected}", l.x);
        }
        assert!((incident.solid_angle - 4.0 * PI).abs() < 1e-9, "{what}: {}", incident.solid_angle);
    }
}

#[test]
fn what_overlaps_is_refused() {
    let lamp = |z: f64, x: f64| Triangle {
        corners: [DVec3::new(x, 0.0, z), DVec3::new(x + 1.0, 0.0, z), DVec3::new(x, 1.0, z)],
        radiance: DVec3::ONE,
    };
    let refused = triangles(4, DVec3::ZERO, &[lamp(1.0, 5.0), lamp(1.0, 0.0), lamp(2.0, 0.0)]);
    assert!(matches!(refused, Err(RadianceError::Overlap { first: 1, second: 2 })));
    assert!(triangles(4, DVec3::ZERO, &[lamp(1.0, 0.0), lamp(-1.0, 0.0), lamp(1.0, 1.0)]).is_ok());
}

/// The nearer one wins, whatever the order.
#[test]
fn what_is_nearer_hides() {
    let wall = |z: f64, radiance| {
        crate::testing::square(DVec3::new(-9.0, -9.0, z), DVec3::X * 18.0, DVec3::Y * 18.0, radiance)
    };
    let cube = Cube::new(3, 8).unwrap();
    let near = wall(-1.0, DVec3::X).to_vec();
    let both: Vec<_> = wall(-2.0, DVec3::Y).into_iter().chain(near.clone()).collect();
    let hidden = cube.sample(DVec3::ZERO, &both).unwrap();
    let red = cube.sample(DVec3::ZERO, &near).unwrap();
    assert!(hidden.coefficients[0].y < 0.02 * hidden.coefficients[0].x, "{}", hidden.coefficients[0]);
    assert_eq!(hidden.coefficients[0].x, red.coefficients[0].x);
}
