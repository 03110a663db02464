//! Time by the number of vertices.

use airglow::relight::Settings;

use super::rivals::{self, Transfer};
use crate::failure::Outcome;
use crate::host::device::Device;
use crate::output::Output;
use crate::report::interleave::Rounds;
use crate::report::model::{Errors, Point};

/// Points of so many vertices each, all of one vector under one light: times do not depend on what is in them.
pub fn vertices(
    device: &Device<'_>,
    counts: &[usize],
    rounds: Rounds,
    output: &Output,
) -> Outcome<Vec<(f64, Point)>> {
    let settings = Settings::default();
    let (vector, light) = (vec![0.25; settings.coefficients()], vec![[0.5; 3]; settings.coefficients()]);
    let rival = |&count: &usize| {
        rivals::relight(device, count.to_string(), settings, Transfer::Baked(&vector), &light, count)
    };
    let all = counts.iter().map(rival).collect::<Outcome<_>>()?;
    let timed = rivals::measure(device, "vertices", all, rounds, output)?;
    let point = |(&count, timed): (&usize, rivals::Timed)| {
        (count as f64, super::curves::point(timed, Errors::default()))
    };
    Ok(counts.iter().zip(timed).map(point).collect())
}
