//! The library's side of a host's device: what `adopt` makes of raw handles.

use crate::adopt::AdoptInfo;
use crate::allocator::BlockAllocator;
use crate::breadcrumbs::{Breadcrumbs, PassReached};
use crate::error::GpuError;
use crate::feature::FeatureSet;
use crate::frame::FrameSlot;
use crate::functions;
use crate::ledger::OwnerBytes;
use crate::offer::Offer;
use crate::requirements::Requirements;
use crate::shared::{DeviceFacts, Shared, lock};
use ash::vk;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, MutexGuard};

/// A host's device, seen from the library. Many can live in one process; there are no statics.
///
/// It never submits, never waits, and makes no queue, thread or pool of command buffers.
pub struct Context {
    /// Dropped before `shared`: the slots' buffers retire into it.
    slots: Vec<Mutex<FrameSlot>>,
    pub(crate) breadcrumbs: Option<Breadcrumbs>,
    pub(crate) shared: Arc<Shared>,
}

impl Context {
    /// Adopts a host's device.
    ///
    /// # Errors
    /// [`GpuError::MissingFunction`] with the name of the first function that get-proc-addr does not know,
    /// [`GpuError::Missing`] with the list of everything else that is lacking, [`GpuError::Misuse`] for
    /// `frames_in_flight` of 0, [`GpuError::Memory`] or [`GpuError::Budget`] without memory for breadcrumbs.
    ///
    /// # Safety
    /// - The handles are alive, belong together, and `info` states truly what was enabled on them.
    /// - Instance and device outlive the context and everything made from it (buffers, images, pipelines,
    ///   executions, timings), and the pipeline cache is not used by another thread while pipelines are made.
    /// - Before the last of those is dropped, the device has finished all work that was recorded through it.
    pub unsafe fn adopt(info: AdoptInfo<'_>) -> Result<Self, GpuError> {
        if info.frames_in_flight == 0 {
            return Err(GpuError::misuse("frames_in_flight", "0; at least one frame is being recorded"));
        }
        // SAFETY: the caller vouches for handles and functions.
        let functions = unsafe { functions::load(&info)? };
        // SAFETY: as above; only the functions probed are called.
        let facts = unsafe { check(&functions, &info)? };
        let allocator = match info.allocator {
            Some(allocator) => allocator,
            None => Box::new(
                BlockAllocator::new(&functions.instance, &functions.device, info.physical_device)
                    .map_err(|reason| GpuError::Memory { what: "the allocator".to_owned(), reason })?,
            ),
        };
        let shared = Arc::new(Shared::new(facts, functions, allocator, info.options.memory_budget));
        let slots: Vec<_> = (0..info.frames_in_flight).map(|_| Mutex::new(FrameSlot::new(&shared))).collect();
        let breadcrumbs = match info.options.breadcrumbs {
            true => Some(Breadcrumbs::new(&shared, slots.len())?),
            false => None,
        };
        Ok(Self { slots, breadcrumbs, shared })
    }

    /// Starts frame `frame`: memory and descriptors of the frame that used the same slot are used again, and what was
    /// dropped that long ago is destroyed. Frame 0 has begun when the context is made.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if `frame` is not greater than the last.
    ///
    /// # Safety
    /// The device has finished everything recorded in frames up to `frame - frames_in_flight`, and those command
    /// buffers will not be submitted again. A command buffer is submitted in the frame it was recorded in, and no
    /// recorder of an earlier frame is used again.
    pub unsafe fn begin_frame(&self, frame: u64) -> Result<(), GpuError> {
        let last = self.shared.frame();
        if frame <= last {
            return Err(GpuError::misuse(
                format!("frame {frame}"),
                format!("frames count up, and {last} has begun"),
            ));
        }
        // SAFETY: the caller vouches that the device is done with the frames in question.
        unsafe {
            self.shared.begin_frame(frame);
            self.slot().reset()?;
        }
        self.breadcrumbs.as_ref().map_or(Ok(()), |breadcrumbs| breadcrumbs.begin_frame(frame))
    }

    /// The frame being recorded.
    pub fn frame(&self) -> u64 {
        self.shared.frame()
    }

    /// How many frames may be in flight.
    pub fn frames_in_flight(&self) -> u32 {
        self.slots.len() as u32
    }

    /// The device's limits.
    pub fn limits(&self) -> &vk::PhysicalDeviceLimits {
        &self.shared.facts.limits
    }

