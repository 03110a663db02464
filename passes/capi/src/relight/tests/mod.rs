//! The functions as a host calls them.

mod conformance;
mod frame;
mod hostile;
mod memory;

use std::ffi::CStr;
use std::mem::zeroed;

use airglow_gpu::ash::vk::Handle;
use airglow_tests::conformance::HostDevice;
use airglow_tests::device::open;

use crate::context::{AirglowAdoptInfo, AirglowContext, airglow_context_adopt};
use crate::physical::AirglowFunction;
use crate::relight::airglow_relight_require;
use crate::relight::settings::AirglowRelightSettings;
use crate::requirements::{AirglowRequirements, airglow_requirements_drop, airglow_requirements_new};
use crate::status::{AirglowError, AirglowStatus};
use crate::text::AirglowText;

/// An error to be filled.
fn error() -> AirglowError {
    // SAFETY: zero bytes are a valid error, of status 0.
    AirglowError { struct_size: size_of::<AirglowError>() as u32, ..unsafe { zeroed() } }
}

/// What an error says.
fn message(error: &AirglowError) -> &str {
    // SAFETY: messages end in a nul.
    unsafe { CStr::from_ptr(error.message.as_ptr()) }.to_str().unwrap()
}

/// Calls a function with an error at its end, and fails the test with the message.
macro_rules! call {
    ($function:path, $($argument:expr),*) => {{
        let mut error = $crate::relight::tests::error();
        // SAFETY: the tests keep the function's promises.
        let status = unsafe { $function($($argument,)* &raw mut error) };
        assert_eq!(status, AirglowStatus::Ok, "{}: {}", stringify!($function), $crate::relight::tests::message(&error));
    }};
}
use call;

/// Calls a function with an error at its end, which must be this status; returns the message.
macro_rules! refused {
    ($status:ident, $function:path, $($argument:expr),*) => {{
        let mut error = $crate::relight::tests::error();
        // SAFETY: what is refused is refused before it is used.
        let status = unsafe { $function($($argument,)* &raw mut error) };
        let said = $crate::relight::tests::message(&error).to_owned();
        assert_eq!((status, error.status), (AirglowStatus::$status, AirglowStatus::$status), "{said}");
        assert!(!said.is_empty(), "{} says nothing", stringify!($function));
        said
    }};
}
use refused;

/// Runs `test` with a host's device.
fn with_host(test: impl FnOnce(&HostDevice)) {
    let asked = airglow_relight::Relight::requirements(&settings(0).read().unwrap());
    let open = open(&asked);
    let mut extensions = Vec::new();
    let info = open.adopt_info(&mut extensions, 1);
    test(&HostDevice {
        get_instance_proc_addr: info.get_instance_proc_addr,
        get_device_proc_addr: info.get_device_proc_addr.unwrap(),
        instance: info.instance,
        api_version: info.api_version,
        physical_device: info.physical_device,
        device: info.device,
        queue_family: info.queue_family,
        features: info.features,
        extensions: &["VK_EXT_debug_utils"],
    });
    let said = open.messages().take();
    assert!(said.is_empty(), "{said:?}");
}

/// What a call writes to a text.
fn text(write: impl Fn(*mut AirglowText)) -> String {
    let mut bytes = vec![0u8; 1 << 16];
    let mut text = AirglowText { data: bytes.as_mut_ptr().cast(), capacity: bytes.len(), length: 0 };
    write(&raw mut text);
    String::from_utf8(bytes[..text.length].to_vec()).unwrap()
}

/// Settings that are all default but for the method.
fn settings(method: u32) -> AirglowRelightSettings {
    let struct_size = size_of::<AirglowRelightSettings>() as u32;
    // SAFETY: zero bytes are valid settings.
    AirglowRelightSettings { struct_size, method, ..unsafe { zeroed() } }
}

/// What the pass asks for.
fn requirements(settings: &AirglowRelightSettings) -> *mut AirglowRequirements {
    let mut requirements = std::ptr::null_mut();
    call!(airglow_requirements_new, &raw mut requirements);
    call!(airglow_relight_require, requirements, settings);
    requirements
}

/// A function of Vulkan as the header has it.
fn function<F: Copy>(function: F) -> AirglowFunction {
    // SAFETY: function pointers of one size, and cast back before they are called.
    unsafe { std::mem::transmute_copy(&function) }
}

/// What a host states of its device; extensions and features are added by [`adopt`].
fn adopt_info(host: &HostDevice) -> AirglowAdoptInfo {
    AirglowAdoptInfo {
        struct_size: size_of::<AirglowAdoptInfo>() as u32,
        api_version: host.api_version,
        get_instance_proc_addr: function(host.get_instance_proc_addr),
        get_device_proc_addr: function(host.get_device_proc_addr),
        instance: host.instance.as_raw(),
        physical_device: host.physical_device.as_raw(),
        device: host.device.as_raw(),
        queue_family: host.queue_family,
        frames_in_flight: 1,
        // SAFETY: zero bytes are a valid description.
        ..unsafe { zeroed() }
    }
}

/// Adopts a host's device for the pass.
fn adopt(host: &HostDevice, settings: &AirglowRelightSettings) -> *mut AirglowContext {
    let names = |texts: &[&str]| -> Vec<_> {
        texts.iter().map(|text| std::ffi::CString::new(*text).unwrap()).collect()
    };
    let extensions = names(host.extensions);
    let features = names(&host.features.iter().map(|feature| feature.name()).collect::<Vec<_>>());
    let extensions: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
    let feature_names: Vec<_> = features.iter().map(|name| name.as_ptr()).collect();
    let requirements = requirements(settings);
    let info = AirglowAdoptInfo {
        requirements,
        extension_names: extensions.as_ptr(),
        extension_count: extensions.len(),
        feature_names: feature_names.as_ptr(),
        feature_count: feature_names.len(),
        ..adopt_info(host)
    };
    let mut context = std::ptr::null_mut();
    call!(airglow_context_adopt, &raw const info, &raw mut context);
    // SAFETY: they are read during the call alone.
    unsafe { airglow_requirements_drop(requirements) };
    context
}
