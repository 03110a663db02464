//! The conformance kit for hosts in C and C++: the library's passes inside the host's own device, checked there.
#![allow(dead_code, unused_imports, unused_macros, reason = "helpers of passes, of which there may be none")]

use std::ffi::{CString, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};

use airglow_conformance::HostDevice;
use airglow_gpu::ash::{vk, vk::Handle};

use crate::checks::Checks;
use crate::context::{AirglowAdoptInfo, enabled};
use crate::input::{Versioned, exclusive, store, versioned};
use crate::physical::get_instance_proc_addr;
use crate::requirements::AirglowRequirements;
use crate::status::{AirglowError, AirglowStatus, Failure, edge, words};

/// Those of every pass.
const ROOMS: &[Checks] = &[
    #[cfg(feature = "fog")]
    crate::fog::conformance::CHECKS,
    #[cfg(feature = "normals")]
    crate::normals::conformance::CHECKS,
    #[cfg(feature = "radiance")]
    crate::radiance::conformance::CHECKS,
    #[cfg(feature = "relight")]
    crate::relight::conformance::CHECKS,
    #[cfg(feature = "shadow")]
    crate::shadow::conformance::CHECKS,
];

/// What came of a check; `failure` is null where it passed, and else says what is wrong. Both texts are UTF-8 and live
/// during the call.
pub type AirglowConformanceReport =
    Option<unsafe extern "C" fn(user: *mut c_void, check: *const c_char, failure: *const c_char)>;

/// A host's device for the conformance kit.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowConformanceInfo {
    /// `sizeof(AirglowConformanceInfo)`.
    pub struct_size: u32,
    /// Not used; 0.
    pub reserved: u32,
    /// The device, as the host hands it to `airglow_context_adopt`. Of it the kit leaves alone: requirements, frames in
    /// flight, allocator, pipeline cache, budget, breadcrumbs and `missing`.
    pub device: *const AirglowAdoptInfo,
    /// A `VkQueue` of `queue_family`, which does graphics and compute: the kit submits to it and waits for it.
    pub queue: u64,
    /// Called for each check; or null.
    pub report: AirglowConformanceReport,
    /// Handed to `report`.
    pub user: *mut c_void,
}

// SAFETY: `#[repr(C)]`, its size first, integers, pointers and an optional function; fields of 8 bytes are at multiples
// of 8.
unsafe impl Versioned for AirglowConformanceInfo {
    const OLDEST: usize = size_of::<Self>();
}

/// Adds what the conformance kit asks of a device.
///
/// # Safety
/// Nothing beyond the pointers being valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_conformance_require(
    requirements: *mut AirglowRequirements,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let requirements = exclusive(requirements, "requirements")?;
            for room in ROOMS {
                let asked = (room.requirements)();
                let asked = asked.map_err(|problem| {
                    Failure::new(AirglowStatus::Internal, format!("a defect of the library: {problem}"))
                })?;
                requirements.add(&asked);
            }
            Ok(())
        })
    }
}

/// Runs the conformance kit on the host's device: passes made by the functions of this header and by Rust, between
/// commands of the kit's own, by accesses and record and by the library's graph; the bits, the layouts and the state of
/// the command buffer are compared, and nothing may stay alive. `*failures` gets the number of checks that failed. What
/// validation layers say goes to the host's messenger. A check that failed may leave objects of the device behind.
///
/// # Safety
/// As `airglow_context_adopt`; no one else uses the queue meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_conformance_run(
    info: *const AirglowConformanceInfo,
    failures: *mut u32,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for pointers, handles and the queue.
    unsafe {
        edge(error, || {
            store(failures, "failures", || {
                let info = versioned(info, "info")?;
                let device = versioned(info.device, "info.device")?;
                let (extensions, features) = enabled(&device)?;
                let host = HostDevice { features, extensions: &extensions, ..stated(&device, info.queue)? };
                Ok(run(&host, &info))
            })
        })
    }
}

/// The number of checks that failed.
fn run(host: &HostDevice<'_>, info: &AirglowConformanceInfo) -> u32 {
    let mut failures = 0;
    for (name, check) in ROOMS.iter().flat_map(|room| room.checks) {
        let failure = match catch_unwind(AssertUnwindSafe(|| check(host))) {
            Ok(checked) => checked.err().map(|problem| problem.to_string()),
            Err(panic) => Some(format!("a defect of the library: {}", words(panic))),
        };
        failures += u32::from(failure.is_some());
        let text = failure.map(|problem| CString::new(problem.replace('\0', " ")).unwrap_or_default());
        let failure = text.as_ref().map_or(std::ptr::null(), |text| text.as_ptr());
        if let Some(report) = info.report {
            // SAFETY: the host's function with the host's pointer; both texts outlive the call.
            unsafe { report(info.user, name.as_ptr(), failure) };
        }
    }
    failures
}

/// A device as its host states it, without what is enabled on it.
///
/// # Safety
/// As `airglow_context_adopt`.
unsafe fn stated(info: &AirglowAdoptInfo, queue: u64) -> Result<HostDevice<'static>, Failure> {
    for (name, handle) in [("instance", info.instance), ("device", info.device), ("queue", queue)] {
        if handle == 0 {
            return Err(Failure::argument(name, "it is null"));
        }
    }
    let instance = vk::Instance::from_raw(info.instance);
    // SAFETY: the caller vouches for the functions.
    unsafe {
        let get_instance = get_instance_proc_addr(info.get_instance_proc_addr)?;
        let given = info.get_device_proc_addr;
        let get_device = given.or_else(|| get_instance(instance, c"vkGetDeviceProcAddr".as_ptr()));
        let problem = "it is null, and the instance has none";
        let get_device = get_device.ok_or_else(|| Failure::argument("get_device_proc_addr", problem))?;
        Ok(HostDevice {
            get_instance_proc_addr: get_instance,
            get_device_proc_addr: std::mem::transmute::<
                unsafe extern "system" fn(),
                vk::PFN_vkGetDeviceProcAddr,
            >(get_device),
            instance,
            api_version: info.api_version,
            physical_device: vk::PhysicalDevice::from_raw(info.physical_device),
            device: vk::Device::from_raw(info.device),
            queue_family: info.queue_family,
            queue: vk::Queue::from_raw(queue),
            features: Default::default(),
            extensions: &[],
        })
    }
}
