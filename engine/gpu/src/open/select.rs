//! Which device: by index, by part of its name, or by kind.

use crate::error::GpuError;
use crate::feature::FeatureSet;
use crate::offer::Missing;
use crate::requirements::Requirements;
use ash::vk;
use std::convert::Infallible;
use std::ffi::CStr;
use std::fmt;
use std::str::FromStr;

/// What sort of device it is. The order is the order of preference.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DeviceKind {
    /// A GPU with memory of its own.
    Discrete,
    /// A GPU that shares the CPU's memory.
    Integrated,
    /// A GPU seen through a virtual machine.
    Virtual,
    /// Software.
    Cpu,
    /// Anything else.
    #[default]
    Other,
}

/// Which device to open.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Selector {
    /// The first of the best kind: a real GPU before software.
    #[default]
    Best,
    /// By position in [`super::devices`].
    Index(usize),
    /// The first whose name or driver contains this, in any case.
    Name(String),
    /// The first of a kind.
    Kind(DeviceKind),
}

/// A number is an index, `cpu`, `integrated`, `discrete` and `virtual` are kinds, `best` is the default, anything else
/// is part of a name.
impl FromStr for Selector {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(match text.to_lowercase().as_str() {
            "best" => Self::Best,
            "cpu" => Self::Kind(DeviceKind::Cpu),
            "integrated" => Self::Kind(DeviceKind::Integrated),
            "discrete" => Self::Kind(DeviceKind::Discrete),
            "virtual" => Self::Kind(DeviceKind::Virtual),
            lower => lower.parse().map_or_else(|_| Self::Name(text.to_owned()), Self::Index),
        })
    }
}

/// What was asked for, as a noun: ``device named `arc` ``.
impl fmt::Display for Selector {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Best => write!(out, "device of Vulkan 1.3 or later"),
            Self::Index(index) => write!(out, "device with index {index}"),
            Self::Name(part) => write!(out, "device named `{part}`"),
            Self::Kind(kind) => write!(out, "device of kind {}", format!("{kind:?}").to_lowercase()),
        }
    }
}

/// A device in a list, and in the head of a report.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DeviceLine {
    /// Position in the loader's order.
    pub index: usize,
    /// The device's name.
    pub name: String,
    /// Its kind.
    pub kind: DeviceKind,
    /// Driver name and version, in the driver's words.
    pub driver: String,
    /// Vulkan version, as (major, minor, patch).
    pub api_version: (u32, u32, u32),
}

impl fmt::Display for DeviceLine {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (major, minor, patch) = self.api_version;
        let Self { index, name, kind, driver, .. } = self;
        write!(out, "{index}: {name} ({kind:?}), {driver}, Vulkan {major}.{minor}.{patch}")
    }
}

impl Selector {
    /// The position in `lines` of the device that is meant. Devices below Vulkan 1.3 are taken by index only.
    fn choose(&self, lines: &[DeviceLine]) -> Option<usize> {
        let able = |line: &&DeviceLine| line.api_version >= (1, 3, 0);
        let found = match self {
            Self::Index(index) => lines.get(*index),
            Self::Best => lines.iter().filter(able).min_by_key(|line| line.kind),
            Self::Kind(kind) => lines.iter().filter(able).find(|line| line.kind == *kind),
            Self::Name(part) => {
                let part = part.to_lowercase();
                let has = |text: &str| text.to_lowercase().contains(&part);
                lines.iter().filter(able).find(|line| has(&line.name) || has(&line.driver))
            }
        };
        found.map(|line| line.index)
    }
}

/// The devices of an instance.
pub(super) fn list(instance: &ash::Instance) -> Result<Vec<(vk::PhysicalDevice, DeviceLine)>, GpuError> {
    // SAFETY: a live instance.
    let devices = unsafe { instance.enumerate_physical_devices() }
        .map_err(GpuError::vulkan("vkEnumeratePhysicalDevices"))?;
    Ok(devices.into_iter().enumerate().map(|(index, raw)| (raw, line(instance, index, raw))).collect())
}

fn line(instance: &ash::Instance, index: usize, raw: vk::PhysicalDevice) -> DeviceLine {
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
    // SAFETY: a device of this instance; one that does not know the driver structure leaves it alone.
    unsafe { instance.get_physical_device_properties2(raw, &mut properties) };
    let base = properties.properties;
    let text = |text: Option<&CStr>| text.unwrap_or_default().to_string_lossy().into_owned();
    let name = text(base.device_name_as_c_str().ok());
    let driver =
        format!("{} {}", text(driver.driver_name_as_c_str().ok()), text(driver.driver_info_as_c_str().ok()));
    let version = base.api_version;
    DeviceLine {
        index,
        name,
        kind: match base.device_type {
            vk::PhysicalDeviceType::DISCRETE_GPU => DeviceKind::Discrete,
            vk::PhysicalDeviceType::INTEGRATED_GPU => DeviceKind::Integrated,
            vk::PhysicalDeviceType::VIRTUAL_GPU => DeviceKind::Virtual,
            vk::PhysicalDeviceType::CPU => DeviceKind::Cpu,
            _ => DeviceKind::Other,
        },
        driver: driver.trim().to_owned(),
        api_version: (
            vk::api_version_major(version),
            vk::api_version_minor(version),
            vk::api_version_patch(version),
        ),
    }
}

