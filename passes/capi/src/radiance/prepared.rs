//! The light of a receiver's vertices as a frame, and the lights that change it.

use std::any::Any;

use airglow_gpu::Recorder;
use airglow_radiance::{Bindings, HEALTH, Prepared, Resource};

use super::AirglowRadiance;
use super::lights::AirglowRadianceLights;
use super::receiver::AirglowRadianceReceiver;
use crate::access::{self, AirglowOrigin, Number, Step, Uses, What};
use crate::binding::Bound;
use crate::health::{AirglowHealth, look};
use crate::input::{shared, versioned};
use crate::pass::{Frame, give, give_if};
use crate::prepared::AirglowPrepared;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};

/// What a step of the pass uses.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowRadianceResource {
    /// Written, a buffer of the host's for each part, whose place in the receiver is the index: `3 * order^2` floats a
    /// vertex, in the space of the part, as relighting takes light of each vertex
    /// (`AIRGLOW_RELIGHT_RESOURCE_VERTEX_LIGHT`).
    VertexLight = 0,
    /// A buffer of the library's own; the index counts them, the name says which.
    Own = 1,
}

/// The number and the index of the light of a part.
const fn light(part: u32) -> Number {
    (AirglowRadianceResource::VertexLight as u32, part)
}

/// A frame of the pass.
struct RadianceFrame(Prepared);

impl Frame for RadianceFrame {
    const PASS: &'static str = "radiance";
    type Bindings = Bindings;

    fn bind(&self, bound: &Bound<'_>) -> Result<Bindings, Failure> {
        let part = |part: u32| Ok((part, bound.buffer(light(part))?));
        (0..self.0.light_bytes.len() as u32).map(part).collect()
    }

    fn record(&self, recorder: &mut Recorder<'_>, bindings: &mut Bindings) -> Result<(), Failure> {
        Ok(self.0.record(recorder, bindings)?)
    }

    fn count(
        &self,
        recorder: &mut Recorder<'_>,
        counters: &mut dyn Any,
        bindings: &mut Bindings,
    ) -> Result<(), Failure> {
        look(recorder, counters, &self.0.looks(bindings))
    }
}

/// Makes counters for `airglow_prepared_count`, of frames of this pass: vertices whose light is not finite; receivers whose
/// limit of samples kept nodes from being split.
///
/// # Safety
/// `health` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_radiance_health_new(
    radiance: *const AirglowRadiance,
    health: *mut *mut AirglowHealth,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            give(health, "health", || {
                AirglowHealth::tallied(&shared(radiance, "radiance")?.context, RadianceFrame::PASS, &HEALTH)
            })
        })
    }
}

fn uses(prepared: &Prepared) -> Uses {
    let number = |resource: &Resource| match resource {
        Resource::VertexLight(part) => Some(light(*part)),
        own => {
            let place = prepared.ours.iter().position(|(of, ..)| of == own)?;
            Some((AirglowRadianceResource::Own as u32, place as u32))
        }
    };
    let row = |resource: Resource, origin, bytes| {
        let (number, name) = (number(&resource)?, resource.to_string());
        Some(access::Resource { number, name, what: What::Buffer(origin, bytes) })
    };
    let lights = (0..).zip(&prepared.light_bytes);
    let lights = lights.map(|(part, bytes)| row(Resource::VertexLight(part), AirglowOrigin::Host, *bytes));
    let own = prepared.ours.iter().map(|(of, buffer, _)| row(*of, AirglowOrigin::Library, buffer.size()));
    let resources = lights.chain(own).flatten().collect();
    let step = |stage: &airglow_radiance::Stage| {
        stage.uses.iter().filter_map(|(of, how)| Some((number(of)?, *how))).collect()
    };
    let steps: Vec<_> =
        prepared.stages.iter().map(|stage| Step { name: stage.name, uses: step(stage) }).collect();
    Uses::new(resources, &steps)
}

/// Prepares the light of a receiver's vertices. `*prepared` gets null where no emitter gives light, or no vertex reflects
/// any: then there is nothing to record, and no light of vertices.
///
/// # Safety
/// `lights` points at as many bytes as it says, and its arrays have as many elements as it says; `prepared` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_radiance_prepare(
    radiance: *const AirglowRadiance,
    receiver: *const AirglowRadianceReceiver,
    lights: *const AirglowRadianceLights,
    prepared: *mut *mut AirglowPrepared,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            give_if(prepared, "prepared", || {
                let AirglowRadiance { context, radiance } = shared(radiance, "radiance")?;
                let receiver = &shared(receiver, "receiver")?.receiver;
                let given = versioned(lights, "lights")?.read()?;
                let prepared = radiance.prepare(receiver, &given.lights())?;
                let left_out = prepared.left_out.is_some();
                let frame =
                    || AirglowPrepared::new(context, uses(&prepared), RadianceFrame(prepared.clone()));
                Ok((!left_out).then(frame))
            })
        })
    }
}

/// Sets the lights of a prepared frame, which count from the next recording on; while emitters stay, no sample is taken
/// again. On an error the old ones stay.
///
/// # Safety
/// As `airglow_radiance_prepare`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_radiance_set(
    prepared: *const AirglowPrepared,
    lights: *const AirglowRadianceLights,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let RadianceFrame(frame) = shared(prepared, "prepared")?.of()?;
            let given = versioned(lights, "lights")?.read()?;
            match &frame.control {
                Some(control) => Ok(control.set(&given.lights())?),
                // A frame that was left out is none.
                None => Ok(()),
            }
        })
    }
}
