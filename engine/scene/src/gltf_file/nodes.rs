//! Nodes: the transform tree of the file, and the instances, lights and cameras that the scene shows of it.

use std::path::Path;

use glam::{Mat4, Quat, Vec3};

use super::document::Document;
use super::{label, name_of};
use crate::animation::{LocalTransform, Node};
use crate::camera::{Camera, Projection};
use crate::error::{SceneError, at_most, invalid};
use crate::light::{Light, LightKind};
use crate::limits::MAX_INSTANCES;
use crate::scene::{Instance, Scene};
use crate::warning::Warnings;

/// Reads all nodes, and what the shown scene places with them. `primitives` holds the meshes of each glTF mesh.
pub(super) fn read(
    document: &Document,
    primitives: &[Vec<usize>],
    scene: &mut Scene,
    warnings: &mut Warnings<'_>,
) -> Result<(), SceneError> {
    read_tree(document, scene, warnings.file)?;
    let shown = shown_nodes(document, warnings);
    for node in document.gltf.nodes().filter(|node| shown[node.index()]) {
        let item = label("node", node.index(), node.name());
        let global = scene.nodes[node.index()].global;
        if let Some(mesh) = node.mesh() {
            let meshes = primitives.get(mesh.index()).map_or(&[][..], Vec::as_slice);
            place(&item, &node, meshes, global, scene, warnings)?;
        }
        if let Some(light) = node.light() {
            scene.lights.push(read_light(&light, node.index(), global, warnings.file)?);
        }
        if let Some(camera) = node.camera() {
            match read_camera(&camera, global, warnings.file)? {
                Some(camera) => scene.cameras.push(camera),
                None => warnings.add(item, "camera left out: its node has a scale of zero"),
            }
        }
    }
    Ok(())
}

/// Local and global transforms of all nodes, parents first.
fn read_tree(document: &Document, scene: &mut Scene, file: &Path) -> Result<(), SceneError> {
    for node in document.gltf.nodes() {
        let local = local_transform(&node, file)?;
        let name = name_of("node", node.index(), node.name());
        scene.nodes.push(Node { name, parent: None, local, global: Mat4::IDENTITY });
    }
    for node in document.gltf.nodes() {
        for child in node.children() {
            scene.nodes[child.index()].parent = Some(node.index());
        }
    }
    let is_root = |node: &gltf::Node<'_>| scene.nodes[node.index()].parent.is_none();
    let mut open: Vec<_> = document.gltf.nodes().filter(is_root).map(|node| (node, Mat4::IDENTITY)).collect();
    while let Some((node, parent)) = open.pop() {
        let global = parent * scene.nodes[node.index()].local.matrix();
        if !global.is_finite() {
            let item = label("node", node.index(), node.name());
            return Err(invalid(file, item, "its transform is not finite", "export the file again"));
        }
        scene.nodes[node.index()].global = global;
        open.extend(node.children().map(|child| (child, global)));
    }
    Ok(())
}

fn local_transform(node: &gltf::Node<'_>, file: &Path) -> Result<LocalTransform, SceneError> {
    let broken = |problem: &str| {
        let item = label("node", node.index(), node.name());
        Err(invalid(file, item, problem, "reset the node's transform and export again"))
    };
    match node.transform() {
        gltf::scene::Transform::Matrix { matrix } => {
            let matrix = Mat4::from_cols_array_2d(&matrix);
            if matrix.row(3) != glam::Vec4::W {
                return broken("the last row of its matrix is not 0, 0, 0, 1");
            }
            Ok(LocalTransform::Matrix(matrix))
        }
        gltf::scene::Transform::Decomposed { translation, rotation, scale } => {
            let length = Quat::from_array(rotation).length();
            if !(length > 0.0 && length.is_finite()) {
                return broken("its rotation is not a quaternion");
            }
            Ok(LocalTransform::Components {
                translation: translation.into(),
                rotation: Quat::from_array(rotation).normalize(),
                scale: scale.into(),
            })
        }
    }
}

/// For each node, whether the default scene (else the first one, else every node) holds it.
fn shown_nodes(document: &Document, warnings: &mut Warnings<'_>) -> Vec<bool> {
    let gltf = &document.gltf;
    let Some(chosen) = gltf.default_scene().or_else(|| gltf.scenes().next()) else {
        return vec![true; gltf.nodes().len()];
    };
    for other in gltf.scenes().filter(|other| other.index() != chosen.index()) {
        let item = label("scene", other.index(), other.name());
        warnings.add(item, format!("left out: scene {} is shown", chosen.index()));
    }
    let mut shown = vec![false; gltf.nodes().len()];
    let mut open: Vec<_> = chosen.nodes().collect();
    while let Some(node) = open.pop() {
        shown[node.index()] = true;
        open.extend(node.children());
    }
    shown
}

