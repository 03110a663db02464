//! Small balls around points: Badoiu and Clarkson, "Smaller Core-Sets for Balls" (2003): the centre steps towards the
//! farthest point, by less each time.

use glam::DVec3;

use crate::Sphere;

/// Steps; the radius is then within about one percent of the least.
const STEPS: usize = 64;

/// A ball around all points; a point at the origin where there are none.
pub(super) fn around(points: &[DVec3]) -> Sphere {
    let mut center = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
    for step in 1..=STEPS {
        let Some(far) = farthest(points, center) else { break };
        center += (far - center) / (step + 1) as f64;
    }
    let radius = farthest(points, center).map_or(0.0, |far| (far - center).length());
    Sphere { center, radius }
}

/// The point that is farthest from a place; the first of equal ones.
pub(super) fn farthest(points: &[DVec3], from: DVec3) -> Option<DVec3> {
    let distance = |point: &DVec3| (*point - from).length_squared();
    points.iter().copied().reduce(|a, b| if distance(&b) > distance(&a) { b } else { a })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn balls_are_small_and_hold_all_points() {
        let corners: Vec<DVec3> =
            (0..8).map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2))).collect();
        let ball = around(&corners);
        assert!((ball.radius / (0.75_f64.sqrt()) - 1.0).abs() < 0.02, "{ball:?}");
        assert!(corners.iter().all(|corner| (*corner - ball.center).length() <= ball.radius));
        assert_eq!(around(&[]).radius, 0.0);
        assert_eq!(around(&[DVec3::ONE]), Sphere { center: DVec3::ONE, radius: 0.0 });
    }
}
