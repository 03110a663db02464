//! Unoccluded polygons and spheres of uniform radiance projected on spherical harmonics in closed form.
//!
//! On the sphere, band l is the eigenspace of the Laplacian to -l (l + 1), so by the divergence theorem the integral of
//! Y_lm over a spherical polygon is that of its slope across the boundary over l (l + 1) (compare Snyder, "Area Light
//! Sources for Real-Time Graphics", 1996, and Wang and Ramamoorthi, "Analytic Spherical Harmonic Coefficients for
//! Polygonal Area Lights", 2018, who reduce the same boundary to zonal harmonics). Turned so that an edge's great circle
//! is the equator, the slope of Y_lm across it is a constant times cos(m phi) or sin(m phi): each edge is integrated
//! exactly and turned back.

use std::f64::consts::PI;

use airglow_math::MathError;
use airglow_math::sh::rotation::Rotation;
use airglow_math::sh::{coefficient_count, evaluate, index};
use glam::{DMat3, DVec3};

use crate::{Incident, RadianceError, Triangle};

/// Radiance that arrives at `point` from an unoccluded plane polygon, seen from both sides, of the corners in order.
///
/// The absolute error of a coefficient is some 1e-14 of the radiance. A polygon whose plane holds the point has no
/// solid angle.
///
/// # Errors
/// The order, unless it is 1 to [`airglow_math::sh::MAX_ORDER`].
pub fn polygon(
    order: usize,
    point: DVec3,
    corners: &[DVec3],
    radiance: DVec3,
) -> Result<Incident, RadianceError> {
    let mut incident = Incident::dark(order)?;
    let corners: Vec<DVec3> = corners.iter().map(|corner| *corner - point).collect();
    let area: DVec3 = edges(&corners).map(|[a, b]| a.cross(b)).sum();
    let height = corners.first().map_or(0.0, |corner| corner.dot(area.normalize_or_zero()));
    if height == 0.0 {
        return Ok(incident);
    }
    let mut integrals = vec![0.0; coefficient_count(order)];
    let mut flux = DVec3::ZERO; // of the unit field s through the spherical polygon: Lambert's vector
    for [a, b] in edges(&corners) {
        let axis = a.cross(b);
        if axis == DVec3::ZERO {
            continue;
        }
        let (angle, axis) = (axis.length().atan2(a.dot(b)), axis.normalize());
        flux += 0.5 * angle * axis;
        add_edge(order, a.normalize(), axis, angle, &mut integrals)?;
    }
    let side = height.signum();
    incident.solid_angle = side * solid_angle(&corners);
    incident.nearness = flux.dot(area.normalize()) / height.abs();
    incident.slope = incident.nearness * radiance;
    integrals[0] = solid_angle(&corners) / (4.0 * PI).sqrt();
    incident.coefficients.iter_mut().zip(&integrals).for_each(|(l, y)| *l = side * y * radiance);
    Ok(incident)
}

/// Light of triangles of which none covers another as seen from `point`.
///
/// # Errors
/// [`RadianceError::Overlap`] names two that do; the order as for [`polygon`].
pub fn triangles(order: usize, point: DVec3, triangles: &[Triangle]) -> Result<Incident, RadianceError> {
    let mut incident = Incident::dark(order)?;
    for (first, one) in triangles.iter().enumerate() {
        for (second, other) in triangles.iter().enumerate().skip(first + 1) {
            if overlap(one.corners.map(|c| c - point), other.corners.map(|c| c - point)) {
                return Err(RadianceError::Overlap { first, second });
            }
        }
        incident.add(&polygon(order, point, &one.corners, one.radiance)?)?;
    }
    Ok(incident)
}

fn edges(corners: &[DVec3]) -> impl Iterator<Item = [DVec3; 2]> {
    (0..corners.len()).map(|i| [corners[i], corners[(i + 1) % corners.len()]])
}

/// Adds one edge's part of the integrals of bands 1 and up: an arc of `angle` from `start` about `axis`, with the
/// polygon on the axis' side.
fn add_edge(
    order: usize,
    start: DVec3,
    axis: DVec3,
    angle: f64,
    integrals: &mut [f64],
) -> Result<(), MathError> {
    let mut equator = vec![0.0; integrals.len()];
    evaluate(order, DVec3::X, &mut equator)?;
    let mut local = vec![0.0; integrals.len()];
    for l in 1..order {
        for m in 0..l {
            // dP_l^m / dz = (l + m) P_(l-1)^m at z = 0, for normalised functions.
            let ratio = ((2 * l + 1) * (l * l - m * m)) as f64 / (2 * l - 1) as f64;
            let slope = ratio.sqrt() * equator[index(l - 1, m as isize)] / (l * (l + 1)) as f64;
            let m_ = m as f64;
            local[index(l, m as isize)] = slope * if m == 0 { angle } else { (m_ * angle).sin() / m_ };
            if m > 0 {
                let half = (0.5 * m_ * angle).sin();
                local[index(l, -(m as isize))] = slope * 2.0 * half * half / m_;
            }
        }
    }
    let turn = Rotation::from_matrix(order, DMat3::from_cols(start, axis.cross(start), axis))?;
    let mut turned = vec![0.0; integrals.len()];
    turn.apply(&local, &mut turned)?;
    integrals.iter_mut().zip(&turned).for_each(|(sum, value)| *sum += value);
    Ok(())
}

/// Signed solid angle of a polygon, positive where its corners go round counter-clockwise about the outward axis
/// (van Oosterom and Strackee 1983, summed over a fan).
fn solid_angle(corners: &[DVec3]) -> f64 {
    let unit: Vec<DVec3> = corners.iter().map(|corner| corner.normalize_or_zero()).collect();
    let fan = |pair: &[DVec3]| {
        let (a, b, c) = (unit[0], pair[0], pair[1]);
        2.0 * a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    };
    unit.get(1..).map_or(0.0, |rest| rest.windows(2).map(fan).sum())
}

/// Whether two triangles about the origin share directions: no plane through the origin parts them.
fn overlap(one: [DVec3; 3], other: [DVec3; 3]) -> bool {
    let [one, other] = [one, other].map(|corners| corners.map(DVec3::normalize_or_zero));
    if [one, other].iter().any(|[a, b, c]| a.dot(b.cross(*c)).abs() < TOUCH) {
        return false;
    }
    let normals = |corners: [DVec3; 3]| [0, 1, 2].map(|i| corners[i].cross(corners[(i + 1) % 3]));
    let between = one.iter().flat_map(|a| other.iter().map(|b| a.cross(*b)));
    let mut planes = normals(one).into_iter().chain(normals(other)).chain(between);
    let parts = |plane: DVec3| {
        let side = |corners: [DVec3; 3]| corners.map(|corner| corner.dot(plane));
        let (a, b) = (side(one), side(other));
        let below = |values: [f64; 3]| values.iter().all(|value| *value <= TOUCH);
        let above = |values: [f64; 3]| values.iter().all(|value| *value >= -TOUCH);
        plane.length() > TOUCH && (below(a) && above(b) || above(a) && below(b))
    };
    !planes.any(parts)
}

/// Sines below which two directions are taken as the same: neighbours in a mesh do not overlap.
const TOUCH: f64 = 1e-12;
