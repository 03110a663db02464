//! Texts and arrays that the library writes into memory of the caller.

use std::ffi::c_char;
use std::ptr;

use crate::input::{check_pointer, exclusive};
use crate::status::{AirglowStatus, Failure, beginning};

/// A text of the library in memory of the caller. With `data` null and `capacity` 0, a call only says the length.
#[repr(C)]
pub struct AirglowText {
    /// Where the text is written: UTF-8, with a nul at its end.
    pub data: *mut c_char,
    /// Bytes there.
    pub capacity: usize,
    /// Set by the call: bytes of the whole text without its nul.
    pub length: usize,
}

/// Writes `text`, or its beginning and [`AirglowStatus::Incomplete`] where it does not fit.
///
/// # Safety
/// `target` is null or points at an `AirglowText` whose `capacity` bytes at `data` may be written.
pub(crate) unsafe fn write_text(target: *mut AirglowText, text: &str) -> Result<(), Failure> {
    // SAFETY: the caller vouches for the structure and the memory it names.
    unsafe {
        let target = exclusive(target, "text")?;
        target.length = text.len();
        if target.data.is_null() && target.capacity == 0 {
            return Ok(());
        }
        check_pointer(target.data.cast_const(), "text.data")?;
        let Some(room) = target.capacity.checked_sub(1) else { return incomplete("text", text.len() + 1, 0) };
        let kept = beginning(text, room);
        ptr::copy_nonoverlapping(kept.as_ptr(), target.data.cast(), kept.len());
        target.data.add(kept.len()).write(0);
        if kept.len() < text.len() { incomplete("text", text.len() + 1, target.capacity) } else { Ok(()) }
    }
}

/// Writes `items` to an array of the caller, `count` holding its size before and the number of items after. With a
/// null array only the number is written.
///
/// # Safety
/// `count` is null or may be read and written; `array` is null or has room for `count` items.
pub(crate) unsafe fn write_array<T: Copy>(
    array: *mut T,
    count: *mut usize,
    items: &[T],
) -> Result<(), Failure> {
    // SAFETY: the caller vouches for both; no more than `room` items are written.
    unsafe {
        let count = exclusive(count, "count")?;
        let room = std::mem::replace(count, items.len());
        if array.is_null() {
            return Ok(());
        }
        check_pointer(array.cast_const(), "the array")?;
        ptr::copy_nonoverlapping(items.as_ptr(), array, items.len().min(room));
        if room < items.len() { incomplete("count", items.len(), room) } else { Ok(()) }
    }
}

fn incomplete(name: &str, needed: usize, room: usize) -> Result<(), Failure> {
    let message = format!("{name}: {needed} are needed, there is room for {room}; give more, and call again");
    Err(Failure::new(AirglowStatus::Incomplete, message))
}
