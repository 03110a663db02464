//! The device that tests run on: opened under core and synchronisation validation, adopted by the public road.
//!
//! A test that cannot have its device fails. By default the device must be llvmpipe, so that every machine gets the
//! same bits; `AIRGLOW_TEST_DEVICE` (an index, part of a name, or a kind) chooses another on purpose, and
//! `AIRGLOW_TEST_VALIDATION=off` does without the layers there, where they are not installed.

use crate::turn::Turn;
use airglow_conformance::HostDevice;
use airglow_gpu::ash;
use airglow_gpu::open::{MessageLog, OpenDevice, OpenOptions, Selector};
use airglow_gpu::{Context, Requirements};
use std::convert::Infallible;
use std::env;
use std::mem::ManuallyDrop;
use std::ops::Deref;

/// Chooses another device than llvmpipe.
const DEVICE: &str = "AIRGLOW_TEST_DEVICE";
/// `off` runs without validation, together with [`DEVICE`] only.
const VALIDATION: &str = "AIRGLOW_TEST_VALIDATION";

/// An open device and a context adopted from it, with two frames in flight.
///
/// Buffers, images and whatever else was made from the context are dropped before it: declare the fixture first.
/// Dropping it fails the test if validation said anything.
pub struct Fixture {
    context: ManuallyDrop<Context>,
    device: ManuallyDrop<Opened>,
    messages: MessageLog,
}

/// An open device, while which no other thread of the process has one.
pub struct Opened {
    device: OpenDevice,
    // Given back when the device is destroyed.
    _turn: Turn,
}

/// A fixture for what the device layer alone needs.
pub fn fixture() -> Fixture {
    fixture_with(&Requirements::engine())
}

/// A fixture for rooms with `requirements`.
pub fn fixture_with(requirements: &Requirements) -> Fixture {
    let device = open(requirements);
    let messages = device.messages();
    // SAFETY: `Fixture::drop` waits, then drops the context, then the device; what tests make is dropped before.
    let context = unsafe { device.adopt(2) }.unwrap_or_else(|error| panic!("adopting failed: {error}"));
    Fixture { context: ManuallyDrop::new(context), device: ManuallyDrop::new(device), messages }
}

/// The device alone, for tests that play a host; waits until no other thread has one.
pub fn open(requirements: &Requirements) -> Opened {
    let turn = Turn::take();
    let chosen = env::var(DEVICE).ok();
    let Ok::<_, Infallible>(selector) = chosen.as_deref().unwrap_or("llvmpipe").parse::<Selector>();
    let validation = chosen.is_none() || env::var(VALIDATION).as_deref() != Ok("off");
    let options = OpenOptions { selector, validation, ..OpenOptions::new(requirements) };
    let device = OpenDevice::open(&options).unwrap_or_else(|error| panic!("the test device failed: {error}"));
    let line = device.line();
    if chosen.is_none() {
        assert!(
            line.driver.contains("llvmpipe"),
            "expected llvmpipe, opened {line}; set {DEVICE} to mean it"
        );
    } else {
        println!("{DEVICE}: {line}, validation {}", if validation { "on" } else { "off" });
    }
    Opened { device, _turn: turn }
}

/// A device on the instance of `open`, its own or another, as a host states it.
pub fn stated(open: &OpenDevice, device: &ash::Device) -> HostDevice<'static> {
    let mut extensions = Vec::new();
    let info = open.adopt_info(&mut extensions, 1);
    HostDevice {
        get_instance_proc_addr: info.get_instance_proc_addr,
        get_device_proc_addr: open.instance().fp_v1_0().get_device_proc_addr,
        instance: info.instance,
        api_version: info.api_version,
        physical_device: info.physical_device,
        device: device.handle(),
        queue_family: info.queue_family,
        // SAFETY: a live device with a queue of that family.
        queue: unsafe { device.get_device_queue(info.queue_family, 0) },
        features: info.features,
        extensions: &["VK_EXT_debug_utils"],
    }
}

impl Deref for Opened {
    type Target = OpenDevice;

    fn deref(&self) -> &OpenDevice {
        &self.device
    }
}

impl Fixture {
    /// The context.
    pub fn context(&self) -> &Context {
        &self.context
    }

    /// The device.
    pub fn device(&self) -> &OpenDevice {
        &self.device
    }

    /// What validation said; taking messages keeps them from failing the test.
    pub fn messages(&self) -> &MessageLog {
        &self.messages
    }
}

impl Drop for Fixture {
    fn drop(&mut self) {
        // A lost device has finished too; the test has failed by then.
        let _ = self.device.wait_idle();
        // SAFETY: each is dropped once, here, the context first.
        unsafe {
            ManuallyDrop::drop(&mut self.context);
            ManuallyDrop::drop(&mut self.device);
        }
        let messages: Vec<_> = self.messages.take().iter().map(ToString::to_string).collect();
        if std::thread::panicking() {
            messages.iter().for_each(|message| eprintln!("validation: {message}"));
        } else {
            assert!(messages.is_empty(), "validation said:\n{}", messages.join("\n"));
        }
    }
}