/// The device that `selector` means.
pub(super) fn choose(
    instance: &ash::Instance,
    selector: &Selector,
) -> Result<(vk::PhysicalDevice, DeviceLine), GpuError> {
    let devices = list(instance)?;
    let lines: Vec<_> = devices.iter().map(|(_, line)| line.clone()).collect();
    let Some(index) = selector.choose(&lines) else {
        return Err(GpuError::misuse("choosing a device", none(selector, &lines)));
    };
    devices.into_iter().nth(index).ok_or_else(|| GpuError::misuse("devices", "the list changed"))
}

/// That no device is meant by `selector`, and what could be.
fn none(selector: &Selector, lines: &[DeviceLine]) -> String {
    if lines.is_empty() {
        return format!("no {selector}: there is no Vulkan device; install a driver");
    }
    let known: Vec<_> = lines.iter().map(ToString::to_string).collect();
    format!("no {selector}; there are: {}; see `airglow devices`", known.join(", "))
}

/// The first queue family with all of `needed`.
pub(super) fn queue_family(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
    needed: vk::QueueFlags,
) -> Result<u32, GpuError> {
    // SAFETY: a device of this instance.
    let families = unsafe { instance.get_physical_device_queue_family_properties(physical_device) };
    let position = families.iter().position(|family| family.queue_flags.contains(needed));
    let offered = families.first().map(|family| family.queue_flags).unwrap_or_default();
    position
        .and_then(|index| u32::try_from(index).ok())
        .ok_or_else(|| GpuError::Missing(vec![Missing::Queue { needed, offered }]))
}

/// The features `physical_device` supports, or the error that it is too old to be asked.
pub(super) fn supported(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
    line: &DeviceLine,
) -> Result<FeatureSet, GpuError> {
    let (major, minor, patch) = line.api_version;
    if line.api_version < (1, 3, 0) {
        let (needed, offered) = (vk::API_VERSION_1_3, vk::make_api_version(0, major, minor, patch));
        return Err(GpuError::Missing(vec![Missing::ApiVersion { needed, offered }]));
    }
    // SAFETY: a device of this instance, of version 1.3.
    Ok(unsafe { FeatureSet::supported(instance, physical_device) })
}

/// The optional extensions that the device has; of two that buy the same, the first.
pub(super) fn optional_extensions(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
    requirements: &Requirements,
) -> Result<Vec<&'static CStr>, GpuError> {
    // SAFETY: a device of this instance.
    let have = unsafe { instance.enumerate_device_extension_properties(physical_device) }
        .map_err(GpuError::vulkan("vkEnumerateDeviceExtensionProperties"))?;
    let has = |name: &CStr| have.iter().any(|extension| extension.extension_name_as_c_str() == Ok(name));
    let mut enabled: Vec<(&str, &CStr)> = Vec::new();
    for need in &requirements.optional_extensions {
        let known = super::KNOWN.into_iter().find(|known| known.to_bytes() == need.name.as_bytes());
        let known = known.filter(|name| has(name) && !enabled.iter().any(|(buys, _)| *buys == need.buys));
        enabled.extend(known.map(|name| (need.buys, name)));
    }
    Ok(enabled.into_iter().map(|(_, name)| name).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn device(index: usize, name: &str, kind: DeviceKind, minor: u32) -> DeviceLine {
        let driver = "Mesa".to_owned();
        DeviceLine { index, name: name.to_owned(), kind, driver, api_version: (1, minor, 0) }
    }

    #[test]
    fn selectors_mean_what_they_say() {
        let lines = [
            device(0, "llvmpipe", DeviceKind::Cpu, 3),
            device(1, "Old GPU", DeviceKind::Discrete, 1),
            device(2, "Intel Arc", DeviceKind::Integrated, 3),
        ];
        let choose = |text: &str| text.parse::<Selector>().unwrap().choose(&lines);
        assert_eq!(Selector::Best.choose(&lines), Some(2), "software and old devices come last");
        assert_eq!(choose("cpu"), Some(0));
        assert_eq!(choose("arc"), Some(2));
        assert_eq!(choose("1"), Some(1), "an index is taken at its word");
        assert_eq!(choose("discrete"), None);
        assert_eq!(choose("3"), None);
        assert_eq!(Selector::Best.choose(&lines[..1]), Some(0));
    }

    #[test]
    fn an_unknown_device_is_answered_with_those_there_are() {
        let lines = [device(0, "llvmpipe", DeviceKind::Cpu, 3)];
        let answer = |text: &str| none(&text.parse().unwrap(), &lines);
        let there = "there are: 0: llvmpipe (Cpu), Mesa, Vulkan 1.3.0; see `airglow devices`";
        assert_eq!(answer("noSuch"), format!("no device named `noSuch`; {there}"));
        assert_eq!(answer("3"), format!("no device with index 3; {there}"));
        assert_eq!(answer("discrete"), format!("no device of kind discrete; {there}"));
        assert!(none(&Selector::Best, &[]).contains("install a driver"));
    }
}
