//! What a context and everything made by it hold in common.

use crate::allocator::{Allocation, Allocator, Location, Request};
use crate::error::GpuError;
use crate::feature::FeatureSet;
use crate::functions::{Functions, with_c_string};
use crate::ledger::Ledger;
use crate::retire::Retired;
use ash::vk;
use ash::vk::Handle;
use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The device's side of a context: functions, limits, memory and the list of what waits to be destroyed.
pub(crate) struct Shared {
    pub functions: Functions,
    pub facts: DeviceFacts,
    memory: Mutex<Memory>,
    ledger: Mutex<Ledger>,
    retired: Mutex<VecDeque<(u64, Retired)>>,
    frame: AtomicU64,
    /// Made so far, those destroyed since included.
    pub pipelines_made: AtomicU64,
}

/// Where memory comes from, and how much of it is held.
struct Memory {
    allocator: Box<dyn Allocator>,
    /// Bytes of live allocations.
    held: u64,
    /// Most bytes that may be held.
    budget: Option<u64>,
}

impl Memory {
    /// Refuses `size` bytes for `what` when they would exceed the budget.
    fn check_budget(&self, what: &str, size: u64) -> Result<(), GpuError> {
        match self.budget {
            Some(budget) if self.held.saturating_add(size) > budget => {
                Err(GpuError::Budget { what: what.to_owned(), size, held: self.held, budget })
            }
            _ => Ok(()),
        }
    }

    fn free(&mut self, allocation: Allocation) {
        self.held -= allocation.size;
        self.allocator.free(allocation);
    }
}

/// What does not change about a device while it lives.
pub(crate) struct DeviceFacts {
    pub physical_device: vk::PhysicalDevice,
    pub queue_family: u32,
    pub limits: vk::PhysicalDeviceLimits,
    pub features: FeatureSet,
    pub frames_in_flight: u64,
    /// The smaller of maxMemoryAllocationSize and maxBufferSize, in bytes.
    pub max_allocation: u64,
    pub pipeline_cache: vk::PipelineCache,
    pub timestamp_valid_bits: u32,
}

/// A poisoned lock means a panic elsewhere while the data was whole: go on with it.
pub(crate) fn lock<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Shared {
    pub(crate) fn new(
        facts: DeviceFacts,
        functions: Functions,
        allocator: Box<dyn Allocator>,
        budget: Option<u64>,
    ) -> Self {
        Self {
            functions,
            facts,
            memory: Mutex::new(Memory { allocator, held: 0, budget }),
            ledger: Mutex::default(),
            retired: Mutex::default(),
            frame: AtomicU64::new(0),
            pipelines_made: AtomicU64::new(0),
        }
    }

    pub(crate) fn device(&self) -> &ash::Device {
        &self.functions.device
    }

    pub(crate) fn frame(&self) -> u64 {
        self.frame.load(Ordering::Acquire)
    }

    pub(crate) fn ledger(&self) -> MutexGuard<'_, Ledger> {
        lock(&self.ledger)
    }

    /// Starts frame `frame` and destroys what only frames up to `frame - frames_in_flight` could use.
    ///
    /// # Safety
    /// The device has finished all work of those frames.
    pub(crate) unsafe fn begin_frame(&self, frame: u64) {
        self.frame.store(frame, Ordering::Release);
        let mut retired = lock(&self.retired);
        while retired.front().is_some_and(|(dropped, _)| *dropped + self.facts.frames_in_flight <= frame) {
            if let Some((_, object)) = retired.pop_front() {
                // SAFETY: the caller vouches that the device is done with the frames that could use it.
                unsafe { self.destroy(object) };
            }
        }
    }

    /// Hands over an object that is no longer referred to.
    pub(crate) fn retire(&self, object: Retired) {
        lock(&self.retired).push_back((self.frame(), object));
    }

    /// # Safety
    /// The device is done with the object.
    unsafe fn destroy(&self, object: Retired) {
        // SAFETY: the caller's promise is ours.
        let Some((memory, entry)) = (unsafe { object.destroy(self.device()) }) else { return };
        let bytes = memory.as_ref().map_or(0, |memory| memory.size);
        memory.into_iter().for_each(|memory| self.free(memory));
        self.ledger().remove(entry, bytes);
    }

    /// Memory for a resource called `name`.
    pub(crate) fn allocate(
        &self,
        name: &str,
        requirements: vk::MemoryRequirements,
        location: Location,
        linear: bool,
    ) -> Result<Allocation, GpuError> {
        if requirements.size > self.facts.max_allocation {
            return Err(GpuError::TooLarge {
                what: name.to_owned(),
                size: requirements.size,
                limit: "maxMemoryAllocationSize",
                allowed: self.facts.max_allocation,
            });
        }
        let mut memory = lock(&self.memory);
        memory.check_budget(name, requirements.size)?;
        let allocation = memory
            .allocator
            .allocate(&Request { name, requirements, location, linear })
            .map_err(|reason| GpuError::Memory { what: name.to_owned(), reason })?;
        memory.held += allocation.size;
        Ok(allocation)
    }

    pub(crate) fn free(&self, allocation: Allocation) {
        lock(&self.memory).free(allocation);
    }

    /// Refuses `size` bytes for `what` together, before any of it is made.
    pub(crate) fn check_budget(&self, what: &str, size: u64) -> Result<(), GpuError> {
        lock(&self.memory).check_budget(what, size)
    }

    /// Bytes of the budget that are left.
    pub(crate) fn memory_left(&self) -> Option<u64> {
        let memory = lock(&self.memory);
        memory.budget.map(|budget| budget.saturating_sub(memory.held))
    }

    /// Gives an object the name that captures and validation messages show, cut to 127 bytes.
    pub(crate) fn name(&self, object: impl Handle, kind: vk::ObjectType, name: &str) {
        let Some(debug) = &self.functions.debug else { return };
        with_c_string(name, |text| {
            let info = vk::DebugUtilsObjectNameInfoEXT {
                object_type: kind,
                object_handle: object.as_raw(),
                p_object_name: text,
                ..Default::default()
            };
            // SAFETY: the object is this device's, the text outlives the call. A failure loses only the name.
            let _ = unsafe { (debug.set_debug_utils_object_name_ext)(self.device().handle(), &info) };
        });
    }
}

impl Drop for Shared {
    fn drop(&mut self) {
        let retired = std::mem::take(&mut *lock(&self.retired));
        for (_, object) in retired {
            // SAFETY: `Context::adopt` has the host promise that the device is idle on our work by now.
            unsafe { self.destroy(object) };
        }
    }
}
