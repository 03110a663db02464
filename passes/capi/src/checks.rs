//! What the conformance kit holds a pass to.
#![allow(dead_code, reason = "helpers of passes, of which there may be none")]

use std::ffi::CStr;

use airglow_conformance::{HostDevice, Refusal};
use airglow_gpu::Requirements;

/// A check with its name; its error is what is wrong.
type Check = (&'static CStr, fn(&HostDevice<'_>) -> Result<(), Refusal>);

/// The checks of a pass.
pub(crate) struct Checks {
    /// What they need of a device.
    pub requirements: fn() -> Result<Requirements, Refusal>,
    /// Each check.
    pub checks: &'static [Check],
}

/// A square of ground, for passes that light vertices.
pub(crate) fn ground() -> Vec<[f32; 3]> {
    (0..300).map(|i| [(i % 20) as f32, 0.0, (i / 20) as f32]).collect()
}
