//! The commands of a prepared frame, in the host's own command buffer.

use std::sync::{MutexGuard, PoisonError};

use airglow_gpu::ash::{vk, vk::Handle};
use airglow_gpu::{Label, Recorder};
use airglow_graph::{BufferDesc, ImageDesc};
use airglow_relight::{Bindings, Need, Resource};

use super::misuse;
use super::prepared::AirglowPrepared;
use super::resources::number;
use crate::input::{array, shared};
use crate::status::{AirglowError, AirglowStatus, Failure, edge};

/// A resource of the host's, for one recording: a buffer or an image. Elements of arrays never grow.
#[repr(C)]
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct AirglowBinding {
    /// An `AirglowResource`.
    pub resource: u32,
    /// See `AirglowResource`.
    pub index: u32,
    /// The `VkBuffer`, or 0 for an image.
    pub buffer: u64,
    /// First byte of the resource in the buffer.
    pub offset: u64,
    /// Bytes of the whole buffer.
    pub size: u64,
    /// The `VkImage`, 2D with one sample, or 0 for a buffer.
    pub image: u64,
    /// `VkFormat` of the image.
    pub format: u32,
    /// `VkBufferUsageFlags` or `VkImageUsageFlags` that it was made with.
    pub usage: u32,
    /// Width and height of the image.
    pub extent: [u32; 2],
    /// Mips of the image; 0 is 1.
    pub mips: u32,
    /// Not used; 0.
    pub reserved: u32,
}

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
            shared(prepared, "prepared")?.kept().sets.clear();
            Ok(())
        })
    }
}

/// Sets of bindings that are kept: as many as a host has frames in flight, and some.
const MOST_KEPT: usize = 8;

/// What a frame was recorded with, the last set at the end.
#[derive(Default)]
pub(super) struct Kept {
    pub sets: Vec<(Vec<AirglowBinding>, Bindings)>,
}

impl Kept {
    /// The set for `given`, made by `import` where it is not here.
    fn set(
        &mut self,
        given: &[AirglowBinding],
        import: impl FnOnce() -> Result<Bindings, Failure>,
    ) -> Result<&mut Bindings, Failure> {
        match self.sets.iter().position(|(known, _)| known == given) {
            Some(place) => self.sets[place..].rotate_left(1),
            None => {
                let bound = import()?;
                if self.sets.len() == MOST_KEPT {
                    self.sets.remove(0);
                }
                self.sets.push((given.to_vec(), bound));
            }
        }
        let problem = "no set of bindings is kept";
        self.sets.last_mut().map(|(_, bound)| bound).ok_or_else(|| Failure::argument("bindings", problem))
    }
}

impl AirglowPrepared {
    pub(super) fn kept(&self) -> MutexGuard<'_, Kept> {
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
            let label = Label::new("host", &name);
            match (binding.buffer, binding.image) {
                (0, image) if image != 0 => {
                    let [width, height] = binding.extent;
                    let desc = ImageDesc {
                        usage: vk::ImageUsageFlags::from_raw(binding.usage),
                        mips: binding.mips.max(1),
                        ..ImageDesc::new_2d(width, height, vk::Format::from_raw(binding.format as i32))
                    };
                    // SAFETY: the caller vouches for the image.
                    let image =
                        unsafe { self.context.import_image(vk::Image::from_raw(image), label, &desc) };
                    bound.images.insert(resource, image.view(airglow_gpu::ViewDesc::single(0, 0))?);
                }
                (buffer, 0) if buffer != 0 => {
                    let usage = vk::BufferUsageFlags::from_raw(binding.usage);
                    let desc = BufferDesc { size: binding.size, usage };
                    // SAFETY: the caller vouches for the buffer.
                    let buffer =
                        unsafe { self.context.import_buffer(vk::Buffer::from_raw(buffer), label, &desc) };
                    let rest = binding.size.saturating_sub(binding.offset);
                    bound.buffers.insert(resource, buffer.slice(binding.offset, rest)?);
                }
                _ => return Err(misuse(name, "give a buffer or an image, not both or none")),
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
