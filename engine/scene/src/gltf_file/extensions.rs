//! Extensions: which are read, and the naming of those that are not.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value;

use crate::error::{SceneError, unsupported};
use crate::warning::Warnings;

/// Extensions that are read.
const READ: [&str; 4] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_texture_transform",
];

/// Refuses a file that cannot be shown without an extension that is not read.
pub(super) fn refuse_required(file: &Path, root: &gltf::json::Root) -> Result<(), SceneError> {
    for name in &root.extensions_required {
        if !READ.contains(&name.as_str()) {
            let mend = match name.as_str() {
                "KHR_draco_mesh_compression" | "EXT_meshopt_compression" | "KHR_mesh_quantization" => {
                    "export the meshes uncompressed, as 32-bit floats"
                }
                "KHR_texture_basisu" | "EXT_texture_webp" | "EXT_texture_avif" => {
                    "export the textures as PNG or JPEG"
                }
                _ => "export the file without it",
            };
            return Err(unsupported(file, "extensionsRequired", format!("extension {name}"), mend));
        }
    }
    Ok(())
}

/// Names every extension in the document that is not read, with the number of places and the first of them.
pub(super) fn warn(document: &Value, warnings: &mut Warnings<'_>) {
    let mut found = BTreeMap::new();
    collect(document, &mut Vec::new(), &mut found);
    for (name, (count, place)) in found {
        let message = format!("extension {name} is not read; left out at {count} place(s), first here");
        warnings.add(place, message);
    }
}

/// Counts the keys of every `extensions` object outside `extras`. The depth is bounded by the JSON parser.
fn collect(value: &Value, path: &mut Vec<String>, found: &mut BTreeMap<String, (usize, String)>) {
    match value {
        Value::Object(members) => {
            for (key, member) in members {
                if key == "extras" {
                    continue;
                }
                if let (true, Value::Object(extensions)) = (key == "extensions", member) {
                    for name in extensions.keys().filter(|name| !READ.contains(&name.as_str())) {
                        found.entry(name.clone()).or_insert_with(|| (0, path.join("."))).0 += 1;
                    }
                }
                path.push(key.clone());
                collect(member, path, found);
                path.pop();
            }
        }
        Value::Array(elements) => {
            for (index, element) in elements.iter().enumerate() {
                path.push(index.to_string());
                collect(element, path, found);
                path.pop();
            }
        }
        _ => {}
    }
}
