//! The functions as a host calls them.

mod conformance;
mod frame;
mod heap;
mod hostile;
mod memory;

use airglow_tests::conformance::HostDevice;
use airglow_tests::device::{open, stated};

use super::conformance::{requirements, settings};
use crate::conformance::{adopt_info, call};
use crate::context::AirglowContext;
use crate::relight::settings::AirglowRelightSettings;
use crate::requirements::airglow_requirements_drop;
use crate::text::AirglowText;

/// Calls a function with an error at its end, which must be this status; returns the message.
macro_rules! refused {
    ($status:ident, $function:path, $($argument:expr),*) => {{
        let mut error = $crate::conformance::error();
        // SAFETY: what is refused is refused before it is used.
        let status = unsafe { $function($($argument,)* &raw mut error) };
        let said = $crate::conformance::message(&error).to_owned();
        assert_eq!((status, error.status), (AirglowStatus::$status, AirglowStatus::$status), "{said}");
        assert!(!said.is_empty(), "{} says nothing", stringify!($function));
        said
    }};
}
use refused;

/// Runs `test` with a host's device.
fn with_host(test: impl FnOnce(&HostDevice<'_>)) {
    let asked = airglow_relight::Relight::requirements(&settings(0).read().unwrap());
    let open = open(&asked);
    test(&stated(&open, open.device()));
    let said = open.messages().take();
    assert!(said.is_empty(), "{said:?}");
}

/// What a call writes to a text.
fn text(write: impl Fn(*mut AirglowText)) -> String {
    let mut bytes = vec![0u8; 1 << 16];
    let mut text = AirglowText { data: bytes.as_mut_ptr().cast(), capacity: bytes.len(), length: 0 };
    write(&raw mut text);
    String::from_utf8(bytes[..text.length].to_vec()).unwrap()
}

/// Adopts a host's device for the pass.
fn adopt(host: &HostDevice<'_>, settings: &AirglowRelightSettings) -> *mut AirglowContext {
    let asked = requirements(settings);
    let context = crate::conformance::adopt(host, asked);
    // SAFETY: they were read by the call above alone.
    unsafe { airglow_requirements_drop(asked) };
    context
}
