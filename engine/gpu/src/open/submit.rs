//! Submitting and waiting: the host's part, kept out of the library proper.

use super::OpenDevice;
use crate::context::Context;
use crate::error::GpuError;
use crate::recorder::Recorder;
use ash::vk;

/// Semaphores around one frame's commands, for a window.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrameSemaphores {
    /// Waited for before anything of the frame runs.
    pub wait: Option<vk::Semaphore>,
    /// Signalled when all is done.
    pub signal: Option<vk::Semaphore>,
}

impl OpenDevice {
    /// Records one frame of `context`, submits it, and waits until it is done.
    ///
    /// # Errors
    /// The error of `record`, after which nothing is submitted; [`GpuError::Misuse`] for a context of another device;
    /// [`GpuError::Vulkan`].
    pub fn run<R>(
        &self,
        context: &Context,
        record: impl FnOnce(&mut Recorder<'_>) -> Result<R, GpuError>,
    ) -> Result<R, GpuError> {
        let mut frames = FrameLoop::new(self, context)?;
        let result = frames.frame(FrameSemaphores::default(), |command_buffer| {
            // SAFETY: the loop's command buffer is recording, its frame is the context's, and it is submitted once.
            record(&mut unsafe { Recorder::new(context, command_buffer) })
        })?;
        frames.finish()?;
        Ok(result)
    }

    /// Waits until the device has finished everything.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`] when the device is lost.
    pub fn wait_idle(&self) -> Result<(), GpuError> {
        // SAFETY: a live device; this thread alone submits to its queue.
        unsafe { self.device.device_wait_idle() }.map_err(GpuError::vulkan("vkDeviceWaitIdle"))
    }
}

/// The frames of a context: as many command buffers and fences as it has frames in flight.
pub struct FrameLoop<'d> {
    device: &'d OpenDevice,
    context: &'d Context,
    slots: Vec<Slot>,
    next: usize,
    /// The frame begun last here; if the context is elsewhere by now, another loop may have frames on the device.
    last: Option<u64>,
}

struct Slot {
    command_buffer: vk::CommandBuffer,
    fence: vk::Fence,
    /// Whether the fence is on its way to be signalled.
    busy: bool,
}

impl<'d> FrameLoop<'d> {
    /// A loop over the frames of `context`.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for a context of another device, [`GpuError::Vulkan`] if the device refuses.
    pub fn new(device: &'d OpenDevice, context: &'d Context) -> Result<Self, GpuError> {
        if context.device().handle() != device.device.handle() {
            return Err(GpuError::misuse("a frame loop", "the context was adopted from another device"));
        }
        let mut frames = Self { device, context, slots: Vec::new(), next: 0, last: None };
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(device.command_pool)
            .command_buffer_count(1);
        for _ in 0..context.frames_in_flight() {
            // SAFETY: the pool is this device's; what was made is freed with the slot.
            unsafe {
                let fence = device
                    .device
                    .create_fence(&Default::default(), None)
                    .map_err(GpuError::vulkan("vkCreateFence"))?;
                frames.slots.push(Slot { command_buffer: vk::CommandBuffer::null(), fence, busy: false });
                let command_buffers = device
                    .device
                    .allocate_command_buffers(&info)
                    .map_err(GpuError::vulkan("vkAllocateCommandBuffers"))?;
                if let (Some(slot), Some(&made)) = (frames.slots.last_mut(), command_buffers.first()) {
                    slot.command_buffer = made;
                }
            }
        }
        Ok(frames)
    }

