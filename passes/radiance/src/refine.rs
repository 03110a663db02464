//! Where samples are taken: the tree refined level by level until the oracle is content.
//!
//! Sun 2005, section 3.3.3 and algorithm 3.4. Differences: a node is split only if the samples of all its parts are
//! within the limit, so that the parts not split always share out the vertices; a node whose vertices reflect nothing
//! takes no sample; and a split may go down several levels at once, as far as the sample at hand says that the level
//! between would not do.

use glam::DVec3;

use crate::{Glow, Hierarchy, Incident, Oracle, RadianceError};

/// What samples: it is called once a round with its points, and returns as many lights.
pub type Sampler<'a> = dyn FnMut(&[DVec3]) -> Result<Vec<Incident>, RadianceError> + 'a;

/// The part of unhidden light that keeps a shadow from being taken for a whole node: see [`Settings::hidden`].
pub const HIDDEN: f64 = 0.1;

/// How far the tree is refined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How errors are estimated.
    pub oracle: Oracle,
    /// Nodes estimated above it are split; in the oracle's unit, zero to infinity.
    pub bound: f64,
    /// Most samples.
    pub limit: usize,
    /// Most levels that a split goes down, 1 to 8. More waste fewer samples on nodes that are split in turn.
    pub stride: usize,
    /// What part of the light that emitters would send unhidden a sample is taken to miss, for [`Oracle::Transfer`]: 0 to
    /// 1. With 0 a sample in a shadow speaks for its whole node.
    pub hidden: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { oracle: Oracle::default(), bound: 0.01, limit: 4096, stride: 3, hidden: HIDDEN }
    }
}

/// Light sampled for a node.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// The node.
    pub node: usize,
    /// Where it was taken: the node's mean position.
    pub point: DVec3,
    /// Radius about the point that holds all of the node's vertices.
    pub reach: f64,
    /// What arrives there.
    pub light: Incident,
    /// Whether parts of the node were sampled again.
    pub split: bool,
}

/// What refinement took.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Refined {
    /// All samples, level by level.
    pub samples: Vec<Sample>,
    /// Rounds of sampling, each of which needs the one before.
    pub rounds: usize,
    /// Whether the limit left a node unsplit that the bound would have split.
    pub limited: bool,
    /// The largest estimate among nodes that were not split.
    pub estimate: f64,
}

impl Settings {
    pub(crate) fn check(&self) -> Result<(), RadianceError> {
        if self.bound.is_nan() || self.bound < 0.0 {
            return Err(RadianceError::setting("bound", self.bound, "zero to infinity"));
        }
        if !(1..=8).contains(&self.stride) {
            return Err(RadianceError::setting("stride", self.stride, "1 to 8 levels"));
        }
        if !(0.0..=1.0).contains(&self.hidden) {
            return Err(RadianceError::setting("hidden", self.hidden, "0 to 1"));
        }
        Ok(())
    }
}

/// Refines the tree. `glows` are the emitters, for [`Settings::hidden`].
///
/// # Errors
/// A setting out of range; what `sample` reports; [`RadianceError::Length`] if it returns too few or too many.
pub fn refine(
    hierarchy: &Hierarchy,
    settings: &Settings,
    glows: &[Glow],
    sample: &mut Sampler<'_>,
) -> Result<Refined, RadianceError> {
    settings.check()?;
    let vertices = hierarchy.vertices().len();
    let mut refined = Refined::default();
    let lit = hierarchy.nodes().first().is_some_and(|root| root.transfer > 0.0);
    let mut round = if lit && settings.limit > 0 { vec![0] } else { Vec::new() };
    refined.limited = lit && round.is_empty();
    while !round.is_empty() {
        let begin = refined.samples.len();
        take(hierarchy, &round, sample, &mut refined)?;
        round.clear();
        for i in begin..refined.samples.len() {
            let sample = &refined.samples[i];
            let node = &hierarchy.nodes()[sample.node];
            let signal = settings.signal(sample, glows);
            let estimate = settings.oracle.weight(node, vertices) * signal;
            let parts = match estimate > settings.bound {
                true => parts(hierarchy, settings, sample.node, signal),
                false => Vec::new(),
            };
            let fits = refined.samples.len() + round.len() + parts.len() <= settings.limit;
            if parts.is_empty() || !fits {
                refined.limited |= !parts.is_empty();
                refined.estimate = refined.estimate.max(estimate);
                continue;
            }
            refined.samples[i].split = true;
            round.extend(parts);
        }
    }
    Ok(refined)
}

impl Settings {
    /// What the oracle makes of a sample's light, and of what may be hidden from it.
    fn signal(&self, sample: &Sample, glows: &[Glow]) -> f64 {
        let unhidden = || glows.iter().map(|glow| glow.slope(sample.point)).sum::<DVec3>();
        let floor = if self.hidden > 0.0 { self.hidden * unhidden() } else { DVec3::ZERO };
        self.oracle.signal(&sample.light, floor)
    }
}

fn take(
    hierarchy: &Hierarchy,
    round: &[usize],
    sample: &mut Sampler<'_>,
    refined: &mut Refined,
) -> Result<(), RadianceError> {
    let points: Vec<DVec3> = round.iter().map(|node| hierarchy.nodes()[*node].point()).collect();
    let lights = sample(&points)?;
    if lights.len() != points.len() {
        let (expected, actual) = (points.len(), lights.len());
        return Err(RadianceError::Length { what: "the sampled light", expected, actual });
    }
    refined.rounds += 1;
    refined.samples.extend(round.iter().zip(points).zip(lights).map(|((node, point), light)| {
        let reach = f64::from(hierarchy.nodes()[*node].reach);
        Sample { node: *node, point, reach, light, split: false }
    }));
    Ok(())
}

/// The nodes below a sample's that are sampled next: as few levels down as its signal lets expect to be enough, within
/// the stride; without those that reflect nothing.
fn parts(hierarchy: &Hierarchy, settings: &Settings, split: usize, signal: f64) -> Vec<usize> {
    let vertices = hierarchy.vertices().len();
    let mut parts = Vec::new();
    let mut open: Vec<(usize, usize)> = below(hierarchy, split).map(|node| (node, 1)).collect();
    while let Some((number, level)) = open.pop() {
        let node = &hierarchy.nodes()[number];
        let enough = settings.oracle.weight(node, vertices) * signal <= settings.bound;
        if node.transfer == 0.0 {
            continue;
        }
        if enough || level >= settings.stride || node.count == 1 {
            parts.push(number);
        } else {
            open.extend(below(hierarchy, number).map(|half| (half, level + 1)));
        }
    }
    parts
}

fn below(hierarchy: &Hierarchy, node: usize) -> impl Iterator<Item = usize> {
    hierarchy.children(node).into_iter().flatten().rev()
}
