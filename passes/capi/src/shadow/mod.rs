//! Soft shadows of moving things for hosts in C and C++: spheres in, dynamic visibility of each vertex out, as relighting
//! takes it.

#[cfg(any(test, feature = "conformance"))]
pub(crate) mod conformance;
pub mod hierarchy;
pub mod prepared;
pub mod settings;
#[cfg(test)]
mod tests;

use std::ffi::c_char;
use std::sync::Arc;

use airglow_gpu::Context;
use airglow_shadow::{Receivers, Shadow, ShadowError};

use crate::context::AirglowContext;
use crate::input::{array, shared, string, take};
use crate::pass::{give, make, refusals, require};
use crate::requirements::AirglowRequirements;
use crate::status::{AirglowError, AirglowStatus, edge};
use settings::AirglowShadowSettings;

/// The shadow pass: its kernel and tables for one context and one choice of settings. Any thread may use it.
pub struct AirglowShadow {
    context: Arc<Context>,
    shadow: Shadow,
}

/// The vertices of a mesh, put into clusters once. Any thread may use them.
pub struct AirglowShadowReceivers {
    receivers: Receivers,
}

refusals!(ShadowError);

/// Adds what the pass asks of a device with these settings.
///
/// # Safety
/// `settings` points at as many bytes as it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_shadow_require(
    requirements: *mut AirglowRequirements,
    settings: *const AirglowShadowSettings,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe { edge(error, || require(requirements, settings, |_| Shadow::requirements())) }
}

/// Makes the pass: its kernel and tables.
///
/// # Safety
/// `settings` points at as many bytes as it says; `shadow` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_shadow_new(
    context: *const AirglowContext,
    settings: *const AirglowShadowSettings,
    shadow: *mut *mut AirglowShadow,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            make(context, settings, (shadow, "shadow"), |context, settings| {
                let shadow = Shadow::new(&context, settings)?;
                Ok(AirglowShadow { context, shadow })
            })
        })
    }
}

/// Drops the pass; what was made and prepared stays usable. Null is nothing.
///
/// # Safety
/// The pointer is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_shadow_drop(shadow: *mut AirglowShadow) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(std::ptr::null_mut(), || take(shadow)) };
}

/// Puts the vertices of a mesh into clusters of 64, by their positions in object space; a mesh that is skinned keeps them.
/// `name`, which may be null, is used in the memory report.
///
/// # Safety
/// `positions` has `3 * vertex_count` values; `name` is null or ends in a nul; `receivers` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_shadow_receivers_new(
    shadow: *const AirglowShadow,
    name: *const c_char,
    positions: *const f32,
    vertex_count: usize,
    receivers: *mut *mut AirglowShadowReceivers,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            give(receivers, "receivers", || {
                let AirglowShadow { context, shadow } = shared(shadow, "shadow")?;
                let (name, positions) =
                    (string(name, "name", "receivers")?, array(positions.cast(), vertex_count, "positions")?);
                Ok(AirglowShadowReceivers { receivers: shadow.receivers(context, name, positions)? })
            })
        })
    }
}

/// Drops receivers; what was prepared with them stays usable. Null is nothing.
///
/// # Safety
/// The pointer is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_shadow_receivers_drop(receivers: *mut AirglowShadowReceivers) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(std::ptr::null_mut(), || take(receivers)) };
}
