//! What can be checked of the caller's memory: null, alignment, sizes, UTF-8, and the versions of structures.
#![allow(dead_code, reason = "helpers of passes, of which there may be none")]

use std::ffi::{CStr, c_char};
use std::ptr;
use std::slice;

use crate::status::{AirglowStatus, Failure};

/// A larger `struct_size` is taken for a mistake.
const MOST_STRUCT_BYTES: usize = 4096;

/// A structure of the caller that begins with its size.
///
/// A caller compiled against an older header gives a smaller one: the fields it lacks are zero, and zero is every later
/// field's default. One compiled against a newer header gives a larger one: it is accepted while the part unknown here
/// is zero, so that nothing asked for is silently left undone.
///
/// # Safety
/// The type is `#[repr(C)]`, its first field is the `u32` of its size, zero bytes are a valid value, and no field of 8
/// bytes crosses a multiple of 8.
pub(crate) unsafe trait Versioned: Copy {
    /// Bytes of the oldest version; a multiple of 8.
    const OLDEST: usize;
}

/// Copies a structure of the caller, of whatever version.
///
/// # Safety
/// `pointer` is null or points at as many readable bytes as the `u32` there says.
pub(crate) unsafe fn versioned<T: Versioned>(pointer: *const T, name: &str) -> Result<T, Failure> {
    check_pointer(pointer, name)?;
    let refuse = |problem: String| Failure::new(AirglowStatus::InvalidStruct, format!("{name}: {problem}"));
    // SAFETY: the pointer is sound by the caller's promise; no more than the size stated is read, and zero bytes are a
    // valid value of the type.
    unsafe {
        let stated = pointer.cast::<u32>().read() as usize;
        let (known, bytes) = (size_of::<T>(), pointer.cast::<u8>());
        if stated < T::OLDEST || !stated.is_multiple_of(8) || stated > MOST_STRUCT_BYTES {
            return Err(refuse(format!(
                "its struct_size is {stated}; set it to its sizeof, {known} in this version"
            )));
        }
        let tail = slice::from_raw_parts(bytes.add(known.min(stated)), stated.saturating_sub(known));
        if tail.iter().any(|byte| *byte != 0) {
            return Err(refuse(format!(
                "it is of a newer version, {stated} bytes, and sets what this one, {known} bytes, does not know"
            )));
        }
        let mut value = std::mem::zeroed::<T>();
        ptr::copy_nonoverlapping(bytes, (&raw mut value).cast(), stated.min(known));
        Ok(value)
    }
}

/// Refuses null and what is not aligned.
pub(crate) fn check_pointer<T>(pointer: *const T, name: &str) -> Result<(), Failure> {
    match (pointer.is_null(), pointer.is_aligned()) {
        (true, _) => Err(Failure::argument(name, "it is null")),
        (_, false) => Err(Failure::argument(name, "it is not aligned")),
        _ => Ok(()),
    }
}

/// What a pointer of the caller points at.
///
/// # Safety
/// `pointer` is null or points at a `T` that no one changes while the reference lives.
pub(crate) unsafe fn shared<'a, T>(pointer: *const T, name: &str) -> Result<&'a T, Failure> {
    check_pointer(pointer, name)?;
    // SAFETY: the caller's promise is ours; null and misaligned pointers are gone.
    Ok(unsafe { &*pointer })
}

/// What a pointer of the caller points at, to be written.
///
/// # Safety
/// `pointer` is null or points at a `T` that no one else uses while the reference lives.
pub(crate) unsafe fn exclusive<'a, T>(pointer: *mut T, name: &str) -> Result<&'a mut T, Failure> {
    check_pointer(pointer.cast_const(), name)?;
    // SAFETY: the caller's promise is ours; null and misaligned pointers are gone.
    Ok(unsafe { &mut *pointer })
}

/// Writes a result through a pointer of the caller; what is there is not read.
///
/// # Safety
/// `target` is null or may be written.
pub(crate) unsafe fn store<T>(
    target: *mut T,
    name: &str,
    value: impl FnOnce() -> Result<T, Failure>,
) -> Result<(), Failure> {
    check_pointer(target.cast_const(), name)?;
    let value = value()?;
    // SAFETY: the caller's promise is ours; null and misaligned pointers are gone.
    unsafe { target.write(value) };
    Ok(())
}

/// An array of the caller; null is one of no elements.
///
/// # Safety
/// `pointer` is null or points at `count` elements that no one changes while the slice lives.
pub(crate) unsafe fn array<'a, T>(pointer: *const T, count: usize, name: &str) -> Result<&'a [T], Failure> {
    if count == 0 {
        return Ok(&[]);
    }
    check_pointer(pointer, name)?;
    check_count::<T>(count, name)?;
    // SAFETY: the caller's promise is ours; null, misaligned and impossibly large arrays are gone.
    Ok(unsafe { slice::from_raw_parts(pointer, count) })
}

/// An array of the caller that is written; null is one of no elements.
///
/// # Safety
/// `pointer` is null or points at `count` initialised elements that no one else uses while the slice lives.
pub(crate) unsafe fn array_mut<'a, T>(
    pointer: *mut T,
    count: usize,
    name: &str,
) -> Result<&'a mut [T], Failure> {
    if count == 0 {
        return Ok(&mut []);
    }
    check_pointer(pointer.cast_const(), name)?;
    check_count::<T>(count, name)?;
    // SAFETY: the caller's promise is ours; null, misaligned and impossibly large arrays are gone.
    Ok(unsafe { slice::from_raw_parts_mut(pointer, count) })
}

/// Refuses a count whose bytes no array can have.
fn check_count<T>(count: usize, name: &str) -> Result<(), Failure> {
    match count.checked_mul(size_of::<T>()) {
        Some(bytes) if isize::try_from(bytes).is_ok() => Ok(()),
        _ => Err(Failure::argument(name, &format!("no memory holds {count} of its elements"))),
    }
}

/// The value that a number of the caller stands for, counted from 0.
pub(crate) fn one_of<T: Copy>(name: &str, value: u32, values: &[T]) -> Result<T, Failure> {
    let problem = || format!("it is {value}: give 0 to {}", values.len().saturating_sub(1));
    values.get(value as usize).copied().ok_or_else(|| Failure::argument(name, &problem()))
}

/// A number whose 0 stands for a default and whose negative values for 0; what is none stays, to be refused.
pub(crate) fn or_default(value: f64, default: f64) -> f64 {
    match value {
        0.0 => default,
        below if below < 0.0 => 0.0,
        other => other,
    }
}

/// A text of the caller; null is `default`.
///
/// # Safety
/// `pointer` is null or points at a string that ends in a nul and that no one changes while the reference lives.
pub(crate) unsafe fn string<'a>(
    pointer: *const c_char,
    name: &str,
    default: &'a str,
) -> Result<&'a str, Failure> {
    if pointer.is_null() {
        return Ok(default);
    }
    // SAFETY: the caller's promise is ours.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| Failure::argument(name, "it is not UTF-8"))
}

/// Takes an object back that [`Box::into_raw`] gave to the caller; null is nothing.
///
/// # Safety
/// `pointer` is null or came from [`Box::into_raw`] and is not used again.
pub(crate) unsafe fn take<T>(pointer: *mut T) -> Result<(), Failure> {
    if !pointer.is_null() {
        // SAFETY: the caller's promise is ours.
        drop(unsafe { Box::from_raw(pointer) });
    }
    Ok(())
}
