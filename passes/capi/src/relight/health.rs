//! Counts of bad texels in environments that a host gives as images, readable frames later without a stall.

use airglow_gpu::ash::{vk, vk::Handle};
use airglow_gpu::{GpuError, Health, Recorder};

use super::{AirglowRelight, State};
use crate::input::{shared, store};
use crate::status::{AirglowError, AirglowStatus, Failure, edge};

/// Bad texels of a frame, counted where an environment was projected in it; a component that is not finite counts as black.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowRelightHealth {
    /// The context's frame that was counted.
    pub frame: u64,
    /// 1: a frame was counted, and the device is done with it. 0: the other fields say nothing.
    pub counted: u32,
    /// Texels with a component that is not finite.
    pub not_finite: u32,
    /// Other texels with a negative component.
    pub negative: u32,
    /// Not used.
    pub reserved: u32,
}

impl State {
    fn health(&mut self) -> Result<&mut Health, Failure> {
        let problem = "it counts nothing: set health in its settings, with uniform light";
        self.relight.health().ok_or_else(|| Failure::argument("relight", problem))
    }
}

/// # Safety
/// `relight` is null or valid; `command_buffer` as `airglow_prepared_record` says.
unsafe fn record(
    relight: *const AirglowRelight,
    command_buffer: u64,
    commands: impl FnOnce(&mut Health, &mut Recorder<'_>) -> Result<(), GpuError>,
) -> Result<(), Failure> {
    // SAFETY: the caller's promise is ours.
    let relight = unsafe { shared(relight, "relight")? };
    if command_buffer == 0 {
        return Err(Failure::argument("command_buffer", "it is null"));
    }
    // SAFETY: the caller's promise is ours.
    let mut recorder =
        unsafe { Recorder::new(&relight.context, vk::CommandBuffer::from_raw(command_buffer)) };
    Ok(commands(relight.state().health()?, &mut recorder)?)
}

/// Sets the counts to 0, before the recordings of a frame; for settings with `health`.
///
/// # Safety
/// As `airglow_prepared_record`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_health_clear(
    relight: *const AirglowRelight,
    command_buffer: u64,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for pointers and handles.
    unsafe { edge(error, || record(relight, command_buffer, Health::clear)) }
}

/// Copies the counts for `airglow_relight_health_latest`, after the recordings of a frame, once in it.
///
/// # Safety
/// As `airglow_prepared_record`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_health_collect(
    relight: *const AirglowRelight,
    command_buffer: u64,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for pointers and handles.
    unsafe { edge(error, || record(relight, command_buffer, Health::collect)) }
}

/// Says the counts of the newest frame that is done, without waiting: one that was collected `frames_in_flight` frames ago
/// or earlier.
///
/// # Safety
/// `health` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_health_latest(
    relight: *const AirglowRelight,
    health: *mut AirglowRelightHealth,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            store(health, "health", || {
                let relight = shared(relight, "relight")?;
                let latest = relight.state().health()?.latest(&relight.context)?;
                // In the order in which the pass names them.
                let count = |place: usize| {
                    let counts = latest.as_ref().map(|latest| &latest.counts);
                    counts.and_then(|counts| counts.get(place)).map_or(0, |(_, count)| *count)
                };
                Ok(AirglowRelightHealth {
                    frame: latest.as_ref().map_or(0, |latest| latest.frame),
                    counted: u32::from(latest.is_some()),
                    not_finite: count(0),
                    negative: count(1),
                    reserved: 0,
                })
            })
        })
    }
}
