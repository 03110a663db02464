//! Which rays of a picture may see a light's airlight: bounds that err on the side of seeing it.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use crate::camera::Rays;
use crate::reach::Reach;

/// By how much directions and places are taken to be off: more than f32 loses of them.
const SLACK: f64 = 1e-6;

/// Directions within an angle of an axis, as seen from the eye.
#[derive(Clone, Copy, Debug)]
struct Cone {
    axis: DVec3,
    cosine: f64,
    sine: f64,
}

/// Places within a distance of a centre, relative to the eye, metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    pub center: DVec3,
    pub radius: f64,
}

/// The rays of a part of the picture: those of a perspective lie within a cone, parallel ones within a cylinder.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Beam {
    Perspective(PerspectiveBeam),
    Parallel(ParallelBeam),
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct PerspectiveBeam(Cone);

#[derive(Clone, Copy, Debug)]
pub(crate) struct ParallelBeam {
    start: DVec3,
    direction: DVec3,
    radius: f64,
}

/// What a ray must meet to see anything of a light: each of these bounds.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Region {
    cones: [Option<Cone>; 7],
    balls: [Option<Ball>; 4],
}

impl Region {
    /// Of a light that reaches so far, `reached` being angles about `position` where rays have one eye and a ball where
    /// they do not, and that lights nothing outside `balls` and the cone of a `spot`: axis and half angle.
    pub fn new(
        position: DVec3,
        reached: Reach,
        balls: [Option<Ball>; 3],
        spot: Option<(DVec3, f64)>,
    ) -> Self {
        let within = |reached| match reached {
            Reach::Within(angle) => Some(Cone::new(position.normalize_or_zero(), angle)),
            Reach::Near(_) | Reach::Nowhere | Reach::Everywhere => None,
        };
        let near = match reached {
            Reach::Near(radius) => Some(Ball { center: position, radius }),
            Reach::Within(_) | Reach::Nowhere | Reach::Everywhere => None,
        };
        let [first, second, third] = balls;
        let cone = |ball: Option<Ball>| ball.and_then(Cone::about);
        let [hull, left, right] =
            spot.map_or([None; 3], |(axis, outer)| Cone::of_spot(position.normalize_or_zero(), axis, outer));
        Self {
            cones: [within(reached), cone(first), cone(second), cone(third), hull, left, right],
            balls: [near, first, second, third],
        }
    }
}

impl Beam {
    /// Of the part of a picture from `low` to `high`, places from 0 to 1.
    pub fn new(rays: &Rays, parallel: bool, low: [f64; 2], high: [f64; 2]) -> Self {
        let corners = [low, [high[0], low[1]], [low[0], high[1]], high];
        let middle = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
        if parallel {
            let at = |[x, y]: [f64; 2]| rays.start[0] + x * rays.start[1] + y * rays.start[2];
            let start = at(middle);
            let radius = corners.map(|corner| at(corner).distance(start)).into_iter().fold(0.0, f64::max);
            return Self::Parallel(ParallelBeam { start, direction: rays.direction[0].normalize(), radius });
        }
        let towards = |[x, y]: [f64; 2]| {
            (rays.direction[0] + x * rays.direction[1] + y * rays.direction[2]).normalize()
        };
        let axis = towards(middle);
        let cosine = corners.map(|corner| axis.dot(towards(corner))).into_iter().fold(1.0, f64::min);
        Self::Perspective(PerspectiveBeam(Cone { axis, cosine, sine: (1.0 - cosine * cosine).sqrt() }))
    }

    /// Whether a ray of it may see something of a light.
    pub fn meets(&self, region: &Region) -> bool {
        match self {
            Self::Perspective(PerspectiveBeam(cone)) => {
                region.cones.iter().flatten().all(|other| cone.meets(other))
            }
            Self::Parallel(beam) => region.balls.iter().flatten().all(|ball| beam.meets(ball)),
        }
    }
}

impl Cone {
    fn new(axis: DVec3, angle: f64) -> Self {
        let (sine, cosine) = angle.min(PI).sin_cos();
        Self { axis, cosine, sine }
    }

    /// The directions in which a ball is seen; `None` from within it.
    fn about(ball: Ball) -> Option<Self> {
        let distance = ball.center.length();
        let sine = ball.radius / distance;
        (sine < 1.0).then(|| Self { axis: ball.center / distance, cosine: (1.0 - sine * sine).sqrt(), sine })
    }

    /// Directions in which something of a spot's cone, of half angle `outer`, is seen whose apex lies `towards`: the least
    /// convex set with that direction and those of the cone itself. It lies within one cone, and between two planes
    /// through the eye and the apex that touch the spot's. No bound from within.
    fn of_spot(towards: DVec3, axis: DVec3, outer: f64) -> [Option<Self>; 3] {
        let between = towards.angle_between(axis);
        if between <= outer {
            return [Some(Self::new(axis, outer)), None, None];
        }
        let half = 0.5 * (between + outer);
        let aside = axis.reject_from_normalized(towards).normalize_or_zero();
        if half >= FRAC_PI_2 || towards == DVec3::ZERO || aside == DVec3::ZERO {
            return [None; 3];
        }
        let share = outer.sin() / between.sin();
        let rest = (1.0 - share * share).max(0.0).sqrt() * towards.cross(aside);
        let plane = |normal| Some(Self { axis: normal, cosine: 0.0, sine: 1.0 });
        let hull = Self::new(half.cos() * towards + half.sin() * aside, half);
        [Some(hull), plane(share * aside + rest), plane(share * aside - rest)]
    }

