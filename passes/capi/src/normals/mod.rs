//! Filtered normal maps for hosts in C and C++: a map in, a texture of lobes out, built in steps in the host's own command
//! buffers.

#[cfg(any(test, feature = "conformance"))]
pub(crate) mod conformance;
pub mod info;
pub mod map;
pub mod prepared;
pub mod settings;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use airglow_gpu::Context;
use airglow_normals::{Normals, NormalsError};

use crate::context::AirglowContext;
use crate::input::take;
use crate::pass::{make, refusals, require};
use crate::requirements::AirglowRequirements;
use crate::status::{AirglowError, AirglowStatus, edge};
use settings::AirglowNormalsSettings;

/// What builds textures of lobes: its kernels for one context and one choice of settings. Any thread may use it.
pub struct AirglowNormals {
    context: Arc<Context>,
    normals: Normals,
}

/// The pass, as errors and counters name it.
const PASS: &str = "normals";

refusals!(NormalsError);

/// Adds what the pass asks of a device with these settings.
///
/// # Safety
/// `settings` points at as many bytes as it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_normals_require(
    requirements: *mut AirglowRequirements,
    settings: *const AirglowNormalsSettings,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe { edge(error, || require(requirements, settings, Normals::requirements)) }
}

/// Makes the pass: its kernels.
///
/// # Safety
/// `settings` points at as many bytes as it says; `normals` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_normals_new(
    context: *const AirglowContext,
    settings: *const AirglowNormalsSettings,
    normals: *mut *mut AirglowNormals,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            make(context, settings, (normals, "normals"), |context, settings| {
                let normals = Normals::new(&context, settings)?;
                Ok(AirglowNormals { context, normals })
            })
        })
    }
}

/// Drops the pass; maps that were made stay usable. Null is nothing.
///
/// # Safety
/// The pointer is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_normals_drop(normals: *mut AirglowNormals) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(std::ptr::null_mut(), || take(normals)) };
}
