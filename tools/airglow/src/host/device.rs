//! The host's device: opened here, then handed to the library by the road that any engine takes.

#[cfg(feature = "view")]
use std::ffi::CStr;

use airglow_gpu::ash::vk;
use airglow_gpu::open::{FrameLoop, FrameSemaphores, OpenDevice, OpenOptions, Selector};
#[cfg(feature = "view")]
use airglow_gpu::surface::{DEVICE_EXTENSIONS, Surface};
use airglow_gpu::{Context, Execution, GpuError, Imports, Recorded, Recorder, Requirements, Timing};
#[cfg(feature = "view")]
use winit::raw_window_handle::{RawDisplayHandle, RawWindowHandle};

use super::machine::Machine;
use crate::failure::{Failure, Outcome};
use crate::global::Global;

/// How many frames may be on the device at once.
const FRAMES_IN_FLIGHT: u32 = 2;

/// What records one frame of a bench.
type RecordOnce<'r> = dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError> + 'r;

/// An open device and what the library made of it.
pub struct Device<'d> {
    open: &'d OpenDevice,
    context: &'d Context,
}

/// Opens the device that `global` asks for, adopts it, runs `work` on it, and fails on any validation message.
/// Nothing made from the context may leave `work`.
pub fn with<R>(
    global: &Global,
    requirements: &Requirements,
    work: impl FnOnce(&Device<'_>) -> Outcome<R>,
) -> Outcome<R> {
    with_options(global, OpenOptions::new(requirements), work)
}

/// The same with a device that can show on windows, whose display needs these instance extensions.
#[cfg(feature = "view")]
pub fn with_window<R>(
    global: &Global,
    requirements: &Requirements,
    instance_extensions: &[&CStr],
    work: impl FnOnce(&Device<'_>) -> Outcome<R>,
) -> Outcome<R> {
    let device_extensions = DEVICE_EXTENSIONS;
    with_options(
        global,
        OpenOptions { instance_extensions, device_extensions, ..OpenOptions::new(requirements) },
        work,
    )
}

fn with_options<R>(
    global: &Global,
    options: OpenOptions<'_>,
    work: impl FnOnce(&Device<'_>) -> Outcome<R>,
) -> Outcome<R> {
    let selector = global.device.as_deref().map_or(Ok(Selector::Best), str::parse);
    let Ok(selector) = selector;
    let options = OpenOptions { selector, validation: global.validate, ..options };
    let open = OpenDevice::open(&options).map_err(|error| match error {
        GpuError::Vulkan { result: vk::Result::ERROR_EXTENSION_NOT_PRESENT, .. }
            if !options.device_extensions.is_empty() =>
        {
            let mend = "choose another with --device, or draw to a file with airglow render";
            Failure::device(format!("the device cannot show on this display ({error}); {mend}"))
        }
        error => Failure::device(error),
    })?;
    let log = open.messages();
    let result = {
        // SAFETY: `context` and, by the contract of this function, all that `work` makes from it are dropped in this
        // block, before `open`; `work` waits for what it submits (`Device::run`, `Device::frames`), and so does the
        // wait below.
        let context = unsafe { open.adopt(FRAMES_IN_FLIGHT) }.map_err(Failure::device)?;
        let result = work(&Device { open: &open, context: &context });
        open.wait_idle().map_err(Failure::work)?;
        result
    };
    // Destroying the device is heard too.
    drop(open);
    let messages = log.take();
    match messages.first() {
        Some(first) => {
            Err(Failure::check(format!("{} validation messages, the first: {first}", messages.len())))
        }
        None => result,
    }
}

impl Device<'_> {
    /// The library's side of the device.
    pub fn context(&self) -> &Context {
        self.context
    }

    /// Records commands, submits them and waits until they are done.
    pub fn run<R>(
        &self,
        record: impl FnOnce(&mut Recorder<'_>) -> Result<R, GpuError>,
    ) -> Result<R, GpuError> {
        self.open.run(self.context, record)
    }

    /// What submits frames one after another.
    pub fn frame_loop(&self) -> Outcome<FrameLoop<'_>> {
        FrameLoop::new(self.open, self.context).map_err(Failure::work)
    }

    /// Records a plan and submits it as the next frame; waits only for the frame that used its place before.
    pub fn frame(
        &self,
        frames: &mut FrameLoop<'_>,
        semaphores: FrameSemaphores,
        execution: &mut Execution,
        imports: &Imports,
        timing: Option<&mut Timing>,
    ) -> Outcome<Recorded> {
        let recorded = frames.frame(semaphores, |command_buffer| {
            // SAFETY: the loop's command buffer is recording and submitted once, in this frame; imports are in
            // their entry states, since uploads are done and every plan leaves them in its exit states, which
            // are the entry states, and an image of a window was just acquired; all recordings go to one queue in
            // order; passes use what they declared.
            unsafe { execution.record(self.context, command_buffer, imports, timing) }
        });
        recorded.map_err(Failure::work)
    }

    /// A surface on a window, which must be dropped before it.
    ///
    /// # Safety
    /// The handles are a live window's, which outlives the surface; the device was opened by [`with_window`] for its
    /// display.
    #[cfg(feature = "view")]
    pub unsafe fn surface(
        &self,
        display: RawDisplayHandle,
        window: RawWindowHandle,
        extent: [u32; 2],
    ) -> Result<Surface<'_>, GpuError> {
        // SAFETY: the caller vouches for the window; the context is this device's.
        unsafe { Surface::new(self.open, self.context, display, window, extent) }
    }

    /// Records and submits a plan `count` times, calling `before` ahead of each, and waits for all of them. Returns
    /// the CPU milliseconds of each recording.
    pub fn frames(
        &self,
        execution: &mut Execution,
        imports: &Imports,
        timing: Option<&mut Timing>,
        count: usize,
        mut before: impl FnMut(usize) -> Outcome,
    ) -> Outcome<Vec<f64>> {
        let mut timing = timing;
        let mut frames = self.frame_loop()?;
        let mut cpu = Vec::with_capacity(count);
        for frame in 0..count {
            before(frame)?;
            let semaphores = FrameSemaphores::default();
            let recorded = self.frame(&mut frames, semaphores, execution, imports, timing.as_deref_mut());
            cpu.push(1e3 * recorded?.cpu.as_secs_f64());
        }
        frames.finish().map_err(Failure::work)?;
        if let Some(timing) = timing {
            timing.collect().map_err(Failure::work)?;
        }
        Ok(cpu)
    }

    /// The same as a function, for what the rooms offer to tools and tests.
    pub fn bench(&self) -> impl Fn(&mut RecordOnce<'_>) -> Result<(), GpuError> {
        |record| self.run(record)
    }

    /// Whether the device can render to and sample `format`.
    pub fn renders(&self, format: vk::Format) -> bool {
        let needed = vk::FormatFeatureFlags::COLOR_ATTACHMENT | vk::FormatFeatureFlags::SAMPLED_IMAGE;
        // SAFETY: the physical device is this instance's, and both are alive.
        let properties = unsafe {
            self.open.instance().get_physical_device_format_properties(self.open.physical_device(), format)
        };
        properties.optimal_tiling_features.contains(needed)
    }

    /// The device as reports name it.
    pub fn machine(&self) -> Machine {
        Machine::new(self.open.line())
    }
}
