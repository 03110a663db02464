//! What the radiance pass sampled in a frame.

use airglow::radiance::gpu::LightShape;
use serde::Serialize;

use crate::host::near::Sampled;

/// The samples of the last frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct NearStat {
    /// Samples taken.
    samples: u32,
    /// Of these, in closed form and not by a cube map.
    closed_forms: u32,
    /// Rounds in which they were asked for.
    rounds: u32,
    /// Whether the limit of samples stopped refinement above the bound.
    limit_hit: bool,
    /// The largest error expected of a node that was not split, and what it was to be below, W/sr/m2.
    estimate: f32,
    bound: f64,
}

impl NearStat {
    /// From what a frame left on the device.
    pub fn new(sampled: &Sampled) -> Self {
        let Some(state) = &sampled.state else { return Self::default() };
        let exact = closed_forms(&sampled.lights, sampled.shape).take(state.taken as usize);
        Self {
            samples: state.taken,
            closed_forms: exact.filter(|exact| *exact).count() as u32,
            rounds: state.rounds,
            limit_hit: state.limited == 1,
            estimate: state.estimate,
            bound: sampled.bound,
        }
    }

    /// A line of the text.
    pub fn line(&self) -> String {
        let Self { samples, closed_forms, rounds, limit_hit, estimate, bound } = self;
        let limit = if *limit_hit { "stopped by the limit of samples" } else { "limit not hit" };
        format!(
            "  radiance: {samples} samples in {rounds} rounds, {closed_forms} of them in closed form; {limit}; largest \
             error expected {estimate:.1e} of {bound:.0e}\n"
        )
    }
}

/// Which samples are closed forms, of this frame (1) or kept from one before (3), of lights as a device left them.
pub fn closed_forms(lights: &[[f32; 4]], shape: LightShape) -> impl Iterator<Item = bool> + '_ {
    lights
        .chunks_exact(shape.stride())
        .map(move |sample| [1.0, 3.0].contains(&sample[shape.coefficients()][2]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use airglow::radiance::gpu::RefineState;

    #[test]
    fn closed_forms_are_counted_among_those_taken() {
        let shape = LightShape { order: 3, gradients: false };
        let mut lights = vec![[0.0; 4]; 3 * shape.stride()];
        for sample in [0, 2] {
            lights[sample * shape.stride() + shape.coefficients()][2] = 1.0;
        }
        let state = RefineState { taken: 2, limited: 1, rounds: 4, ..bytemuck::Zeroable::zeroed() };
        let sampled = Sampled { state: Some(state), lights, shape, bound: 0.01 };
        let stat = NearStat::new(&sampled);
        assert_eq!((stat.samples, stat.closed_forms), (2, 1));
        let line = stat.line();
        assert!(line.contains("2 samples in 4 rounds, 1 of them") && line.contains("stopped"), "{line}");
        assert_eq!(NearStat::new(&Sampled { state: None, ..sampled }), NearStat::default());
    }
}
