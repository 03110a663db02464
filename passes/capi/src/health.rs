//! Counters of passes for hosts in C and C++: what went wrong in a frame, readable frames later without a stall.
#![allow(dead_code, reason = "helpers of passes, of which there may be none")]

use std::any::Any;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use airglow_gpu::ash::{vk, vk::Handle};
use airglow_gpu::{BufferSlice, Context, GpuError, Health, Look, Recorder, Tally};
use airglow_graph::Access;

use crate::binding::{AirglowBinding, Bound};
use crate::input::{array, shared, store, take};
use crate::prepared::AirglowPrepared;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};

/// Most counters of a pass.
const MOST: usize = 8;

/// Counters of one pass, for whichever of its frames; a host that makes none pays nothing. Any thread may use it.
pub struct AirglowHealth {
    context: Arc<Context>,
    pass: &'static str,
    counters: Mutex<Box<dyn Counters>>,
}

/// Counts of a frame, in the order in which the function says that made the counters.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowHealthCounts {
    /// The context's frame that was counted.
    pub frame: u64,
    /// 1: a frame was counted, and the device is done with it. 0: the other fields say nothing.
    pub counted: u32,
    /// How many counters there are.
    pub count: u32,
    /// The counts; 0 past the last.
    pub counts: [u32; 8],
}

/// A pass's counters, and what adds to them.
pub(crate) trait Counters: Any + Send {
    fn health(&mut self) -> &mut Health;
    fn any(&mut self) -> &mut dyn Any;
}

/// Counters of buffers that are looked at after the pass.
pub(crate) struct Tallied {
    health: Health,
    pub tally: Tally,
}

impl Counters for Tallied {
    fn health(&mut self) -> &mut Health {
        &mut self.health
    }

    fn any(&mut self) -> &mut dyn Any {
        self
    }
}

impl AirglowHealth {
    /// Counters that a pass fills in its own way.
    pub(crate) fn new(context: &Arc<Context>, pass: &'static str, counters: impl Counters) -> Self {
        Self { context: Arc::clone(context), pass, counters: Mutex::new(Box::new(counters)) }
    }

    /// Counters of these names, filled by looks at buffers.
    pub(crate) fn tallied(
        context: &Arc<Context>,
        pass: &'static str,
        names: &[&str],
    ) -> Result<Self, Failure> {
        let health = Health::new(context, names)?;
        let tally = Tally::new(context, &health)?;
        Ok(Self::new(context, pass, Tallied { health, tally }))
    }

    fn counters(&self) -> MutexGuard<'_, Box<dyn Counters>> {
        // A poisoned lock means a panic that was reported as a defect; the data is whole.
        self.counters.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What adds to the counters of a pass's buffers.
    pub(crate) fn tally(&self, pass: &str) -> Result<Tally, Failure> {
        let mut counters = self.counters();
        match counters.any().downcast_ref::<Tallied>().filter(|_| self.pass == pass) {
            Some(tallied) => Ok(tallied.tally.clone()),
            None => Err(self.other(pass)),
        }
    }

    fn other(&self, pass: &str) -> Failure {
        Failure::argument("health", &format!("it counts {}: give counters of {pass}", self.pass))
    }
}

/// Has `counters` count what a pass wrote, as `looks` says.
pub(crate) fn look(
    recorder: &mut Recorder<'_>,
    counters: &mut dyn Any,
    looks: &[Look<BufferSlice>],
) -> Result<(), Failure> {
    let Some(tallied) = counters.downcast_ref::<Tallied>() else { return Ok(()) };
    recorder.memory_barrier(Access::ComputeStorageWrite, Access::ComputeStorageRead)?;
    let counts = Access::ComputeStorageReadWrite;
    recorder.memory_barrier(counts, counts)?;
    Ok(tallied.tally.record(recorder, looks)?)
}

/// # Safety
/// `health` is null or valid; `command_buffer` as `airglow_prepared_record` says.
unsafe fn record(
    health: *const AirglowHealth,
    command_buffer: u64,
    commands: impl FnOnce(&mut Health, &mut Recorder<'_>) -> Result<(), GpuError>,
) -> Result<(), Failure> {
    // SAFETY: the caller's promise is ours.
    let health = unsafe { shared(health, "health")? };
    if command_buffer == 0 {
        return Err(Failure::argument("command_buffer", "it is null"));
    }
    // SAFETY: the caller's promise is ours.
    let mut recorder = unsafe { Recorder::new(&health.context, vk::CommandBuffer::from_raw(command_buffer)) };
    Ok(commands(health.counters().health(), &mut recorder)?)
}

/// Sets the counts to 0, before what is counted of a frame.
///
/// # Safety
/// As `airglow_prepared_record`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_health_clear(
    health: *const AirglowHealth,
    command_buffer: u64,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for pointers and handles.
    unsafe { edge(error, || record(health, command_buffer, Health::clear)) }
}

/// Copies the counts for `airglow_health_latest`, after what is counted of a frame, once in it.
///
/// # Safety
/// As `airglow_prepared_record`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_health_collect(
    health: *const AirglowHealth,
    command_buffer: u64,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for pointers and handles.
    unsafe { edge(error, || record(health, command_buffer, Health::collect)) }
}

/// Says the counts of the newest frame that is done, without waiting: one that was collected `frames_in_flight` frames ago
/// or earlier.
///
/// # Safety
/// `counts` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_health_latest(
    health: *const AirglowHealth,
    counts: *mut AirglowHealthCounts,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            store(counts, "counts", || {
                let health = shared(health, "health")?;
                let latest = health.counters().health().latest(&health.context)?;
                let mut row = AirglowHealthCounts { frame: 0, counted: 0, count: 0, counts: [0; MOST] };
                if let Some(latest) = latest {
                    (row.frame, row.counted) = (latest.frame, 1);
                    row.count = latest.counts.len().min(MOST) as u32;
                    let found = latest.counts.iter().map(|(_, count)| *count);
                    row.counts.iter_mut().zip(found).for_each(|(to, count)| *to = count);
                }
                Ok(row)
            })
        })
    }
}

/// Drops counters. Null is nothing.
///
/// # Safety
/// The pointer is not used again, and the device has finished what was recorded with it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_health_drop(health: *mut AirglowHealth) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(std::ptr::null_mut(), || take(health)) };
}

/// Counts what is wrong with what a frame read and wrote, after `airglow_prepared_record` in the same command buffer with
/// the same bindings, before the host uses them. A map of normals counts while it is built (`airglow_normal_map_count`).
///
/// # Safety
/// As `airglow_prepared_record`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_prepared_count(
    prepared: *const AirglowPrepared,
    health: *const AirglowHealth,
    command_buffer: u64,
    bindings: *const AirglowBinding,
    binding_count: usize,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for pointers, handles and states.
    unsafe {
        edge(error, || {
            let (prepared, health) = (shared(prepared, "prepared")?, shared(health, "health")?);
            if command_buffer == 0 {
                return Err(Failure::argument("command_buffer", "it is null"));
            }
            if health.pass != prepared.pass() {
                return Err(health.other(prepared.pass()));
            }
            let given = array(bindings, binding_count, "bindings")?;
            let mut recorder = Recorder::new(prepared.context(), vk::CommandBuffer::from_raw(command_buffer));
            let import = || -> Result<Bound<'_>, Failure> { prepared.bound(given) };
            prepared.frame().count(&mut recorder, health.counters().any(), given, &import)
        })
    }
}
