//! `libairglow_conformance.so` and `libairglow_conformance.a`: all that `libairglow` exports, and the conformance kit.

pub use airglow_capi::*;
