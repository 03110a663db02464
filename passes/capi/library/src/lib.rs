//! `libairglow.so` and `libairglow.a`: all that [`airglow_capi`] exports, and nothing else.

pub use airglow_capi::*;