    /// Whether they have a direction in common: not if their axes are farther apart than both angles together.
    fn meets(&self, other: &Self) -> bool {
        let sine = self.sine * other.cosine + self.cosine * other.sine;
        let cosine = self.cosine * other.cosine - self.sine * other.sine;
        // Both angles together are half a turn or more.
        sine <= 0.0 || self.axis.dot(other.axis) >= cosine - SLACK
    }
}

impl ParallelBeam {
    fn meets(&self, ball: &Ball) -> bool {
        let off = (ball.center - self.start).reject_from_normalized(self.direction).length();
        off <= (self.radius + ball.radius) * (1.0 + SLACK) + SLACK * ball.center.length()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rays() -> Rays {
        let direction = [DVec3::new(-0.8, 0.45, -1.0), 1.6 * DVec3::X, -0.9 * DVec3::Y];
        Rays { start: [DVec3::ZERO; 3], direction }
    }

    fn ball(center: DVec3, radius: f64) -> Region {
        Region::new(center, Reach::Everywhere, [Some(Ball { center, radius }), None, None], None)
    }

    #[test]
    fn a_beam_meets_what_its_rays_meet_and_no_ball_far_off() {
        for parallel in [false, true] {
            let mut rays = rays();
            if parallel {
                rays.start = [DVec3::new(-8.0, 4.5, 0.0), 16.0 * DVec3::X, -9.0 * DVec3::Y];
                rays.direction = [DVec3::NEG_Z, DVec3::ZERO, DVec3::ZERO];
            }
            let mut met = 0;
            for i in 0..4000_u32 {
                let part = |alpha: f64| (0.5 + alpha * f64::from(i)).fract();
                let [a, b, c, d] = [0.856_674, 0.733_892, 0.628_707, 0.538_597].map(part);
                let center = 20.0 * DVec3::new(a - 0.5, b - 0.5, 0.5 - c);
                let radius = 4.0 * d;
                let low = [0.125 * f64::from(i % 8), 0.25 * f64::from(i / 8 % 4)];
                let beam = Beam::new(&rays, parallel, low, [low[0] + 0.125, low[1] + 0.25]);
                let region = ball(center, radius);
                // Rays of the part, and how near the ball's centre they come.
                let nearest = (0..25).map(|k| {
                    let place =
                        [low[0] + 0.125 * f64::from(k % 5) / 4.0, low[1] + 0.25 * f64::from(k / 5) / 4.0];
                    let at = |of: [DVec3; 3]| of[0] + place[0] * of[1] + place[1] * of[2];
                    let (start, direction) = (at(rays.start), at(rays.direction).normalize());
                    let along = (center - start).dot(direction);
                    let along = if parallel { along } else { along.max(0.0) };
                    (center - start - along * direction).length()
                });
                let nearest = nearest.fold(f64::INFINITY, f64::min);
                assert!(nearest > radius || beam.meets(&region), "{center} {radius}: {nearest}, {beam:?}");
                met += u32::from(beam.meets(&region));
            }
            assert!((100..3200).contains(&met), "{met} of 4000 met");
        }
    }

    #[test]
    fn a_beam_meets_the_spots_whose_cones_its_rays_enter() {
        let [mut met, mut entered] = [0; 2];
        for i in 0..4000_u32 {
            let part = |alpha: f64| (0.5 + alpha * f64::from(i)).fract();
            let [a, b, c, d, e] = [0.881_271, 0.776_636, 0.684_425, 0.603_162, 0.531_548].map(part);
            let apex = 10.0 * DVec3::new(a - 0.5, b - 0.5, c - 0.8);
            let axis = DVec3::new(d - 0.5, e - 0.5, (d + 3.0 * e).fract() - 0.5).normalize();
            let outer = FRAC_PI_2 * (a + 2.0 * c).fract().max(0.02);
            let low = [0.125 * f64::from(i % 8), 0.25 * f64::from(i / 8 % 4)];
            let beam = Beam::new(&rays(), false, low, [low[0] + 0.125, low[1] + 0.25]);
            let region = Region::new(apex, Reach::Everywhere, [None; 3], Some((axis, outer)));
            let lit = (0..25).any(|k| {
                let place = [low[0] + 0.125 * f64::from(k % 5) / 4.0, low[1] + 0.25 * f64::from(k / 5) / 4.0];
                let [corner, across, down] = rays().direction;
                let direction = (corner + place[0] * across + place[1] * down).normalize();
                (0..60).any(|step| {
                    let point = 0.01 * 1.25_f64.powi(step) * direction - apex;
                    point.dot(axis) >= outer.cos() * point.length()
                })
            });
            assert!(!lit || beam.meets(&region), "{apex}, {axis}, {outer}, {beam:?}");
            met += u32::from(beam.meets(&region));
            entered += u32::from(lit);
        }
        assert!(entered > 500 && met < entered + 800, "{met} of 4000 met, {entered} entered");
    }

    #[test]
    fn angles_of_more_than_half_a_turn_together_always_meet() {
        let beam = Beam::new(&rays(), false, [0.0; 2], [1.0; 2]);
        let behind = |angle| Region::new(DVec3::Z, Reach::Within(angle), [None; 3], None);
        assert!(beam.meets(&behind(3.0)) && !beam.meets(&behind(1.0)));
        assert!(beam.meets(&ball(DVec3::Z, 2.0)), "the eye is within");
        assert!(!beam.meets(&ball(2.0 * DVec3::Z, 1.0)));
    }
}
