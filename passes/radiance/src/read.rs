//! Whole frames on a bench, and what they left on the device: for tests, reports and pictures of samples.

use airglow_gpu::Buffer;
use bytemuck::Pod;
use glam::DVec3;

use crate::gpu::bench::Bench;
use crate::gpu::refinement::{RefineState, SPLIT};
use crate::stage::{Bindings, Prepared};
use crate::{Hierarchy, RadianceError, Receiver, Refined, Sample};

impl Bench<'_> {
    /// Buffers for the light of a frame's parts.
    ///
    /// # Errors
    /// [`RadianceError::Gpu`] when the device has no room.
    pub fn light_buffers(&self, prepared: &Prepared) -> Result<Vec<Buffer>, RadianceError> {
        prepared.light_bytes.iter().map(|bytes| self.scratch("light of vertices", *bytes)).collect()
    }

    /// Records a frame, submits it and waits.
    ///
    /// # Errors
    /// [`RadianceError::Gpu`] when the device fails.
    pub fn frame(&self, prepared: &Prepared, light: &[Buffer]) -> Result<(), RadianceError> {
        let bindings: Bindings = (0..).zip(light.iter().map(Into::into)).collect();
        Ok((self.run)(&mut |recorder| prepared.record(recorder, &bindings))?)
    }

    /// The light of each part's vertices, once a frame has written it: three values a coefficient.
    ///
    /// # Errors
    /// As [`Bench::read`].
    pub fn light<T: Pod>(&self, light: &[Buffer]) -> Result<Vec<Vec<T>>, RadianceError> {
        light.iter().map(|buffer| self.read(buffer)).collect()
    }

    /// The samples of a receiver as the last frame left them, and how refinement ended.
    ///
    /// # Errors
    /// As [`Bench::read`].
    pub fn refined(
        &self,
        receiver: &Receiver,
        hierarchy: &Hierarchy,
    ) -> Result<(Refined, RefineState), RadianceError> {
        let samples = receiver.samples();
        let states: Vec<RefineState> = self.read(&samples.state)?;
        let Some(state) = states.first().copied() else {
            return Err(RadianceError::Length { what: "the state of refinement", expected: 1, actual: 0 });
        };
        let taken = state.taken as usize;
        let places: Vec<u32> = self.read(&samples.places)?;
        let points: Vec<[f32; 4]> = self.read(&samples.points)?;
        let shape = receiver.shape();
        let lights = self.incidents(shape, taken, &samples.lights, &samples.gradients)?;
        let sample = |((place, [x, y, z, _]), light): ((&u32, &[f32; 4]), _)| {
            let node = (place & !SPLIT) as usize;
            let reach = hierarchy.nodes().get(node).map_or(0.0, |node| f64::from(node.reach));
            let point = DVec3::new(f64::from(*x), f64::from(*y), f64::from(*z));
            Sample { node, point, reach, light, split: place & SPLIT != 0 }
        };
        let refined = Refined {
            samples: places.iter().zip(&points).take(taken).zip(lights).map(sample).collect(),
            rounds: state.rounds as usize,
            limited: state.limited == 1,
            estimate: f64::from(state.estimate),
        };
        Ok((refined, state))
    }
}
