//! What the validation layers say, collected. A layer without a messenger says nothing: silence proves nothing.

use crate::error::GpuError;
use crate::shared::lock;
use ash::vk;
use std::ffi::{CStr, c_char, c_void};
use std::fmt;
use std::sync::{Arc, Mutex};

/// A warning or error of the validation layers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// True for an error, false for a warning.
    pub error: bool,
    /// Its identifier, such as `VUID-…` or `SYNC-HAZARD-…`.
    pub id: String,
    /// Its text.
    pub text: String,
}

impl fmt::Display for Message {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{} {}: {}", if self.error { "error" } else { "warning" }, self.id, self.text)
    }
}

/// The messages heard so far. Clones share them, and may outlive the device: what its destruction says is heard too.
#[derive(Clone, Debug, Default)]
pub struct MessageLog(Arc<Mutex<Vec<Message>>>);

impl MessageLog {
    /// The messages since the last call.
    pub fn take(&self) -> Vec<Message> {
        std::mem::take(&mut *lock(&self.0))
    }
}

/// A debug messenger.
pub(super) struct Messenger {
    functions: ash::ext::debug_utils::Instance,
    raw: vk::DebugUtilsMessengerEXT,
    /// The layers hold its address.
    pub log: MessageLog,
}

impl Messenger {
    pub(super) fn new(entry: &ash::Entry, instance: &ash::Instance) -> Result<Self, GpuError> {
        let functions = ash::ext::debug_utils::Instance::new(entry, instance);
        let log = MessageLog::default();
        let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(
                vk::DebugUtilsMessageSeverityFlagsEXT::WARNING | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR,
            )
            .message_type(
                vk::DebugUtilsMessageTypeFlagsEXT::GENERAL
                    | vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION
                    | vk::DebugUtilsMessageTypeFlagsEXT::PERFORMANCE,
            )
            .pfn_user_callback(Some(hear))
            .user_data(Arc::as_ptr(&log.0).cast_mut().cast());
        // SAFETY: the extension is enabled whenever validation is; the list outlives the messenger.
        let raw = unsafe { functions.create_debug_utils_messenger(&info, None) }
            .map_err(GpuError::vulkan("vkCreateDebugUtilsMessengerEXT"))?;
        Ok(Self { functions, raw, log })
    }
}

impl Drop for Messenger {
    fn drop(&mut self) {
        // SAFETY: the messenger is dropped before its instance.
        unsafe { self.functions.destroy_debug_utils_messenger(self.raw, None) };
    }
}

/// Appends a message to the list that `user_data` points at.
unsafe extern "system" fn hear(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user_data: *mut c_void,
) -> vk::Bool32 {
    let text = |text: *const c_char| {
        if text.is_null() {
            return String::new();
        }
        // SAFETY: the layers pass nul-terminated strings or null.
        unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
    };
    // SAFETY: the layers pass valid data, and back the address of the list, which outlives the messenger.
    let (data, heard) = unsafe { (&*data, &*user_data.cast::<Mutex<Vec<Message>>>()) };
    lock(heard).push(Message {
        error: severity.contains(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR),
        id: text(data.p_message_id_name),
        text: text(data.p_message),
    });
    vk::FALSE
}
