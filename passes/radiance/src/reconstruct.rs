//! Light vectors of vertices from the samples whose domains hold them.
//!
//! Sun 2005, section 3.3.5 and eq. 2.12 and 2.13.

use glam::DVec3;

use crate::octree::Octree;
use crate::{RadianceError, Refined};

/// How samples are weighed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Weights {
    /// `1 / d` of every sample whose domain, of the node's own reach, holds the vertex; split nodes count, too. The
    /// method of the thesis. Light jumps where a domain ends.
    Inverse,
    /// `((R - d) / (R d))^2 / (1 + (d / H)^2)^4` of the nodes not split, in domains of [`OVERLAP`] times the reach: the light
    /// ends where the domain does (Franke and Nielson, "Smooth Interpolation of Large Sets of Scattered Data", 1980), and a
    /// sample whose emitters are at a distance H says little of what is farther off than they are. [`DARK`] times that where a
    /// sample sees no emitter.
    #[default]
    Compact,
}

/// By how much domains of [`Weights::Compact`] exceed the reach of their nodes. More than 1, so that no vertex has only
/// weights of zero.
pub const OVERLAP: f64 = 1.5;

/// How far a sample is continued by its gradients, as a part of the distance of its emitters: further on, a straight line is
/// no longer near the light's change. Of 0.2, 0.25, 0.3, 0.5 and 1, 0.25 leaves the least error in a church lit by near lamps.
pub const TRUST: f64 = 0.25;

/// How much more samples count that no emitter reaches: where nothing arrives samples lie far apart, and without it the many
/// of the lit side shine through a thin wall. More of it takes light from the lit side in turn.
pub const DARK: f64 = 4.0;

/// Samples, ready to be interpolated.
#[derive(Debug)]
pub struct Reconstruction<'a> {
    refined: &'a Refined,
    weights: Weights,
    extrapolate: bool,
    /// Number, centre and radius of each sample that is used.
    used: Vec<(usize, DVec3, f64)>,
    octree: Octree,
    /// Distances below it count as it.
    least: f64,
}

impl<'a> Reconstruction<'a> {
    /// Puts the samples into an octree. With `extrapolate`, samples that hold gradients are continued to first order to the
    /// point (Annen, Kautz, Durand, Seidel, "Spherical Harmonic Gradients for Mid-Range Illumination", 2004).
    #[must_use]
    pub fn new(refined: &'a Refined, weights: Weights, extrapolate: bool) -> Self {
        let overlap = if weights == Weights::Compact { OVERLAP } else { 1.0 };
        let samples = refined.samples.iter().enumerate();
        let used: Vec<_> = samples
            .filter(|(_, sample)| weights == Weights::Inverse || !sample.split)
            .map(|(number, sample)| (number, sample.point, overlap * sample.reach))
            .collect();
        let spheres: Vec<_> = used.iter().map(|(_, centre, radius)| (*centre, *radius)).collect();
        let largest = used.iter().fold(0.0, |largest: f64, (_, _, radius)| largest.max(*radius));
        let least = (1e-6 * largest).max(f64::MIN_POSITIVE.sqrt());
        Self { refined, weights, extrapolate, octree: Octree::new(&spheres), used, least }
    }

    /// The light vector at `point` into `out`, and the number of samples it came from; with 0, `out` is black: no domain
    /// holds the point, which no vertex meets that reflects light.
    ///
    /// # Errors
    /// [`RadianceError::Length`] unless `out` is as long as the samples' light vectors.
    pub fn light(&self, point: DVec3, out: &mut [DVec3]) -> Result<usize, RadianceError> {
        if let Some(sample) = self.refined.samples.first() {
            let (expected, actual) = (sample.light.coefficients.len(), out.len());
            if expected != actual {
                return Err(RadianceError::Length { what: "the light vector", expected, actual });
            }
        }
        out.fill(DVec3::ZERO);
        let (mut total, mut count) = (0.0, 0);
        self.octree.near(point, |place| {
            let (number, centre, radius) = self.used[place];
            let light = &self.refined.samples[number].light;
            let weight = self.weight(centre.distance(point), radius, light.distance());
            if weight > 0.0 {
                (total, count) = (total + weight, count + 1);
                out.iter_mut().zip(&light.coefficients).for_each(|(sum, l)| *sum += weight * *l);
                if self.extrapolate {
                    let step = weight * (point - centre).clamp_length_max(TRUST * light.distance());
                    out.iter_mut().zip(&light.gradients).for_each(|(sum, change)| *sum += *change * step);
                }
            }
        });
        if count > 0 {
            out.iter_mut().for_each(|sum| *sum /= total);
        }
        Ok(count)
    }

    fn weight(&self, distance: f64, radius: f64, emitters: f64) -> f64 {
        let near = distance.max(self.least);
        match self.weights {
            _ if distance > radius => 0.0,
            Weights::Inverse => 1.0 / near,
            // A domain of one point: the vertex itself.
            Weights::Compact if radius <= self.least => 1.0 / (self.least * self.least),
            Weights::Compact => {
                // At most so much less, so that the weights of none vanish.
                let known = match emitters.is_finite() {
                    true => (1.0 + (distance / emitters).min(8.0).powi(2)).powi(-4),
                    false => DARK,
                };
                ((radius - near) / (radius * near)).max(0.0).powi(2) * known
            }
        }
    }
}
