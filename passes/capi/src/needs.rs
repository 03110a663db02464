//! The requirements as rows, for hosts that read them.

use std::ffi::c_char;

use airglow_gpu::Requirements;

/// What an `AirglowNeed` is about.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowNeedKind {
    /// The API version of instance and device: `value` as `VK_MAKE_API_VERSION` packs it.
    ApiVersion = 0,
    /// An extension of the instance.
    InstanceExtension = 1,
    /// An extension of the device.
    DeviceExtension = 2,
    /// An extension of a device below Vulkan 1.3, where it stands for a feature that is core later.
    DeviceExtensionBelow13 = 3,
    /// A feature, by its field's name in the Vulkan specification.
    Feature = 4,
    /// A limit by its field's name; `value` is the least it may be, in its own unit.
    Limit = 5,
    /// A format: `value` is the `VkFormat`, `flags` the `VkFormatFeatureFlags` asked of images with optimal tiling, and
    /// of buffers for vertex input.
    Format = 6,
    /// The queue family that commands are submitted to: `flags` are its `VkQueueFlags`.
    Queue = 7,
}

/// One thing asked of a device. Texts live until the requirements change or are dropped.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowNeed {
    /// An `AirglowNeedKind`.
    pub kind: u32,
    /// 1: without it nothing runs. 0: it only buys something.
    pub required: u32,
    /// See `AirglowNeedKind`.
    pub value: u64,
    /// See `AirglowNeedKind`.
    pub flags: u64,
    /// The name of extension, feature or limit; empty for others.
    pub name: *const c_char,
    /// What it is for or what it buys.
    pub why: *const c_char,
}

/// An [`AirglowNeed`] before its texts have a home.
pub(crate) struct Row {
    pub kind: AirglowNeedKind,
    pub required: bool,
    pub value: u64,
    pub flags: u64,
    pub name: &'static str,
    pub why: &'static str,
}

pub(crate) fn rows(asked: &Requirements) -> Vec<Row> {
    use AirglowNeedKind as Kind;
    let row = |kind, name, why| Row { kind, required: true, value: 0, flags: 0, name, why };
    let mut rows = vec![
        Row { value: asked.api_version.into(), ..row(Kind::ApiVersion, "", "the functions called") },
        Row { flags: asked.queue.as_raw().into(), ..row(Kind::Queue, "", "the commands recorded") },
    ];
    rows.extend(
        asked.instance_extensions.iter().map(|need| Row {
            required: need.required,
            ..row(Kind::InstanceExtension, need.name, need.buys)
        }),
    );
    rows.extend(asked.extensions.iter().map(|name| row(Kind::DeviceExtension, name, "")));
    rows.extend(asked.features.iter().filter_map(|need| {
        let name = need.feature.extension_before_1_3()?;
        Some(Row { required: need.required, ..row(Kind::DeviceExtensionBelow13, name, need.buys) })
    }));
    rows.extend(
        asked.features.iter().map(|need| Row {
            required: need.required,
            ..row(Kind::Feature, need.feature.name(), need.buys)
        }),
    );
    rows.extend(
        asked
            .limits
            .iter()
            .map(|need| Row { value: need.at_least, ..row(Kind::Limit, need.limit.name(), need.why) }),
    );
    rows.extend(asked.formats.iter().map(|need| Row {
        value: need.format.as_raw() as u64,
        flags: need.usage.as_raw().into(),
        ..row(Kind::Format, "", need.why)
    }));
    rows
}
