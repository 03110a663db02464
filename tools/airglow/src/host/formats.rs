//! The formats of what the host draws into.

use airglow_gpu::ash::vk;

/// Scene-linear radiance.
pub const HDR: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// Depth.
pub const DEPTH: vk::Format = vk::Format::D32_SFLOAT;
