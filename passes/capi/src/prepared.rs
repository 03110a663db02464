//! Frames of passes, whichever: as data for the host's own frame graph, and as commands in its own command buffer.

use std::sync::Arc;

use airglow_gpu::ash::{vk, vk::Handle};
use airglow_gpu::{Context, Label, Location, Recorder};
use airglow_graph::{BufferDesc, ImageDesc, ResourceDesc};

use crate::access::{AirglowAccess, AirglowResourceInfo, Number, Uses};
use crate::binding::{AirglowBinding, Bound, Imported};
use crate::input::{array, exclusive, shared, take};
use crate::pass::{AnyFrame, Frame, Recorded};
use crate::status::{AirglowError, AirglowStatus, Failure, edge};
use crate::text::write_array;

/// A frame of a pass, ready to be recorded, and again in later frames: a pass has functions that change it in between.
/// One thread at a time. It may outlive its pass.
pub struct AirglowPrepared {
    context: Arc<Context>,
    uses: Uses,
    /// What the library made for it.
    scratch: Vec<(Number, Imported)>,
    frame: Box<dyn AnyFrame>,
}

/// Lists every use of every resource, step by step. Before recording, the host makes its own resources, and the scratch,
/// available to the first use listed of each, in that layout; afterwards it waits for the last. Between the steps the
/// library stands its own barriers; layouts of scratch images are all its own. `*count` holds the size of
/// `accesses` before and the number of uses after; with `accesses` null only the number is written.
///
/// # Safety
/// `accesses` is null or has room for `*count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_prepared_accesses(
    prepared: *const AirglowPrepared,
    accesses: *mut AirglowAccess,
    count: *mut usize,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe { edge(error, || write_array(accesses, count, &shared(prepared, "prepared")?.uses.accesses)) }
}

/// Lists every resource that the frame uses, with its bytes, before anything is made. `*count` as with
/// `airglow_prepared_accesses`.
///
/// # Safety
/// `resources` is null or has room for `*count` elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_prepared_resources(
    prepared: *const AirglowPrepared,
    resources: *mut AirglowResourceInfo,
    count: *mut usize,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe { edge(error, || write_array(resources, count, &shared(prepared, "prepared")?.uses.resources)) }
}

/// Makes the scratch of a frame, charged to its pass in the context's memory, for hosts that would not place it
/// themselves. Calling it again makes it anew.
///
/// # Safety
/// Nothing beyond the pointers being valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_prepared_make_scratch(
    prepared: *mut AirglowPrepared,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(error, || exclusive(prepared, "prepared")?.make_scratch()) }
}

/// Records a frame into a command buffer of the host's: its steps, with barriers between them and none around them
/// (`airglow_prepared_accesses`). Bound are the host's resources, and the scratch unless
/// `airglow_prepared_make_scratch` made it. State of the command buffer that is changed: pipelines, descriptor set 0 and
/// push constants of both bind points, vertex buffer 0, viewport 0, scissor 0. Rendering and labels are closed again.
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
            let AirglowPrepared { context, uses, scratch, frame } = shared(prepared, "prepared")?;
            if command_buffer == 0 {
                return Err(Failure::argument("command_buffer", "it is null"));
            }
            let given = array(bindings, binding_count, "bindings")?;
            let mut recorder = Recorder::new(context, vk::CommandBuffer::from_raw(command_buffer));
            frame.record(&mut recorder, given, &|| Bound::new(context, uses, scratch, given))
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
            shared(prepared, "prepared")?.frame.forget();
            Ok(())
        })
    }
}

/// Drops a prepared frame. Null is nothing.
///
/// # Safety
/// The pointer is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_prepared_drop(prepared: *mut AirglowPrepared) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(std::ptr::null_mut(), || take(prepared)) };
}

#[allow(dead_code, reason = "helpers of passes, of which there may be none")]
impl AirglowPrepared {
    pub(crate) fn new(context: &Arc<Context>, uses: Uses, frame: impl Frame) -> Self {
        let frame = Box::new(Recorded::new(frame));
        Self { context: Arc::clone(context), uses, scratch: Vec::new(), frame }
    }

    /// The pass whose frame it is.
    pub(crate) fn pass(&self) -> &'static str {
        self.frame.pass()
    }

    pub(crate) fn frame(&self) -> &dyn AnyFrame {
        &*self.frame
    }

    /// What the host binds, as the frame takes it.
    pub(crate) fn bound<'a>(&'a self, given: &'a [AirglowBinding]) -> Result<Bound<'a>, Failure> {
        // SAFETY: the caller of the exported function vouches for what is bound.
        unsafe { Bound::new(&self.context, &self.uses, &self.scratch, given) }
    }

    pub(crate) fn context(&self) -> &Context {
        &self.context
    }

    /// The frame of a pass; that of another is refused.
    pub(crate) fn of<F: Frame>(&self) -> Result<&F, Failure> {
        self.frame.frame().downcast_ref().ok_or_else(|| {
            let problem = format!("it is a frame of {}: give one of {}", self.frame.pass(), F::PASS);
            Failure::argument("prepared", &problem)
        })
    }

    fn make_scratch(&mut self) -> Result<(), Failure> {
        let mut made = Vec::new();
        for (number, desc) in &self.uses.scratch {
            let Some((row, name)) = self.uses.find(*number) else { continue };
            let label = Label::new(self.frame.pass(), name);
            made.push((
                *number,
                match desc {
                    ResourceDesc::Buffer(desc) => {
                        let usage = desc.usage | vk::BufferUsageFlags::from_raw(row.usage);
                        let desc = BufferDesc { usage, ..*desc };
                        Imported::Buffer(
                            (&self.context.create_buffer(label, &desc, Location::Device)?).into(),
                        )
                    }
                    ResourceDesc::Image(desc) => {
                        let usage = desc.usage | vk::ImageUsageFlags::from_raw(row.usage);
                        let image = self.context.create_image(label, &ImageDesc { usage, ..*desc })?;
                        Imported::Image(image.full_view()?)
                    }
                },
            ));
        }
        self.scratch = made;
        self.frame.forget();
        Ok(())
    }
}
