//! Fog for hosts in C and C++: single scattering from lights inside a medium, in the host's own command buffer.

pub mod background;
#[cfg(any(test, feature = "conformance"))]
pub(crate) mod conformance;
pub mod plan;
pub mod prepared;
pub mod settings;
#[cfg(test)]
mod tests;
pub mod view;

use std::sync::Arc;

use airglow_fog::{Fog, FogError};
use airglow_gpu::Context;

use crate::context::AirglowContext;
use crate::input::take;
use crate::pass::{make, refusals, require};
use crate::requirements::AirglowRequirements;
use crate::status::{AirglowError, AirglowStatus, edge};
use settings::AirglowFogSettings;

/// The fog pass: its kernels for one context and one choice of settings. Any thread may use it.
pub struct AirglowFog {
    context: Arc<Context>,
    fog: Fog,
}

refusals!(FogError);

/// Adds what the pass asks of a device with these settings.
///
/// # Safety
/// `settings` points at as many bytes as it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_require(
    requirements: *mut AirglowRequirements,
    settings: *const AirglowFogSettings,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe { edge(error, || require(requirements, settings, Fog::requirements)) }
}

/// Makes the pass: its kernels.
///
/// # Safety
/// `settings` points at as many bytes as it says; `fog` may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_new(
    context: *const AirglowContext,
    settings: *const AirglowFogSettings,
    fog: *mut *mut AirglowFog,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            make(context, settings, (fog, "fog"), |context, settings| {
                let fog = Fog::new(&context, settings)?;
                Ok(AirglowFog { context, fog })
            })
        })
    }
}

/// Drops the pass; views that were prepared stay usable. Null is nothing.
///
/// # Safety
/// The pointer is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_fog_drop(fog: *mut AirglowFog) {
    // SAFETY: the caller vouches for the pointer.
    unsafe { edge(std::ptr::null_mut(), || take(fog)) };
}
