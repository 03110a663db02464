//! What the pass is measured against: samples spread evenly over the vertices, all interpolated at each of them.
//!
//! Sloan, Kautz, Snyder 2002 as Sun 2005 ran it (section 2.2.5): places by the algorithm of Linde, Buzo and Gray (1980),
//! called ICP there, then eq. 2.12 and 2.13. The other rival, a sample at each vertex, is a call a vertex.

use glam::DVec3;

use crate::Incident;

/// Places of `count` samples: the vertices' clusters, split one in two and moved to the mean of those nearest, until
/// that gains less than a thousandth. Fewer where fewer positions differ.
#[must_use]
pub fn places(positions: &[[f32; 3]], count: usize) -> Vec<DVec3> {
    let points: Vec<DVec3> = positions.iter().map(|position| DVec3::from(position.map(f64::from))).collect();
    if points.is_empty() || count == 0 {
        return Vec::new();
    }
    let mut places = vec![points.iter().sum::<DVec3>() / points.len() as f64];
    while places.len() < count {
        let before = places.len();
        split(&points, &mut places, count);
        settle(&points, &mut places);
        if places.len() == before {
            break;
        }
    }
    places
}

/// Adds, for each cluster up to the count, its vertex farthest from the mean.
fn split(points: &[DVec3], places: &mut Vec<DVec3>, count: usize) {
    let mut farthest = vec![(0.0, DVec3::ZERO); places.len()];
    for point in points {
        let (place, distance) = nearest(*point, places);
        if distance > farthest[place].0 {
            farthest[place] = (distance, *point);
        }
    }
    farthest.sort_by(|a, b| b.0.total_cmp(&a.0));
    let room = count - places.len();
    places.extend(farthest.iter().filter(|far| far.0 > 0.0).take(room).map(|far| far.1));
}

/// Lloyd's iteration.
fn settle(points: &[DVec3], places: &mut Vec<DVec3>) {
    let mut last = f64::INFINITY;
    for _ in 0..30 {
        let mut sums = vec![(DVec3::ZERO, 0.0); places.len()];
        let mut distortion = 0.0;
        for point in points {
            let (place, distance) = nearest(*point, places);
            sums[place].0 += *point;
            sums[place].1 += 1.0;
            distortion += distance;
        }
        *places = sums.iter().filter(|(_, count)| *count > 0.0).map(|(sum, count)| *sum / *count).collect();
        if distortion > (1.0 - 1e-3) * last {
            break;
        }
        last = distortion;
    }
}

/// The nearest place and its squared distance.
fn nearest(point: DVec3, places: &[DVec3]) -> (usize, f64) {
    let mut best = (0, f64::INFINITY);
    for (number, place) in places.iter().enumerate() {
        let distance = place.distance_squared(point);
        if distance < best.1 {
            best = (number, distance);
        }
    }
    best
}

/// The light vector at `point` from all samples, weighed with `1 / d^power`; black without samples.
#[must_use]
pub fn interpolate(point: DVec3, samples: &[(DVec3, Incident)], power: f64) -> Vec<DVec3> {
    let mut sum = vec![DVec3::ZERO; samples.first().map_or(0, |sample| sample.1.coefficients.len())];
    let mut total = 0.0;
    for (place, light) in samples {
        let weight = place.distance(point).max(1e-9).powf(-power);
        total += weight;
        sum.iter_mut().zip(&light.coefficients).for_each(|(sum, l)| *sum += weight * *l);
    }
    sum.iter_mut().for_each(|sum| *sum /= total);
    sum
}
