//! What tests of the exported functions share.

use airglow_gpu::Requirements;
use airglow_tests::conformance::HostDevice;
use airglow_tests::device::{open, stated};
use airglow_tests::heap::Counting;

use crate::input::Versioned;
use crate::text::AirglowText;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Calls a function with an error at its end, and fails the test with the message.
macro_rules! call {
    ($($words:tt)*) => {
        $crate::through_c::attempt!($($words)*).unwrap()
    };
}
pub(crate) use call;

/// Calls a function with an error at its end, which must be this status; returns the message.
macro_rules! refused {
    ($status:ident, $function:path, $($argument:expr),*) => {{
        let mut error = $crate::through_c::error();
        // SAFETY: what is refused is refused before it is used.
        let status = unsafe { $function($($argument,)* &raw mut error) };
        let said = $crate::through_c::message(&error).to_owned();
        assert_eq!((status, error.status), (AirglowStatus::$status, AirglowStatus::$status), "{said}");
        assert!(!said.is_empty(), "{} says nothing", stringify!($function));
        said
    }};
}
pub(crate) use refused;

/// Hands `refused` the structure with sizes that no version has; the message says which.
pub(crate) fn sizes_refused<T: Versioned>(good: &T, mut refused: impl FnMut(*const T) -> String) {
    for stated in [0, 4, size_of::<T>() as u32 - 1, 1 << 20, u32::MAX] {
        let mut wrong = *good;
        // SAFETY: its size comes first.
        unsafe { (&raw mut wrong).cast::<u32>().write(stated) };
        let said = refused(&raw const wrong);
        assert!(said.contains(&format!("struct_size is {stated}")), "{said}");
    }
}

/// Runs `test` with a host's device that has what is asked; validation must stay silent.
pub(crate) fn with_host(asked: &Requirements, test: impl FnOnce(&HostDevice<'_>)) {
    let open = open(asked);
    test(&stated(&open, open.device()));
    let said = open.messages().take();
    assert!(said.is_empty(), "{said:?}");
}

/// What a call writes to a text.
pub(crate) fn text(write: impl Fn(*mut AirglowText)) -> String {
    let mut bytes = vec![0u8; 1 << 16];
    let mut text = AirglowText { data: bytes.as_mut_ptr().cast(), capacity: bytes.len(), length: 0 };
    write(&raw mut text);
    String::from_utf8(bytes[..text.length].to_vec()).unwrap()
}
