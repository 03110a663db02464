//! A room on a device whose memory the CPU cannot map: everything goes there by a copy.

use super::host::Host;
use super::{HostDevice, Outputs, Refusal, Road, Room};
use airglow_gpu::ash::vk;
use airglow_gpu::{Context, Options, Requirements};

/// Runs a room by both roads on the host's device, whose memory is told as two types: one that the device alone reaches, one
/// that the CPU maps. Returns the [`Outputs`], which are to be those that the room has anywhere.
///
/// # Safety
/// As [`conform_on`](crate::conform_on).
///
/// # Errors
/// What the room or the device refuses, roads that differ; a device without a type of memory that can stand for both; a room
/// that has no use for one of them.
pub unsafe fn stage_on<R: Room>(
    host: &HostDevice<'_>,
    requirements: &Requirements,
    make: impl Fn(&Context, &HostDevice<'_>) -> Result<R, Refusal>,
) -> Result<Outputs, Refusal> {
    let requirements = Requirements::engine().and(requirements);
    // SAFETY: the caller's promise is ours.
    let (memory, host) = unsafe { (memory(host)?, Host::new(host)?) };
    let run = |road| -> Result<Outputs, Refusal> {
        let shim = host.watch();
        if !shim.separate_memory(&memory) {
            return Err("the device has no memory that both it and the CPU reach".into());
        }
        let (outputs, _) = host.run_under(&shim, &make, &requirements, &Options::default(), road)?;
        match shim.separate_allocations() {
            [0, _] => Err(format!("{road:?}: nothing is in the device's own memory").into()),
            [_, 0] => Err(format!("{road:?}: nothing was copied from the CPU's memory").into()),
            _ => Ok(outputs),
        }
    };
    match (run(Road::Graph)?, run(Road::Record)?) {
        (by_graph, by_record) if by_graph == by_record => Ok(by_graph),
        _ => Err("the roads differ where memory cannot be mapped".into()),
    }
}

/// The memory that the device truly has.
///
/// # Safety
/// As [`Host::new`].
unsafe fn memory(host: &HostDevice<'_>) -> Result<vk::PhysicalDeviceMemoryProperties, Refusal> {
    let name = c"vkGetPhysicalDeviceMemoryProperties";
    // SAFETY: the caller vouches for function and handles; the function has the signature of its name.
    unsafe {
        let found = (host.get_instance_proc_addr)(host.instance, name.as_ptr());
        let found = found.ok_or("the loader has no vkGetPhysicalDeviceMemoryProperties")?;
        let found = std::mem::transmute::<
            unsafe extern "system" fn(),
            vk::PFN_vkGetPhysicalDeviceMemoryProperties,
        >(found);
        let mut memory = vk::PhysicalDeviceMemoryProperties::default();
        found(host.physical_device, &raw mut memory);
        Ok(memory)
    }
}
