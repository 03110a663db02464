//! Two of a room in one plan, in other orders than the one declared, their transients in shared memory: neither changes a
//! bit.

use super::host::Host;
use super::roads::{by_graph, fill, read_back};
use super::{HostDevice, Outputs, Refusal, Road, Room};
use airglow_gpu::{Context, Execution, Options, Record, Requirements};
use airglow_graph::Step;
use std::collections::BTreeSet;

/// Runs two of a room in one plan whose transients share memory, once for each seed of its order, each beside the same room
/// alone with memory of its own. Returns the orders
/// that were met, as names of passes.
///
/// # Safety
/// As [`conform_on`](crate::conform_on).
///
/// # Errors
/// What the room or the device refuses; an order whose bits are others.
pub unsafe fn shuffle_on<R: Room>(
    host: &HostDevice<'_>,
    requirements: &Requirements,
    seeds: impl IntoIterator<Item = u64>,
    make: impl Fn(&Context, &HostDevice<'_>) -> Result<R, Refusal>,
) -> Result<BTreeSet<Vec<String>>, Refusal> {
    let requirements = Requirements::engine().and(requirements);
    // SAFETY: the caller's promise is ours.
    let host = unsafe { Host::new(host)? };
    let (alone, _) = host.run(&make, &requirements, &Options::default(), Road::Graph)?;
    let mut orders = BTreeSet::new();
    for seed in seeds {
        let (outputs, order) = host.pair(&make, &requirements, seed)?;
        if outputs.iter().any(|outputs| *outputs != alone) {
            return Err(format!("seed {seed}: other bits than alone, in the order {order:?}").into());
        }
        orders.insert(order);
    }
    Ok(orders)
}

impl Host<'_> {
    /// Two of a room in one plan: what each gives, and the order of their passes.
    fn pair<R: Room>(
        &self,
        make: impl Fn(&Context, &HostDevice<'_>) -> Result<R, Refusal>,
        requirements: &Requirements,
        seed: u64,
    ) -> Result<([Outputs; 2], Vec<String>), Refusal> {
        let shim = self.watch();
        let mut held = Vec::new();
        let context = self.adopt(&shim, requirements, &Options::default(), 1)?;
        let told = self.told(&shim);
        let mut rooms = [make(&context, &told)?, make(&context, &told)?];
        let resources = rooms.each_ref().map(Room::resources);
        let mut given = Vec::new();
        for resources in &resources {
            given.push(self.give(&context, resources, &mut held)?);
        }
        let mut execution = None;
        let mut outputs = self.frame(&context, true, |recorder| {
            for (resource, given) in resources.iter().zip(&given).flat_map(|(r, g)| r.iter().zip(g)) {
                fill(recorder, resource, given, resource.entry)?;
            }
            let rooms = rooms.iter_mut().zip(&resources).zip(&given);
            let rooms = rooms.map(|((room, resources), given)| (room, &**resources, &**given));
            let options = airglow_graph::Options { seed: Some(seed), ..Default::default() };
            execution = Some(by_graph(rooms, recorder, &options, Execution::prepare_shared)?);
            let mut copies = Vec::new();
            for (resources, given) in resources.iter().zip(&given) {
                copies.extend(read_back(recorder, resources, given)?);
            }
            Ok(copies)
        })?;
        let second = outputs.split_off(outputs.len() / 2);
        let plan = execution.as_ref().ok_or("nothing was recorded")?.plan();
        // Both rooms declare as many resources, the first its own before the second.
        let half = plan.resources().len() / 2;
        let name = |step: &Step<Record>| {
            let first = step.accesses.first().is_some_and(|access| access.resource.index() < half);
            format!("{} of {}", step.name, if first { "the first" } else { "the second" })
        };
        Ok(([outputs, second], plan.steps().iter().map(name).collect()))
    }
}
