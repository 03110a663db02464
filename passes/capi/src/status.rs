//! How a call went: a status, a message in the caller's memory, and the edge that no panic crosses.

use std::any::Any;
use std::ffi::c_char;
use std::mem::offset_of;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;

use airglow_gpu::GpuError;

/// How a call went.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowStatus {
    /// It did what was asked.
    Ok = 0,
    /// An array or text of the caller was too small: its count or length says what is needed, the beginning is filled.
    Incomplete = 1,
    /// An argument is null, misaligned, out of range, or does not fit the others. Nothing was changed.
    InvalidArgument = 2,
    /// The `struct_size` of a structure is zero, too small, or larger with a tail that is not zero.
    InvalidStruct = 3,
    /// The device lacks something required; the message names it.
    Missing = 4,
    /// No memory, or none left in the budget. Nothing was changed.
    OutOfMemory = 5,
    /// The device is lost: nothing more can be recorded; dropping everything stays safe.
    DeviceLost = 6,
    /// Another Vulkan call failed; `vulkan_result` in the error says with what.
    Vulkan = 7,
    /// The caller's own callback asked to stop.
    Cancelled = 8,
    /// A defect of the library: it panicked, and the panic was caught. Drop the objects of the call.
    Internal = 9,
}

/// What went wrong, written by a call into memory of the caller. May be null wherever it is asked for. A call that
/// succeeds sets `status` and clears the message.
#[repr(C)]
pub struct AirglowError {
    /// `sizeof(AirglowError)`.
    pub struct_size: u32,
    /// The status that the call returned.
    pub status: AirglowStatus,
    /// The `VkResult` that a Vulkan call returned, or 0.
    pub vulkan_result: i32,
    /// Bytes of the whole message without its nul; more than fits when it was cut.
    pub message_length: u32,
    /// What is wrong and how to mend it: UTF-8, ends in a nul, cut at the end of a character.
    pub message: [c_char; AIRGLOW_MESSAGE_SIZE],
}

/// Bytes of the message of an error, the nul included.
pub const AIRGLOW_MESSAGE_SIZE: usize = 1008;

/// Why a call failed, on this side of the edge.
#[derive(Debug)]
pub(crate) struct Failure {
    pub status: AirglowStatus,
    pub vulkan_result: i32,
    pub message: String,
}

impl Failure {
    pub(crate) fn new(status: AirglowStatus, message: impl Into<String>) -> Self {
        Self { status, vulkan_result: 0, message: message.into() }
    }

    /// `name` has a value that the call cannot take; `problem` says why and what to give.
    pub(crate) fn argument(name: &str, problem: &str) -> Self {
        Self::new(AirglowStatus::InvalidArgument, format!("{name}: {problem}"))
    }
}

impl From<GpuError> for Failure {
    fn from(error: GpuError) -> Self {
        let (status, vulkan_result) = match &error {
            GpuError::Vulkan { result, .. } if error.is_device_lost() => {
                (AirglowStatus::DeviceLost, result.as_raw())
            }
            GpuError::Vulkan { result, .. } => (AirglowStatus::Vulkan, result.as_raw()),
            GpuError::Missing(_) | GpuError::MissingFunction { .. } => (AirglowStatus::Missing, 0),
            GpuError::Budget { .. } | GpuError::Memory { .. } => (AirglowStatus::OutOfMemory, 0),
            _ => (AirglowStatus::InvalidArgument, 0),
        };
        Self { status, vulkan_result, message: error.to_string() }
    }
}

/// Runs the body of an exported function; a failure or a panic becomes a status and, where there is one, an error.
///
/// # Safety
/// `error` is null, or points at an `AirglowError` whose first `struct_size` bytes may be written by this call alone.
pub(crate) unsafe fn edge(
    error: *mut AirglowError,
    body: impl FnOnce() -> Result<(), Failure>,
) -> AirglowStatus {
    let result = catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|panic| {
        let words = words(panic);
        Err(Failure::new(
            AirglowStatus::Internal,
            format!("a defect of the library, please report it: {words}"),
        ))
    });
    // SAFETY: the caller's promise is ours.
    unsafe {
        match result {
            Ok(()) => {
                write(error, AirglowStatus::Ok, 0, "");
                AirglowStatus::Ok
            }
            Err(Failure { status, vulkan_result, message }) => {
                write(error, status, vulkan_result, &message);
                status
            }
        }
    }
}

/// What a panic said; the panic is let go of without running what may panic again.
pub(crate) fn words(panic: Box<dyn Any + Send>) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    std::mem::forget(panic);
    text.unwrap_or_else(|| "a panic without words".to_owned())
}

/// Fills the caller's error, as much of it as there is; one that is too small for a message is left alone.
///
/// # Safety
/// As [`edge`].
unsafe fn write(error: *mut AirglowError, status: AirglowStatus, vulkan_result: i32, text: &str) {
    if error.is_null() || !error.is_aligned() {
        return;
    }
    // SAFETY: the caller vouches for the memory; fields are written one by one, within `struct_size`.
    unsafe {
        let stated = (&raw const (*error).struct_size).read() as usize;
        let room = stated.min(size_of::<AirglowError>()).saturating_sub(offset_of!(AirglowError, message));
        if room == 0 {
            return;
        }
        (&raw mut (*error).status).write(status);
        (&raw mut (*error).vulkan_result).write(vulkan_result);
        (&raw mut (*error).message_length).write(u32::try_from(text.len()).unwrap_or(u32::MAX));
        let message = (&raw mut (*error).message).cast::<u8>();
        let kept = beginning(text, room - 1);
        ptr::copy_nonoverlapping(kept.as_ptr(), message, kept.len());
        message.add(kept.len()).write(0);
    }
}

/// As much of a text as `room` bytes hold, without half a character.
pub(crate) fn beginning(text: &str, room: usize) -> &str {
    let end = (0..=room.min(text.len())).rev().find(|&end| text.is_char_boundary(end));
    &text[..end.unwrap_or(0)]
}
