//! Requirements as JSON, for hosts and tools in other languages.

use super::Requirements;
use crate::feature::Feature;
use ash::vk;
use serde_json::{Value, json};
use std::fmt::Debug;

impl Requirements {
    /// All of it as JSON. Keys are sorted, lists keep their order: the same requirements give the same text.
    ///
    /// `api_version` is "major.minor"; `before_1_3` maps features that are core in 1.3 to the extensions that bring them
    /// to older devices; `features` of formats are of images with optimal tiling, and of buffers for `VERTEX_BUFFER`;
    /// limits are in their own units.
    pub fn json(&self) -> String {
        let version = (vk::api_version_major(self.api_version), vk::api_version_minor(self.api_version));
        let needed_before = |feature: Feature| Some((feature.name(), feature.extension_before_1_3()?));
        let before: serde_json::Map<_, _> = self
            .features
            .iter()
            .filter_map(|need| needed_before(need.feature))
            .map(|(name, extension)| (name.to_owned(), json!(extension)))
            .collect();
        let extension = |need: &super::ExtensionNeed| json!({ "name": need.name, "required": need.required, "buys": need.buys });
        let feature = |need: &super::FeatureNeed| json!({ "name": need.feature.name(), "required": need.required, "buys": need.buys });
        let limit = |need: &super::LimitNeed| json!({ "name": need.limit.name(), "at_least": need.at_least, "why": need.why });
        let format = |need: &super::FormatNeed| json!({ "format": format!("{:?}", need.format), "features": flags(need.usage), "why": need.why });
        let all = json!({
            "api_version": format!("{}.{}", version.0, version.1),
            "before_1_3": before,
            "instance_extensions": self.instance_extensions.iter().map(extension).collect::<Vec<_>>(),
            "device_extensions": self.extensions,
            "optional_device_extensions": self.optional_extensions.iter().map(extension).collect::<Vec<_>>(),
            "features": self.features.iter().map(feature).collect::<Vec<_>>(),
            "limits": self.limits.iter().map(limit).collect::<Vec<_>>(),
            "formats": self.formats.iter().map(format).collect::<Vec<_>>(),
            "queue": { "capabilities": flags(self.queue), "count": 1 },
        });
        format!("{all:#}\n")
    }
}

/// The names of the flags that are set, as ash prints them.
fn flags(flags: impl Debug) -> Vec<Value> {
    let text = format!("{flags:?}");
    text.split(" | ").filter(|name| !name.is_empty()).map(|name| json!(name)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{FormatNeed, Limit};
    use super::*;
    use crate::pipeline::{BindingDesc, BindingKind};

    #[test]
    fn json_says_all_that_the_data_says() {
        let usage = vk::FormatFeatureFlags::VERTEX_BUFFER | vk::FormatFeatureFlags::COLOR_ATTACHMENT;
        let format = vk::Format::R32G32B32A32_SFLOAT;
        let mut requirements = Requirements::engine().with_descriptors(
            &[0, 1, 2].map(|binding| BindingDesc::new(binding, BindingKind::StorageBuffer)),
        );
        requirements.formats.push(FormatNeed { format, usage, why: "vertex colours" });
        requirements.extensions.push("VK_KHR_x");
        let text = requirements.json();
        assert_eq!(text, requirements.clone().and(&requirements).json(), "joined with itself it is the same");
        let parsed: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(parsed["api_version"], "1.2");
        assert_eq!(parsed["before_1_3"]["dynamicRendering"], "VK_KHR_dynamic_rendering");
        assert_eq!(parsed["instance_extensions"][0]["name"], "VK_EXT_debug_utils");
        assert_eq!(parsed["device_extensions"], json!(["VK_KHR_x"]));
        assert_eq!(parsed["optional_device_extensions"][0]["required"], false);
        assert_eq!(parsed["formats"][0]["format"], "R32G32B32A32_SFLOAT");
        let mut features = parsed["formats"][0]["features"].as_array().unwrap().clone();
        features.sort_by_key(Value::to_string);
        assert_eq!(features, [json!("COLOR_ATTACHMENT"), json!("VERTEX_BUFFER")]);
        assert_eq!(parsed["queue"]["capabilities"], json!(["GRAPHICS", "COMPUTE"]));
        let limits = parsed["limits"].as_array().unwrap();
        let descriptors = limits.iter().find(|limit| limit["name"] == Limit::PerStageStorageBuffers.name());
        assert_eq!(descriptors.unwrap()["at_least"], 3);
        assert_eq!(parsed["features"].as_array().unwrap().len(), requirements.features.len());
    }
}
