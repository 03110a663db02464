//! A view as data, changed from frame to frame.

use std::sync::{Mutex, PoisonError};

use airglow_fog::{ACCESSES, Bindings, Counts, Light, Pass, PhaseKind, Prepared};
use airglow_gpu::Recorder;

use super::AirglowFog;
use super::view::AirglowFogView;
use crate::access::{AirglowOrigin, Resource, Step, Uses, What};
use crate::binding::Bound;
use crate::input::{shared, store, versioned};
use crate::pass::{Frame, give_if};
use crate::prepared::AirglowPrepared;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};

/// What the pass uses; all are images of the host's.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowFogResource {
    /// Scene-linear radiance of the surfaces without the medium, any float format.
    Surface = 0,
    /// Their depth, by the host's `AirglowWorld`; the farthest value shows no surface.
    Depth = 1,
    /// The picture through the medium, in the format of the settings; all of it is written.
    Target = 2,
}

/// Lights of a view, and pairs of a tile of the picture and a light.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowFogCounts {
    /// Lights whose airlight passes the bound somewhere in the picture.
    pub evaluated: u32,
    /// Lights left out: dark, too weak, or out of reach of every pixel.
    pub left_out: u32,
    /// Pairs of a tile, `AIRGLOW_FOG_TILE` pixels on a side, and a light that is evaluated in it.
    pub pairs: u32,
    /// Pairs left out: with those evaluated, as many as there are tiles times lights.
    pub pairs_left_out: u32,
}

/// Pixels along a side of a tile.
pub const AIRGLOW_FOG_TILE: u32 = 64;

const _: () = assert!(AIRGLOW_FOG_TILE == airglow_fog::TILE);

/// A view of the pass.
pub(super) struct FogFrame {
    pass: Pass,
    phase: PhaseKind,
    /// Memory for the lights of the next view.
    lights: Mutex<Vec<Light>>,
}

impl Frame for FogFrame {
    const PASS: &'static str = "fog";
    type Bindings = Bindings;

    fn bind(&self, bound: &Bound<'_>) -> Result<Bindings, Failure> {
        let image = |resource: AirglowFogResource| bound.image((resource as u32, 0));
        Ok(Bindings {
            surface: image(AirglowFogResource::Surface)?,
            depth: image(AirglowFogResource::Depth)?,
            target: image(AirglowFogResource::Target)?,
        })
    }

    fn record(&self, recorder: &mut Recorder<'_>, bindings: &mut Bindings) -> Result<(), Failure> {
        Ok(self.pass.record(recorder, bindings)?)
    }
}

/// Three images of the host's, in one step.
fn uses() -> Uses {
    let numbered = || (0..).zip(ACCESSES);
    let resource = |(number, (name, _)): (u32, (&str, _))| {
        let what = What::Image(AirglowOrigin::Host);
        Resource { number: (number, 0), name: format!("fog {name}"), what }
    };
    let uses = numbered().map(|(number, (_, access))| ((number, 0), access)).collect();
    Uses::new(numbered().map(resource).collect(), &[Step { name: "fog airlight", uses }])
}

/// Prepares a view of `width * height` pixels. `*prepared` gets null where the medium is clear: then there is nothing to
/// record, and the surface is the picture.
///
/// # Safety
/// `view` points at as many bytes as it says, and so does its world; its lights are as many as it says; `prepared` may be
/// written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_prepare(
    fog: *const AirglowFog,
    width: u32,
    height: u32,
    view: *const AirglowFogView,
    prepared: *mut *mut AirglowPrepared,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            give_if(prepared, "prepared", || {
                let AirglowFog { context, fog } = shared(fog, "fog")?;
                let phase = fog.settings().phase;
                let view = versioned(view, "view")?.read(phase, Vec::new())?;
                let size = [width, height];
                let frame = airglow_fog::Frame { size, surface: (), depth: (), target: Some(()), view };
                let Prepared::Pass(pass) = fog.prepare(&frame)? else { return Ok(None) };
                let frame = FogFrame { pass, phase, lights: Mutex::new(frame.view.lights) };
                Ok(Some(AirglowPrepared::new(context, uses(), frame)))
            })
        })
    }
}

/// Sets camera, medium and lights of a prepared view, which count from the next recording on; lamps that come and go
/// allocate nothing once there were as many. A clear medium is refused: leave the pass out, or prepare anew. On an error
/// the view stays. `counts` may be null.
///
/// # Safety
/// As `airglow_fog_prepare`; `counts` is null or may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_set(
    prepared: *const AirglowPrepared,
    view: *const AirglowFogView,
    counts: *mut AirglowFogCounts,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let frame: &FogFrame = shared(prepared, "prepared")?.of()?;
            let view = versioned(view, "view")?;
            let mut lights = frame.lights.lock().unwrap_or_else(PoisonError::into_inner);
            let view = view.read(frame.phase, std::mem::take(&mut *lights))?;
            let set = frame.pass.control.set(&view);
            *lights = view.lights;
            let Counts { evaluated, left_out, pairs, pairs_left_out } = set?;
            if counts.is_null() {
                return Ok(());
            }
            store(counts, "counts", || Ok(AirglowFogCounts { evaluated, left_out, pairs, pairs_left_out }))
        })
    }
}
