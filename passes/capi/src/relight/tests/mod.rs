//! The functions as a host calls them.

mod conformance;
mod frame;
mod health;
mod heap;
mod hostile;
mod memory;

use std::ptr::null_mut;

use airglow_tests::conformance::HostDevice;

use super::airglow_relight_require;
use super::conformance::{in_c, settings};
use crate::pass::Settings as _;
use crate::relight::settings::AirglowRelightSettings;
use crate::requirements::{AirglowRequirements, airglow_requirements_new};
use crate::testing::{call, refused, text};
use crate::through_c::adopt_info;

/// Runs `test` with a host's device.
fn with_host(test: impl FnOnce(&HostDevice<'_>)) {
    let asked = airglow_relight::Relight::requirements(&settings(0).read().unwrap());
    crate::testing::with_host(&asked, test);
}

/// What the pass asks for.
fn requirements(settings: &AirglowRelightSettings) -> *mut AirglowRequirements {
    let mut requirements = null_mut();
    call!(airglow_requirements_new, &raw mut requirements);
    call!(airglow_relight_require, requirements, settings);
    requirements
}
