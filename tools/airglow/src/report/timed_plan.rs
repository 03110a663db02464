//! A plan of one method, run frame by frame and timed by the device.

use airglow_gpu::{Execution, Imports, Record, Timing};
use airglow_graph::Graph;

use super::interleave::{self, Rounds};
use super::model::Counts;
use crate::failure::{Failure, Outcome};
use crate::host::device::Device;
use crate::host::work;
use crate::output::Output;

/// A compiled plan, and where its queries end up.
pub struct TimedPlan {
    /// What it is called.
    pub name: String,
    execution: Execution,
    imports: Imports,
    timing: Timing,
    /// What its milliseconds are multiplied with: above 1 where it does part of the others' work.
    scale: f64,
}

impl TimedPlan {
    /// Compiles a graph.
    pub fn new(
        device: &Device<'_>,
        name: impl Into<String>,
        graph: Graph<Record>,
        imports: Imports,
    ) -> Outcome<Self> {
        let context = device.context();
        let plan = graph.compile(&context.graph_limits()).map_err(Failure::work)?;
        let timing = Timing::new(context, plan.steps().len() as u32, 0, 1).map_err(Failure::device)?;
        let execution = Execution::prepare(context, plan).map_err(Failure::work)?;
        Ok(Self { name: name.into(), execution, imports, timing, scale: 1.0 })
    }

    /// Its work is this part of the others'; its milliseconds are given for the whole.
    #[cfg(feature = "fog")]
    pub fn of_part(self, part: f64) -> Self {
        Self { scale: 1.0 / part, ..self }
    }

    /// One frame; device milliseconds of all its passes.
    pub fn run(&mut self, device: &Device<'_>) -> Outcome<f64> {
        device.frames(&mut self.execution, &self.imports, Some(&mut self.timing), 1, |_| Ok(()))?;
        let Some(times) = self.timing.frames().last() else {
            return Err(Failure::work(format!("{}: the device gave no timestamps", self.name)));
        };
        Ok(1e3 * self.scale * times.passes.iter().sum::<f64>())
    }

    /// The work of the frame recorded last, of which `bytes` are read and written.
    pub fn counts(&self, bytes: u64) -> Counts {
        let passes = work::of_frame(&self.execution).into_iter().map(|pass| pass.counts);
        let all = passes.fold(airglow_gpu::Counts::default(), airglow_gpu::Counts::and);
        Counts {
            bytes,
            invocations: all.invocations,
            dispatches: all.dispatches,
            draws: all.draws,
            copies: Some(all.copies),
            barriers: Some(all.barriers),
            bound: Some(all.bound_bytes),
        }
    }
}

/// Runs all plans in turn, round after round; milliseconds by plan and round.
pub fn measure(
    device: &Device<'_>,
    what: &str,
    plans: &mut [TimedPlan],
    rounds: Rounds,
    output: &Output,
) -> Outcome<Vec<Vec<f64>>> {
    let frames = (rounds.warm_up + rounds.measured) * plans.len();
    let bar = output.progress(what, frames as u64, "frames");
    let samples = interleave::measure(rounds, plans.len(), |plan| {
        bar.inc(1);
        plans[plan].run(device)
    })?;
    bar.finish_and_clear();
    Ok(samples)
}
