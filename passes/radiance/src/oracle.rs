//! The oracle: how wrong a node's vertices come out if one sample serves them all, guessed from that sample.
//!
//! Sun 2005, section 3.3.2 and eq. 3.3; section 5.2.3 asks for the sharper one that knows the transfer vectors.

use glam::DVec3;

use crate::{Incident, Node};

/// How an error is estimated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Oracle {
    /// `r |l| / H^2`, eq. 3.3 as it is printed: r the radius of the node's box, l its light vector, H the harmonic mean
    /// of the distances of emitters. Radiance a metre, so its bound depends on the scene's unit.
    Printed,
    /// `r |l| (r / H)`, eq. 3.3 as its text argues: brightness and number of vertices times variation. Radiance times
    /// metres.
    Argued,
    /// `|t| |S| s sqrt(n / N) (400 n / N)^0.2`: the root mean square over the whole receiver of the colours' change, to
    /// first order. t is the root mean square of the norms of the node's transfer vectors, S the slope of the sample, s the
    /// root mean square of the distances of its n out of N vertices from the sample. The last factor, 1 for a 400th of the
    /// vertices, is for what gradients leave, which falls faster than s does. Radiance.
    #[default]
    Transfer,
}

/// Of [`Oracle::Transfer`]: how much faster than to first order the error falls with a node's part of the vertices, and the
/// part, one in so many, for which it is that of first order. Of powers 0, 0.1 and 0.2 the last leaves the least error in a
/// church lit by near lamps.
const FALL: f64 = 0.2;
const COMMON: f64 = 400.0;

impl Oracle {
    /// The estimate for a `node` of a receiver of `vertices`, given light sampled in it or near it. Zero where no
    /// vertex reflects light, where none arrives, and where all vertices coincide.
    #[must_use]
    pub fn estimate(self, node: &Node, vertices: usize, light: &Incident) -> f64 {
        self.weight(node, vertices) * self.signal(light, DVec3::ZERO)
    }

    /// The factor of the estimate that only the node knows.
    #[must_use]
    pub fn weight(self, node: &Node, vertices: usize) -> f64 {
        let radius = f64::from(node.radius);
        if node.transfer == 0.0 || radius == 0.0 {
            return 0.0;
        }
        match self {
            Self::Printed => radius,
            Self::Argued => radius * radius,
            Self::Transfer => {
                let part = f64::from(node.count) / vertices.max(1) as f64;
                self.share(node, vertices) * f64::from(node.spread) * (COMMON * part).powf(FALL)
            }
        }
    }

    /// The colour that a change of the node's light of norm 1 makes, root mean square over the whole receiver: by it samples
    /// are held to be stale. Only [`Oracle::Transfer`] speaks of colours; for the others the largest number there is.
    #[must_use]
    pub fn share(self, node: &Node, vertices: usize) -> f64 {
        match self {
            Self::Printed | Self::Argued => f64::from(f32::MAX),
            Self::Transfer => {
                f64::from(node.transfer_rms) * (f64::from(node.count) / vertices.max(1) as f64).sqrt()
            }
        }
    }

    /// The factor that the light gives: of a sample, and for [`Oracle::Transfer`] at least that of a light whose slope is
    /// `floor`, which may be hidden from the sample and not from its neighbours.
    #[must_use]
    pub fn signal(self, light: &Incident, floor: DVec3) -> f64 {
        match self {
            Self::Printed => light.norm() / light.distance().powi(2),
            Self::Argued => light.norm() / light.distance(),
            Self::Transfer => light.slope.length().max(floor.length()) / 3.0_f64.sqrt(),
        }
    }
}
