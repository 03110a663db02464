//! The next steps of a map's build as a frame.

use airglow_gpu::Recorder;
use airglow_normals::{Build, Resource, Stage};

use super::PASS;
use super::map::AirglowNormalMap;
use crate::access::{self, AirglowOrigin, Step, Uses, What};
use crate::binding::Bound;
use crate::input::shared;
use crate::pass::{Frame, give_if};
use crate::prepared::AirglowPrepared;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};

/// What a step of a build uses; all are the library's own.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowNormalsResource {
    /// The texture of lobes.
    Texture = 0,
    /// A buffer; the index counts them, the name says which.
    Own = 1,
}

/// Steps of a build.
struct NormalsFrame(Vec<Stage>);

impl Frame for NormalsFrame {
    const PASS: &'static str = PASS;
    type Bindings = ();

    fn bind(&self, _: &Bound<'_>) -> Result<(), Failure> {
        Ok(())
    }

    fn record(&self, recorder: &mut Recorder<'_>, (): &mut ()) -> Result<(), Failure> {
        let step = |recorder: &mut Recorder<'_>, stage: &Stage| stage.record_with_barriers(recorder);
        self.0
            .iter()
            .try_for_each(|stage| Ok(recorder.labelled(stage.name(), |recorder| step(recorder, stage))?))
    }
}

fn uses(build: &Build, stages: &[Stage]) -> Uses {
    let mut all: Vec<_> = stages.iter().flat_map(Stage::accesses).map(|(of, _)| *of).collect();
    all.sort_unstable();
    all.dedup();
    let number = |of: Resource| match of {
        Resource::Texture => (AirglowNormalsResource::Texture as u32, 0),
        own => {
            let place = all.iter().take_while(|other| **other != own).count();
            (AirglowNormalsResource::Own as u32, place as u32)
        }
    };
    let resource = |of: &Resource| {
        let bytes = build.buffer(*of).map(|buffer| What::Buffer(AirglowOrigin::Library, buffer.size()));
        let what = bytes.unwrap_or(What::Image(AirglowOrigin::Library));
        access::Resource { number: number(*of), name: format!("normals {of:?}"), what }
    };
    let step = |stage: &Stage| stage.accesses().iter().map(|(of, how)| (number(*of), *how)).collect();
    let steps: Vec<_> = stages.iter().map(|stage| Step { name: stage.name(), uses: step(stage) }).collect();
    Uses::new(all.iter().map(resource).collect(), &steps)
}

/// Prepares the next steps of a map's build, at most `most`; they count as taken. `*prepared` gets null when none are left.
/// Steps work on what earlier ones wrote: record each once, in order, in one frame or in many. Nothing is bound, and
/// the host makes no barrier: after the last step the texture is ready for its fragment shaders.
///
/// # Safety
/// `prepared` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_normal_map_prepare(
    map: *const AirglowNormalMap,
    most: usize,
    prepared: *mut *mut AirglowPrepared,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            give_if(prepared, "prepared", || {
                let map = shared(map, "map")?;
                let mut state = map.state();
                if most == 0 {
                    return Err(Failure::argument("most", "it is 0: give one step at least"));
                }
                let Some(build) = &mut state.build else { return Ok(None) };
                let stages = build.take(most).to_vec();
                let uses = uses(build, &stages);
                let some = !stages.is_empty();
                Ok(some.then(|| AirglowPrepared::new(&map.context, uses, NormalsFrame(stages))))
            })
        })
    }
}
