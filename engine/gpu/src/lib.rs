//! Vulkan under a plan: adopt a host's device, memory, pipelines, recording, timing and readback.
