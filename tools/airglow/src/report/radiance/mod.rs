//! The report on near emitters: the knobs of the pass, its rivals, and the numbers it is held to.

mod curves;
mod drawn;
mod numbers;
mod presets;
mod race;
mod rivals;
pub mod scaling;
mod truth;
mod workload;

pub use workload::Workload;

use crate::failure::Outcome;
use crate::host::device::Device;
use crate::output::Output;
use crate::report::interleave::Rounds;
use crate::report::model::{Curve, Number};

/// How much is measured.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Rounds of all settings of a knob.
    pub rounds: Rounds,
}

impl Effort {
    /// All, or enough to see the shape of the curves.
    pub fn new(quick: bool) -> Self {
        let measured = if quick { 3 } else { 9 };
        Self { rounds: Rounds { warm_up: 1, measured } }
    }
}

/// What the curves are measured with.
pub struct Measurement<'a> {
    /// The device.
    pub device: &'a Device<'a>,
    /// What is lit.
    pub workload: &'a Workload,
    /// How much is measured.
    pub effort: Effort,
    /// Where progress goes.
    pub output: &'a Output,
}

impl Measurement<'_> {
    /// Everything.
    pub fn all(&self) -> Outcome<(Vec<Curve>, Vec<Number>)> {
        let (methods, reconstruction) = (self.methods()?, self.reconstruction()?);
        let mut knobs = self.knobs()?;
        let mut numbers = self.numbers(&knobs[0], &reconstruction)?;
        let drawn = self.drawn()?;
        numbers.push(drawn::breaks_even(&drawn)?);
        let mut curves = vec![methods, reconstruction];
        curves.append(&mut knobs);
        curves.extend([self.limit()?, self.stride()?, self.oracle()?, self.triangles()?, drawn]);
        Ok((curves, numbers))
    }

    /// The knobs that a host sets, the bound first.
    pub fn knobs(&self) -> Outcome<Vec<Curve>> {
        Ok(vec![self.bound()?, self.face()?, self.order()?, self.gradients()?])
    }

    /// What a reader must know.
    pub fn remarks(&self) -> Vec<String> {
        vec![
            format!(
                "Each frame samples anew, as if emitters had moved; {} rounds of all settings in turn after {} of \
                 warm-up. No setting draws: a sample is a workgroup of a kernel, and takes 6 faces of texels times rays.",
                self.effort.rounds.measured, self.effort.rounds.warm_up
            ),
            "Memory held: the tree, the vertices, and room for as many samples as the limit allows; for rivals, samples \
             and light. Read + written: samples twice, vertices and their light once. Invocations of indirect dispatches \
             are not counted while recording."
                .to_owned(),
        ]
    }
}

/// `count` results by index, on all processors.
fn parallel<T: Send>(count: usize, result: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let each = count.div_ceil(threads).max(1);
    let part = |begin: usize| (begin..count.min(begin + each)).map(&result).collect::<Vec<_>>();
    std::thread::scope(|scope| {
        let part = &part;
        let parts: Vec<_> = (0..count).step_by(each).map(|begin| scope.spawn(move || part(begin))).collect();
        let joined = parts
            .into_iter()
            .map(|part| part.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        joined.flatten().collect()
    })
}
