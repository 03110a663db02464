//! A host's get-proc-addr that watches, over the test device.

use crate::device::stated;
use airglow_gpu::open::OpenDevice;

pub use airglow_conformance::shim::{ACTIONS, Call, STATE, Shim};

/// Watches `open` for as long as it lives; waits for its turn.
pub fn watch(open: &OpenDevice) -> Shim {
    // SAFETY: the device lives, and states its own handles and functions.
    unsafe { Shim::watching(&stated(open, open.device())) }
}
