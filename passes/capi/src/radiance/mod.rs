//! Incident radiance of near emitters for hosts in C and C++: triangles in, light of each vertex out, as relighting takes it.

#[cfg(any(test, feature = "conformance"))]
pub(crate) mod conformance;
pub mod lights;
pub mod plan;
pub mod prepared;
pub mod receiver;
pub mod settings;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use airglow_gpu::Context;
use airglow_radiance::{Radiance, RadianceError};

use crate::context::AirglowContext;
use crate::input::take;
use crate::pass::{make, refusals, require};
use crate::requirements::AirglowRequirements;
use crate::status::{AirglowError, AirglowStatus, edge};
use settings::AirglowRadianceSettings;

/// The radiance pass: its kernels for one context and one choice of settings. Any thread may use it.
pub struct AirglowRadiance {
    context: Arc<Context>,
    radiance: Radiance,
}

refusals!(RadianceError);

/// Adds what the pass asks of a device with these settings.
///
/// # Safety
/// `settings` points at as many bytes as it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_radiance_require(
    requirements: *mut AirglowRequirements,
    settings: *const AirglowRadianceSettings,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe { edge(error, || require(requirements, settings, Radiance::requirements)) }
}

/// Makes the pass: its kernels.
///
/// # Safety
/// `settings` points at as many bytes as it says; `radiance` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_radiance_new(
    context: *const AirglowContext,
    settings: *const AirglowRadianceSettings,
    radiance: *mut *mut AirglowRadiance,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            make(context, settings, (radiance, "radiance"), |context, settings| {
                let radiance = Radiance::new(&context, settings)?;
                Ok(AirglowRadiance { context, radiance })
            })
        })
    }
}

/// Drops the pass; what was made and prepared stays usable. Null is nothing.
///
/// # Safety
/// The pointer is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_radiance_drop(radiance: *mut AirglowRadiance) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(std::ptr::null_mut(), || take(radiance)) };
}
