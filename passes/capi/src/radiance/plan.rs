//! What our graph makes of the light of a receiver: its plan as text, as JSON or as a diagram.

use airglow_gpu::{Imports, Record};
use airglow_graph::{Access, Graph, State};
use airglow_radiance::{Lights, Radiance, Receiver};

use super::AirglowRadiance;
use super::lights::AirglowRadianceLights;
use super::receiver::AirglowRadianceReceiver;
use crate::input::{shared, versioned};
use crate::plan::write_plan;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};
use crate::text::AirglowText;

/// Writes the plan that the library's graph makes of the light of a receiver's vertices: steps, barriers, lifetimes and
/// bytes, and what was left out, why, and what would bring it back. The format is an `AirglowPlanFormat`.
///
/// # Safety
/// `lights` as with `airglow_radiance_prepare`; `text` as `AirglowText` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_radiance_plan(
    radiance: *const AirglowRadiance,
    receiver: *const AirglowRadianceReceiver,
    lights: *const AirglowRadianceLights,
    format: u32,
    text: *mut AirglowText,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let AirglowRadiance { context, radiance } = shared(radiance, "radiance")?;
            let receiver = &shared(receiver, "receiver")?.receiver;
            let given = versioned(lights, "lights")?.read()?;
            write_plan(context, graph(radiance, receiver, &given.lights())?, format, text)
        })
    }
}

fn graph(radiance: &Radiance, receiver: &Receiver, lights: &Lights<'_>) -> Result<Graph<Record>, Failure> {
    let (mut graph, mut imports) = (Graph::new(), Imports::new());
    for light in radiance.add(&mut graph, &mut imports, receiver, lights)?.light {
        graph.export(light, State::of(Access::ComputeStorageRead));
    }
    Ok(graph)
}
