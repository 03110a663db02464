//! The functions as a host calls them.

mod conformance;
mod frame;
mod heap;
mod hostile;
mod memory;

use airglow_tests::conformance::HostDevice;

use super::conformance::{requirements, settings};
use crate::conformance::adopt_info;
use crate::context::AirglowContext;
use crate::relight::settings::AirglowRelightSettings;
use crate::requirements::airglow_requirements_drop;
use crate::testing::{call, refused, text};

/// Runs `test` with a host's device.
fn with_host(test: impl FnOnce(&HostDevice<'_>)) {
    let asked = airglow_relight::Relight::requirements(&settings(0).read().unwrap());
    crate::testing::with_host(&asked, test);
}

/// Adopts a host's device for the pass.
fn adopt(host: &HostDevice<'_>, settings: &AirglowRelightSettings) -> *mut AirglowContext {
    let asked = requirements(settings).unwrap();
    let context = crate::conformance::adopt(host, asked).unwrap();
    // SAFETY: they were read by the call above alone.
    unsafe { airglow_requirements_drop(asked) };
    context
}
