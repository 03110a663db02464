//! A room on a device whose calls fail, one in turn: what was made unwinds, and the host is told.

use super::host::Host;
use super::{HostDevice, Refusal, Road, Room};
use airglow_gpu::ash::vk;
use airglow_gpu::{Context, Execution, GpuError, Options, Requirements};
use std::cell::Cell;

/// Makes a room and records it by both roads, once for each call of its that may fail, which then runs out of device
/// memory; what makes the room is the same for both, and fails on the first. Nothing is submitted. The room must say so, and
/// leave nothing alive. Returns how many calls failed.
///
/// # Safety
/// As [`conform_on`](crate::conform_on).
///
/// # Errors
/// The call that went unnoticed, that was told as something else, or that left objects alive.
pub unsafe fn fail_on<R: Room>(
    host: &HostDevice<'_>,
    requirements: &Requirements,
    make: impl Fn(&Context, &HostDevice<'_>) -> Result<R, Refusal>,
) -> Result<u64, Refusal> {
    let requirements = Requirements::engine().and(requirements);
    // SAFETY: the caller's promise is ours.
    let host = unsafe { Host::new(host)? };
    let (by_graph, made) = host.fail_each(&requirements, &make, Road::Graph, 0)?;
    let (by_record, _) = host.fail_each(&requirements, &make, Road::Record, made)?;
    Ok(by_graph + by_record)
}

impl Host<'_> {
    /// Fails calls from `first` on; returns how many, and which was the first after the room was made.
    fn fail_each<R: Room>(
        &self,
        requirements: &Requirements,
        make: impl Fn(&Context, &HostDevice<'_>) -> Result<R, Refusal>,
        road: Road,
        first: u64,
    ) -> Result<(u64, u64), Refusal> {
        let shim = self.watch();
        shim.keep_pipelines();
        let made = Cell::new(0);
        let counted = |context: &Context, host: &HostDevice<'_>| {
            let room = make(context, host);
            made.set(shim.fallible());
            room
        };
        let attempt = |nth| {
            shim.fail(nth, vk::Result::ERROR_OUT_OF_DEVICE_MEMORY);
            let adopt = || self.adopt(&shim, requirements, &Options::default(), 1);
            let recorded = self.frame_of(&shim, adopt, counted, (road, Execution::prepare_shared), false);
            (recorded, shim.heal(), shim.alive())
        };
        let (whole, calls, _) = attempt(u64::MAX);
        whole?;
        let made = made.get();
        for nth in first..calls {
            let (recorded, _, alive) = attempt(nth);
            let found = match recorded {
                _ if !alive.is_empty() => format!("left alive {alive:?}"),
                Err(told) if is_about_memory(&*told) => continue,
                Err(told) => format!("the room said {told}"),
                // An allocator may find memory of another type.
                Ok(_) if ["vkAllocateMemory", "vkMapMemory"].contains(&shim.failed()) => continue,
                Ok(_) => "nobody said so".to_owned(),
            };
            return Err(format!("{road:?}: call {nth}, {}, failed: {found}", shim.failed()).into());
        }
        Ok((calls.saturating_sub(first), made))
    }
}

/// Whether an error, or one that it came from, is the device's that ran out of memory.
fn is_about_memory(error: &(dyn std::error::Error + 'static)) -> bool {
    let told = match error.downcast_ref() {
        Some(GpuError::Vulkan { result, .. }) => *result == vk::Result::ERROR_OUT_OF_DEVICE_MEMORY,
        Some(GpuError::Memory { .. }) => true,
        _ => false,
    };
    told || error.source().is_some_and(is_about_memory)
}
