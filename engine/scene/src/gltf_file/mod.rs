//! glTF 2.0 files: the document is checked as a whole first, then read part by part into a [`Scene`].

mod accessor;
mod animation;
mod check;
mod document;
mod extensions;
mod materials;
mod nodes;
mod primitive;
mod repair;
mod textures;
mod uv_transform;

use std::path::Path;

use crate::error::SceneError;
use crate::scene::Scene;
use crate::warning::Warnings;

/// Loads a `.glb` or `.gltf` file with the buffers and images it names.
pub(crate) fn load(file: &Path) -> Result<Scene, SceneError> {
    let mut warnings = Warnings::new(file);
    let document = document::open(file, &mut warnings)?;
    let mut scene = Scene::default();
    materials::read(&document, &mut scene, &mut warnings)?;
    let primitives = primitive::read(&document, &mut scene, &mut warnings)?;
    nodes::read(&document, &primitives, &mut scene, &mut warnings)?;
    animation::read(&document, &mut scene, &mut warnings)?;
    if scene.instances.is_empty() {
        warnings.add("scene", "no mesh is placed; make a node of the default scene name one");
    }
    scene.warnings = warnings.list;
    Ok(scene)
}

/// How a message names an item: `mesh 2 "roof"`.
fn label(kind: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) => format!("{kind} {index} {name:?}"),
        None => format!("{kind} {index}"),
    }
}

/// The file's name for an item, or its kind and index.
fn name_of(kind: &str, index: usize, name: Option<&str>) -> String {
    name.map_or_else(|| format!("{kind} {index}"), str::to_owned)
}
