//! A view as data, changed from frame to frame, and its commands in the host's own command buffer.

use std::ffi::CString;
use std::sync::{Arc, Mutex, PoisonError};

use airglow_fog::{ACCESSES, Bindings, Frame, Light, Pass, PhaseKind, Prepared};
use airglow_gpu::ash::{vk, vk::Handle};
use airglow_gpu::{Context, GpuError, Recorder};

use super::AirglowFog;
use super::view::AirglowFogView;
use crate::access::{AirglowAccess, AirglowOrigin};
use crate::binding::{AirglowBinding, Imported, Kept};
use crate::input::{array, shared, store, take, versioned};
use crate::status::{AirglowError, AirglowStatus, Failure, edge};
use crate::text::write_array;

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

/// Lights of a view.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowFogCounts {
    /// Those whose airlight passes the bound somewhere in the picture.
    pub evaluated: u32,
    /// Those left out: dark, too weak, or out of reach of every pixel.
    pub left_out: u32,
}

/// A view of the pass, ready to be recorded, in as many frames as wanted. One thread at a time.
pub struct AirglowFogPrepared {
    context: Arc<Context>,
    pass: Pass,
    phase: PhaseKind,
    /// Memory for the lights of the next view.
    lights: Mutex<Vec<Light>>,
    /// What it was recorded with.
    kept: Mutex<Kept<Bindings>>,
    /// Names that the host was given pointers to: of the resources, and of the step.
    names: [CString; 3],
    step: CString,
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
    prepared: *mut *mut AirglowFogPrepared,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            store(prepared, "prepared", || {
                let AirglowFog { context, fog } = shared(fog, "fog")?;
                let phase = fog.settings().phase;
                let view = versioned(view, "view")?.read(phase, Vec::new())?;
                let frame = Frame { size: [width, height], surface: (), depth: (), target: Some(()), view };
                let Prepared::Pass(pass) = fog.prepare(&frame)? else { return Ok(std::ptr::null_mut()) };
                // None of them has a nul within.
                let text = |name: &str| CString::new(name).unwrap_or_default();
                Ok(Box::into_raw(Box::new(AirglowFogPrepared {
                    context: Arc::clone(context),
                    pass,
                    phase,
                    lights: Mutex::new(frame.view.lights),
                    kept: Mutex::default(),
                    names: ACCESSES.map(|(name, _)| text(name)),
                    step: text("fog airlight"),
                })))
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
    prepared: *const AirglowFogPrepared,
    view: *const AirglowFogView,
    counts: *mut AirglowFogCounts,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let prepared = shared(prepared, "prepared")?;
            let view = versioned(view, "view")?;
            let mut lights = prepared.lights.lock().unwrap_or_else(PoisonError::into_inner);
            let view = view.read(prepared.phase, std::mem::take(&mut *lights))?;
            let set = prepared.pass.control.set(&view);
            *lights = view.lights;
            let (evaluated, left_out) = set.map(|counts| (counts.evaluated, counts.left_out))?;
            if counts.is_null() {
                return Ok(());
            }
            store(counts, "counts", || Ok(AirglowFogCounts { evaluated, left_out }))
        })
    }
}

/// Lists the uses of the host's images: one step, which reads surface and depth and writes the target. The host brings
/// each into that layout before, and waits for that use after. `*count` as with `airglow_prepared_accesses`.
///
/// # Safety
/// `accesses` is null or has room for `*count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_accesses(
    prepared: *const AirglowFogPrepared,
    accesses: *mut AirglowAccess,
    count: *mut usize,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe { edge(error, || write_array(accesses, count, &shared(prepared, "prepared")?.accesses())) }
}

/// Records the pass into a command buffer of the host's: one rendering, without a barrier. Bound are the three resources.
/// State of the command buffer that is changed: pipeline, descriptor set 0, vertex buffer 0, viewport 0 and scissor 0 of
/// graphics. Rendering and labels are closed again.
///
/// The last few sets of bindings are kept: recorded again with one of them, a view allocates nothing on the heap. Images
/// that were bound stay until `airglow_fog_forget` or until the prepared view is dropped.
///
/// # Safety
/// As `airglow_prepared_record`: the command buffer records outside rendering, bindings describe live images truly, and
/// these are in the layouts listed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_record(
    prepared: *const AirglowFogPrepared,
    command_buffer: u64,
    bindings: *const AirglowBinding,
    binding_count: usize,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for pointers, handles and layouts.
    unsafe {
        edge(error, || {
            let prepared = shared(prepared, "prepared")?;
            if command_buffer == 0 {
                return Err(Failure::argument("command_buffer", "it is null"));
            }
            let given = array(bindings, binding_count, "bindings")?;
            let mut kept = prepared.kept.lock().unwrap_or_else(PoisonError::into_inner);
            let bound = kept.set(given, || prepared.import(given))?;
            let mut recorder = Recorder::new(&prepared.context, vk::CommandBuffer::from_raw(command_buffer));
            Ok(prepared.pass.record(&mut recorder, bound)?)
        })
    }
}

/// Forgets the images that the view was recorded with: before the host destroys one of them.
///
/// # Safety
/// Nothing beyond the pointers being valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_forget(
    prepared: *const AirglowFogPrepared,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            shared(prepared, "prepared")?.kept.lock().unwrap_or_else(PoisonError::into_inner).forget();
            Ok(())
        })
    }
}

/// Drops a prepared view. Null is nothing.
///
/// # Safety
/// The pointer is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_prepared_drop(prepared: *mut AirglowFogPrepared) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(std::ptr::null_mut(), || take(prepared)) };
}

impl AirglowFogPrepared {
    fn accesses(&self) -> [AirglowAccess; 3] {
        let row = |resource: usize| {
            let (_, access) = ACCESSES[resource];
            AirglowAccess {
                resource: resource as u32,
                index: 0,
                origin: AirglowOrigin::Host as u32,
                step: 0,
                stage: access.stage().as_raw(),
                access: access.access().as_raw(),
                layout: access.layout().as_raw() as u32,
                writes: u32::from(access.writes()),
                name: self.names[resource].as_ptr(),
                step_name: self.step.as_ptr(),
            }
        };
        [0, 1, 2].map(row)
    }

    /// The host's images.
    ///
    /// # Safety
    /// As [`airglow_fog_record`].
    unsafe fn import(&self, given: &[AirglowBinding]) -> Result<Bindings, Failure> {
        if let Some(other) = given.iter().find(|binding| binding.resource as usize >= ACCESSES.len()) {
            let problem = format!("the view does not use resource {}; leave it out", other.resource);
            return Err(Failure::argument("bindings", &problem));
        }
        let view = |resource: AirglowFogResource| {
            let (name, _) = ACCESSES[resource as usize];
            let wanted = |binding: &&AirglowBinding| binding.resource == resource as u32;
            let binding = given.iter().find(wanted).ok_or_else(|| GpuError::misuse(name, "bind it"))?;
            // SAFETY: the caller vouches for what the binding says.
            match unsafe { binding.import(&self.context, name)? } {
                Imported::Image(view) => Ok(view),
                Imported::Buffer(_) => Err(Failure::from(GpuError::misuse(name, "give an image"))),
            }
        };
        Ok(Bindings {
            surface: view(AirglowFogResource::Surface)?,
            depth: view(AirglowFogResource::Depth)?,
            target: view(AirglowFogResource::Target)?,
        })
    }
}
