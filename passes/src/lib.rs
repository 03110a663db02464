//! Real-time lighting passes for Vulkan that an engine embeds in its own device.