    /// Begins a frame of the context, records it and submits it. Waits only for the frame that used the slot before.
    ///
    /// # Errors
    /// The error of `record`, after which nothing is submitted, or [`GpuError::Vulkan`].
    pub fn frame<R>(
        &mut self,
        semaphores: FrameSemaphores,
        record: impl FnOnce(vk::CommandBuffer) -> Result<R, GpuError>,
    ) -> Result<R, GpuError> {
        if self.last != Some(self.context.frame()) {
            self.device.wait_idle()?;
        }
        let frame = self.context.frame() + 1;
        let device = &self.device.device;
        let slot = &mut self.slots[self.next];
        slot.wait(device)?;
        let command_buffer = slot.command_buffer;
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the frame that used the slot, and with it all frames before, are done: either this loop began the
        // last `frames_in_flight` frames and waited for the oldest, or the device was idle.
        unsafe {
            self.context.begin_frame(frame)?;
            self.last = Some(frame);
            device
                .begin_command_buffer(command_buffer, &begin)
                .map_err(GpuError::vulkan("vkBeginCommandBuffer"))?;
        }
        let result = record(command_buffer).inspect_err(|_| {
            // SAFETY: the command buffer was not submitted. If resetting fails too, the first error is the one to tell.
            let _ = unsafe { device.reset_command_buffer(command_buffer, Default::default()) };
        })?;
        slot.submit(device, self.device.queue, semaphores)?;
        self.next = (self.next + 1) % self.slots.len();
        Ok(result)
    }

    /// Waits for every frame, and begins one, so that what was dropped is destroyed.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`] when the device is lost.
    pub fn finish(&mut self) -> Result<(), GpuError> {
        self.device.wait_idle()?;
        let frame = self.context.frame() + u64::from(self.context.frames_in_flight());
        // SAFETY: everything submitted is done.
        unsafe { self.context.begin_frame(frame) }?;
        self.last = None;
        Ok(())
    }
}

impl Slot {
    /// Waits until the slot's frame is done.
    fn wait(&mut self, device: &ash::Device) -> Result<(), GpuError> {
        if !self.busy {
            return Ok(());
        }
        // SAFETY: a live fence whose submission was accepted.
        unsafe {
            device
                .wait_for_fences(&[self.fence], true, u64::MAX)
                .map_err(GpuError::vulkan("vkWaitForFences"))?;
            self.busy = false;
            device.reset_fences(&[self.fence]).map_err(GpuError::vulkan("vkResetFences"))
        }
    }

    fn submit(
        &mut self,
        device: &ash::Device,
        queue: vk::Queue,
        semaphores: FrameSemaphores,
    ) -> Result<(), GpuError> {
        let command_buffers = [vk::CommandBufferSubmitInfo::default().command_buffer(self.command_buffer)];
        let semaphore = |semaphore: Option<vk::Semaphore>| {
            let stages = vk::PipelineStageFlags2::ALL_COMMANDS;
            [vk::SemaphoreSubmitInfo::default().semaphore(semaphore.unwrap_or_default()).stage_mask(stages)]
        };
        let (wait, signal) = (semaphore(semaphores.wait), semaphore(semaphores.signal));
        let info = vk::SubmitInfo2::default()
            .command_buffer_infos(&command_buffers)
            .wait_semaphore_infos(&wait[..usize::from(semaphores.wait.is_some())])
            .signal_semaphore_infos(&signal[..usize::from(semaphores.signal.is_some())]);
        // SAFETY: the command buffer was just recorded, its fence is unsignalled; this thread alone submits.
        unsafe {
            device.end_command_buffer(self.command_buffer).map_err(GpuError::vulkan("vkEndCommandBuffer"))?;
            device.queue_submit2(queue, &[info], self.fence).map_err(GpuError::vulkan("vkQueueSubmit2"))?;
        }
        self.busy = true;
        Ok(())
    }
}

impl Drop for FrameLoop<'_> {
    fn drop(&mut self) {
        let device = &self.device.device;
        for slot in &mut self.slots {
            // A lost device has finished too.
            let _ = slot.wait(device);
            // SAFETY: the slot's work is done.
            unsafe {
                device.destroy_fence(slot.fence, None);
                device.free_command_buffers(self.device.command_pool, &[slot.command_buffer]);
            }
        }
    }
}
