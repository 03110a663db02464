//! One error type for the device layer: each message names the item and the mend.

use crate::offer::Missing;
use ash::vk;

/// Why something on the device could not be made or recorded.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// A Vulkan call failed; the result is passed through untouched (device loss included).
    #[error("{call} returned {result:?}")]
    Vulkan {
        /// Name of the Vulkan function.
        call: &'static str,
        /// What it returned.
        result: vk::Result,
    },
    /// The host's get-proc-addr returned null for a function that would be called.
    #[error(
        "get-proc-addr returned null for {name}; create the instance and device for Vulkan 1.3 and enable the extension that owns it"
    )]
    MissingFunction {
        /// Name of the Vulkan function.
        name: &'static str,
    },
    /// The device, or what the host enabled on it, lacks something required.
    #[error("the device lacks what is required: {}", list(.0))]
    Missing(Vec<Missing>),
    /// A size is over a limit of the device.
    #[error("{what} needs {size} bytes but {limit} is {allowed}; split it or make it smaller")]
    TooLarge {
        /// The object concerned.
        what: String,
        /// Bytes asked for.
        size: u64,
        /// Name of the limit.
        limit: &'static str,
        /// Its value in bytes.
        allowed: u64,
    },
    /// An object would take the context over the host's memory budget; nothing was allocated.
    #[error(
        "{what} needs {size} bytes, {held} are held and the budget is {budget}: only {} more fit; free something, \
         choose smaller settings, or raise the budget to {}",
        .budget.saturating_sub(*.held),
        .held.saturating_add(*.size)
    )]
    Budget {
        /// The object, or the objects together.
        what: String,
        /// Bytes asked for.
        size: u64,
        /// Bytes that the context's objects hold.
        held: u64,
        /// The budget in bytes.
        budget: u64,
    },
    /// No memory for an object.
    #[error("no memory for {what}: {reason}; free something or ask for less")]
    Memory {
        /// The object concerned.
        what: String,
        /// The allocator's words.
        reason: String,
    },
    /// A call that Vulkan does not allow, refused before it is recorded.
    #[error("{what}: {problem}")]
    Misuse {
        /// The object or call concerned.
        what: String,
        /// What is wrong and how to mend it.
        problem: String,
    },
}

impl GpuError {
    /// For `map_err` on the result of the Vulkan function `call`.
    pub(crate) fn vulkan(call: &'static str) -> impl FnOnce(vk::Result) -> Self {
        move |result| Self::Vulkan { call, result }
    }

    /// A refusal: `what` was misused, `problem` says how and what to do instead.
    ///
    /// Passes use it for the checks they make themselves while recording.
    pub fn misuse(what: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Misuse { what: what.into(), problem: problem.into() }
    }

    /// True when the device is lost: nothing more can be recorded, dropping everything stays safe.
    pub fn is_device_lost(&self) -> bool {
        matches!(self, Self::Vulkan { result: vk::Result::ERROR_DEVICE_LOST, .. })
    }

    /// True when a window's surface is lost: make another on the same window.
    pub fn is_surface_lost(&self) -> bool {
        matches!(self, Self::Vulkan { result: vk::Result::ERROR_SURFACE_LOST_KHR, .. })
    }
}

fn list(missing: &[Missing]) -> String {
    missing.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}
