//! The commands of a prepared frame, in the host's own command buffer.

use std::sync::{MutexGuard, PoisonError};

use airglow_gpu::Recorder;
use airglow_gpu::ash::{vk, vk::Handle};
use airglow_relight::{Bindings, Need, Resource};

use super::misuse;
use super::prepared::AirglowPrepared;
use super::resources::number;
use crate::binding::{AirglowBinding, Imported, Kept};
use crate::input::{array, shared};
use crate::status::{AirglowError, AirglowStatus, Failure, edge};

/// Records a frame into a command buffer of the host's: its steps, with barriers between them and none around them
/// (`airglow_prepared_accesses`). Bound are the host's resources, and the scratch unless
/// `airglow_prepared_make_scratch` made it. State of the command buffer that is changed: pipelines, descriptor set 0 and
/// push constants of both bind points, viewport 0, scissor 0. Rendering and labels are closed again.
///
/// The last few sets of bindings are kept: recorded again with one of them, a frame allocates nothing on the heap. Images
/// that were bound stay until `airglow_prepared_forget` or until the prepared frame is dropped.
///
/// # Safety
/// `command_buffer` is a primary `VkCommandBuffer` of a pool of the adopted queue family, recording, outside rendering,
/// used by no one else meanwhile; it is submitted at most once, in the context's frame. Bindings describe live resources
/// of the device truly, which stay until the frame is done; host and scratch resources are in the states listed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_prepared_record(
    prepared: *const AirglowPrepared,
    command_buffer: u64,
    bindings: *const AirglowBinding,
    binding_count: usize,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for pointers, handles and states.
    unsafe {
        edge(error, || {
            let frame = shared(prepared, "prepared")?;
            if command_buffer == 0 {
                return Err(Failure::argument("command_buffer", "it is null"));
            }
            let given = array(bindings, binding_count, "bindings")?;
            let mut kept = frame.kept();
            let bound = kept.set(given, || frame.import(given))?;
            let commands = vk::CommandBuffer::from_raw(command_buffer);
            let mut recorder = Recorder::new(&frame.context, commands);
            let needed = |wanted| frame.prepared.needs.iter().any(|(resource, _)| *resource == wanted);
            if let Some(sky) = frame.sky.as_ref().filter(|_| needed(Resource::Environment)) {
                bound.images.insert(Resource::Environment, sky.bind(&mut recorder)?);
            }
            Ok(frame.prepared.record(&mut recorder, bound)?)
        })
    }
}

/// Forgets the resources that the frame was recorded with: before the host destroys an image among them.
///
/// # Safety
/// Nothing beyond the pointers being valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_prepared_forget(
    prepared: *const AirglowPrepared,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            shared(prepared, "prepared")?.kept().forget();
            Ok(())
        })
    }
}

impl AirglowPrepared {
    pub(super) fn kept(&self) -> MutexGuard<'_, Kept<Bindings>> {
        // A poisoned lock means a panic that was reported as a defect; the data is whole.
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The scratch, and the host's resources.
    ///
    /// # Safety
    /// As [`airglow_prepared_record`].
    unsafe fn import(&self, given: &[AirglowBinding]) -> Result<Bindings, Failure> {
        let mut bound = self.scratch.clone();
        for binding in given {
            let resource = self.wanted(binding)?;
            let name = resource.to_string();
            // SAFETY: the caller vouches for what the binding says.
            match unsafe { binding.import(&self.context, &name)? } {
                Imported::Image(view) => drop(bound.images.insert(resource, view)),
                Imported::Buffer(slice) => drop(bound.buffers.insert(resource, slice)),
            }
        }
        Ok(bound)
    }

    /// The resource that a binding is for.
    fn wanted(&self, binding: &AirglowBinding) -> Result<Resource, Failure> {
        let (wanted, index) = (binding.resource, binding.index);
        let found = self.prepared.needs.iter().find(|(resource, _)| {
            let (number, its_index) = number(*resource);
            (number as u32, its_index) == (wanted, index)
        });
        match found {
            Some((resource, Need::Host | Need::Scratch(_))) => Ok(*resource),
            Some((resource, Need::Ours { .. })) => {
                Err(misuse(resource.to_string(), "it is the library's own; leave it out of the bindings"))
            }
            None => {
                let problem =
                    format!("the frame does not use resource {wanted}, index {index}; leave it out");
                Err(Failure::argument("bindings", &problem))
            }
        }
    }
}