/// Adds an instance for each mesh of a node.
fn place(
    item: &str,
    node: &gltf::Node<'_>,
    meshes: &[usize],
    transform: Mat4,
    scene: &mut Scene,
    warnings: &mut Warnings<'_>,
) -> Result<(), SceneError> {
    let inverse = transform.inverse();
    if !inverse.is_finite() || transform.determinant() == 0.0 {
        warnings.add(item, "mesh left out: the transform flattens it");
        return Ok(());
    }
    let joint_count = node.skin().map(|skin| skin.joints().len());
    for mesh in meshes {
        let joints = &scene.meshes[*mesh].joints;
        let mut skin = node.skin().map(|skin| skin.index());
        if skin.is_some() && joints.is_empty() {
            warnings.add(item, "skin left out: the mesh has no joints and weights");
            skin = None;
        }
        let greatest = joints.iter().flatten().copied().max().unwrap_or(0);
        if let (Some(count), Some(_)) = (joint_count, skin)
            && usize::from(greatest) >= count
        {
            let problem = format!("a vertex names joint {greatest}, but the skin has {count}");
            return Err(invalid(warnings.file, item, problem, "export the skinned mesh again"));
        }
        let material = scene.meshes[*mesh].material;
        let name = name_of("node", node.index(), node.name());
        scene.instances.push(Instance { name, mesh: *mesh, node: node.index(), skin, transform, material });
        let count = scene.instances.len() as u64;
        at_most(warnings.file, item, count, MAX_INSTANCES, "instances", "merge meshes")?;
    }
    Ok(())
}

/// Candela as W/sr and lux as W/m2, one to one.
fn read_light(
    light: &gltf::khr_lights_punctual::Light<'_>,
    node: usize,
    global: Mat4,
    file: &Path,
) -> Result<Light, SceneError> {
    use gltf::khr_lights_punctual::Kind;
    let broken = |problem: String, mend: &str| {
        Err(invalid(file, label("light", light.index(), light.name()), problem, mend))
    };
    let strength = light.color().map(|color| color * light.intensity());
    if strength.iter().any(|value| !(*value >= 0.0 && value.is_finite())) {
        return broken(
            format!("its strength is {strength:?}"),
            "keep colour and intensity finite, not negative",
        );
    }
    if light.range().is_some_and(|range| !(range > 0.0 && range.is_finite())) {
        return broken(format!("its range is {:?}", light.range()), "state a positive range or none");
    }
    let position = global.w_axis.truncate().into();
    let direction = (-global.z_axis.truncate()).try_normalize().unwrap_or(Vec3::NEG_Z).into();
    let kind = match light.kind() {
        Kind::Point => LightKind::Point { position, intensity: strength, range: light.range() },
        Kind::Directional => LightKind::Directional { direction, irradiance: strength },
        Kind::Spot { inner_cone_angle: inner, outer_cone_angle: outer } => {
            if !(inner >= 0.0 && inner < outer && outer <= std::f32::consts::FRAC_PI_2 + 1e-4) {
                let mend = "keep 0 <= inner < outer <= pi / 2 radians";
                return broken(format!("its cone angles are {inner} and {outer}"), mend);
            }
            LightKind::Spot { position, direction, intensity: strength, range: light.range(), inner, outer }
        }
    };
    Ok(Light { name: name_of("light", light.index(), light.name()), node, kind })
}

/// A rigid camera; `None` if the node's axes vanish.
fn read_camera(camera: &gltf::Camera<'_>, global: Mat4, file: &Path) -> Result<Option<Camera>, SceneError> {
    use gltf::camera::Projection as FileProjection;
    let positive = |value: f32| value > 0.0 && value.is_finite();
    let (projection, sound) = match camera.projection() {
        FileProjection::Perspective(lens) => {
            let (near, far, vertical_angle) = (lens.znear(), lens.zfar(), lens.yfov());
            let sound = positive(near)
                && far.is_none_or(|far| far > near && far.is_finite())
                && vertical_angle > 0.0
                && vertical_angle < std::f32::consts::PI
                && lens.aspect_ratio().is_none_or(positive);
            (Projection::Perspective { vertical_angle, near, far, aspect: lens.aspect_ratio() }, sound)
        }
        FileProjection::Orthographic(lens) => {
            let (half_width, half_height) = (lens.xmag().abs(), lens.ymag().abs());
            let (near, far) = (lens.znear(), lens.zfar());
            let sound =
                positive(half_width) && positive(half_height) && near >= 0.0 && far > near && far.is_finite();
            (Projection::Orthographic { half_width, half_height, near, far }, sound)
        }
    };
    if !sound {
        let item = label("camera", camera.index(), camera.name());
        let mend = "keep 0 < near < far, angles in (0, pi) and extents positive";
        return Err(invalid(file, item, format!("its projection is {projection:?}"), mend));
    }
    let from = global.w_axis.truncate();
    let (up, back) = (global.y_axis.truncate(), global.z_axis.truncate());
    let name = name_of("camera", camera.index(), camera.name());
    Ok(Camera::oriented(&name, from, back, up, projection))
}