    /// The limits to compile a graph for this device with.
    pub fn graph_limits(&self) -> airglow_graph::Limits {
        let limits = self.limits();
        airglow_graph::Limits {
            queue_family: self.shared.facts.queue_family,
            max_buffer_size: self.shared.facts.max_allocation,
            max_image_dimension_2d: limits.max_image_dimension2_d,
            max_image_dimension_3d: limits.max_image_dimension3_d,
            max_image_array_layers: limits.max_image_array_layers,
        }
    }

    /// The features the host enabled.
    pub fn features(&self) -> FeatureSet {
        self.shared.facts.features
    }

    /// How many pipelines were made so far, on all threads: a frame that makes one stutters.
    pub fn pipelines_made(&self) -> u64 {
        self.shared.pipelines_made.load(Ordering::Relaxed)
    }

    /// Bytes of the memory budget that are left; `None` when there is no budget.
    pub fn memory_left(&self) -> Option<u64> {
        self.shared.memory_left()
    }

    /// Bytes and objects by owner, sorted by name; what waits to be destroyed still counts.
    pub fn memory_report(&self) -> Vec<OwnerBytes> {
        self.shared.ledger().report()
    }

    /// The last step the device reached, by the breadcrumbs it wrote: for after a loss. `None` without
    /// [`Options::breadcrumbs`](crate::Options::breadcrumbs), or when no step of the frames in flight was begun.
    ///
    /// # Errors
    /// None in practice: the breadcrumbs are mapped.
    pub fn last_pass_reached(&self) -> Result<Option<PassReached>, GpuError> {
        self.breadcrumbs.as_ref().map_or(Ok(None), Breadcrumbs::last)
    }

    /// ash's device, for a host that uses it too.
    pub fn device(&self) -> &ash::Device {
        self.shared.device()
    }

    /// The slot of the frame being recorded.
    pub(crate) fn slot(&self) -> MutexGuard<'_, FrameSlot> {
        lock(&self.slots[(self.frame() % self.slots.len() as u64) as usize])
    }
}

/// Compares what the host states, and what the device says of itself, with what is required.
///
/// # Safety
/// As [`Context::adopt`].
unsafe fn check(functions: &functions::Functions, info: &AdoptInfo<'_>) -> Result<DeviceFacts, GpuError> {
    let requirements = Requirements::engine().and(info.requirements);
    let instance = &functions.instance;
    // SAFETY: the caller vouches for the handles.
    let mut offer = unsafe { Offer::read(instance, info.physical_device, info.queue_family, &requirements) };
    offer.api_version = offer.api_version.min(info.api_version);
    offer.features = info.features;
    offer.extensions = info.extensions.iter().map(|&name| name.to_owned()).collect();
    let missing = requirements.check(&offer);
    if !missing.is_empty() {
        return Err(GpuError::Missing(missing));
    }
    let mut maintenance3 = vk::PhysicalDeviceMaintenance3Properties::default();
    let mut maintenance4 =
        vk::PhysicalDeviceMaintenance4Properties { max_buffer_size: u64::MAX, ..Default::default() };
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut maintenance3);
    if offer.api_version >= vk::API_VERSION_1_3 {
        properties = properties.push_next(&mut maintenance4);
    }
    // SAFETY: as above; the structures are core in the versions just checked, and the family's index was checked too.
    let queues = unsafe {
        instance.get_physical_device_properties2(info.physical_device, &mut properties);
        instance.get_physical_device_queue_family_properties(info.physical_device)
    };
    let limits = info.options.mask.limits(properties.properties.limits);
    Ok(DeviceFacts {
        physical_device: info.physical_device,
        queue_family: info.queue_family,
        limits,
        features: info.options.mask.features(info.features, &requirements),
        frames_in_flight: u64::from(info.frames_in_flight),
        max_allocation: maintenance3.max_memory_allocation_size.min(maintenance4.max_buffer_size),
        pipeline_cache: info.pipeline_cache,
        timestamp_valid_bits: queues
            .get(info.queue_family as usize)
            .map_or(0, |family| family.timestamp_valid_bits),
    })
}

#[cfg(test)]
mod tests {
    use crate::{Buffer, ComputePipeline, Context, Execution, Image, Timing};

    #[test]
    fn handles_may_move_between_threads() {
        fn send<T: Send>() {}
        fn shared<T: Send + Sync>() {}
        shared::<(Context, Buffer, Image, ComputePipeline)>();
        send::<(Execution, Timing)>();
    }
}
