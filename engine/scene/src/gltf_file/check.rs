//! Checks on the JSON that the gltf crate leaves out and its readers rely on: they would panic otherwise.

use std::path::Path;

use gltf::json;
use json::validation::Checked;

use super::label;
use crate::error::{SceneError, at_most, invalid};
use crate::limits::MAX_NODE_DEPTH;

/// Checks what must hold before the crate's own validation, and what that does not look at.
pub(super) fn structure(file: &Path, root: &json::Root) -> Result<(), SceneError> {
    accessor_references(file, root)?;
    image_sources(file, root)?;
    camera_types(file, root)?;
    animation_channels(file, root)?;
    node_tree(file, root)
}

/// Primitives name accessors that exist.
fn accessor_references(file: &Path, root: &json::Root) -> Result<(), SceneError> {
    for (index, mesh) in root.meshes.iter().enumerate() {
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let used = primitive.attributes.values().chain(&primitive.indices);
            if let Some(bad) = used.map(json::Index::value).find(|used| *used >= root.accessors.len()) {
                let item = format!("{}, primitive {number}", label("mesh", index, mesh.name.as_deref()));
                let problem = format!("accessor {bad} does not exist");
                return Err(invalid(file, item, problem, "export the file again"));
            }
        }
    }
    Ok(())
}

/// Images are either in a buffer view of a stated type or behind a URI.
fn image_sources(file: &Path, root: &json::Root) -> Result<(), SceneError> {
    for (index, image) in root.images.iter().enumerate() {
        let problem = match (&image.buffer_view, &image.uri, &image.mime_type) {
            (None, None, _) => "neither a buffer view nor a URI is stated",
            (Some(_), Some(_), _) => "both a buffer view and a URI are stated",
            (Some(_), None, None) => "the MIME type of its buffer view is not stated",
            _ => continue,
        };
        let item = label("image", index, image.name.as_deref());
        return Err(invalid(file, item, problem, "export the file again"));
    }
    Ok(())
}

/// Cameras hold the projection that their type names.
fn camera_types(file: &Path, root: &json::Root) -> Result<(), SceneError> {
    for (index, camera) in root.cameras.iter().enumerate() {
        let stated = match camera.type_ {
            Checked::Valid(json::camera::Type::Perspective) => camera.perspective.is_some(),
            Checked::Valid(json::camera::Type::Orthographic) => camera.orthographic.is_some(),
            Checked::Invalid => false,
        };
        if !stated {
            let item = label("camera", index, camera.name.as_deref());
            let problem = "its type and its projection do not agree";
            return Err(invalid(file, item, problem, "state perspective or orthographic, with its values"));
        }
    }
    Ok(())
}

/// Channels name a sampler of their animation, a node and a property of it.
fn animation_channels(file: &Path, root: &json::Root) -> Result<(), SceneError> {
    for (index, animation) in root.animations.iter().enumerate() {
        for (number, channel) in animation.channels.iter().enumerate() {
            let (sampler, node) = (channel.sampler.value(), channel.target.node.value());
            let problem = if sampler >= animation.samplers.len() {
                format!("sampler {sampler} does not exist")
            } else if node >= root.nodes.len() {
                format!("node {node} does not exist")
            } else if matches!(channel.target.path, Checked::Invalid) {
                "its path is none of translation, rotation, scale and weights".to_owned()
            } else {
                continue;
            };
            let name = label("animation", index, animation.name.as_deref());
            return Err(invalid(file, format!("{name}, channel {number}"), problem, "export the file again"));
        }
    }
    Ok(())
}

/// Nodes make trees: children exist, no node has two parents, none is its own ancestor, depth is bounded.
fn node_tree(file: &Path, root: &json::Root) -> Result<(), SceneError> {
    let broken = |index: usize, problem: String| {
        let item = label("node", index, root.nodes.get(index).and_then(|node| node.name.as_deref()));
        invalid(file, item, problem, "make the nodes a tree and export the file again")
    };
    let mut parents = vec![None; root.nodes.len()];
    for (index, node) in root.nodes.iter().enumerate() {
        for child in node.children.iter().flatten().map(json::Index::value) {
            match parents.get_mut(child) {
                None => return Err(broken(index, format!("its child, node {child}, does not exist"))),
                Some(Some(other)) => {
                    return Err(broken(child, format!("it is a child of node {other} and of node {index}")));
                }
                Some(parent) => *parent = Some(index),
            }
        }
    }
    // From each root down: what is not reached lies on a cycle.
    let mut reached = vec![false; parents.len()];
    let tops = parents.iter().enumerate().filter(|(_, parent)| parent.is_none());
    let mut open: Vec<(usize, usize)> = tops.map(|(index, _)| (index, 1)).collect();
    while let Some((index, depth)) = open.pop() {
        const MEND: &str = "flatten the hierarchy";
        let item = || label("node", index, root.nodes[index].name.as_deref());
        at_most(file, item(), depth as u64, MAX_NODE_DEPTH as u64, "nodes above each other", MEND)?;
        reached[index] = true;
        let children = root.nodes[index].children.iter().flatten();
        open.extend(children.map(|child| (child.value(), depth + 1)));
    }
    match reached.iter().position(|reached| !reached) {
        Some(index) => Err(broken(index, "it is its own ancestor".into())),
        None => Ok(()),
    }
}
