//! A scene at a moment: its figures in the pose of their animations.

use glam::{Mat4, Vec3};

use crate::animation::LocalTransform;
use crate::figure::Figure;
use crate::mesh::Mesh;
use crate::pose;
use crate::scene::{Instance, Scene};

impl Scene {
    /// World from node for every node of the scene, as `figure` moves them `seconds` after the scene's time 0.
    pub fn pose(&self, figure: &Figure, seconds: f32) -> Vec<Mat4> {
        let mut nodes = self.nodes.clone();
        if let Some(LocalTransform::Components { translation, rotation, .. }) =
            nodes.get_mut(figure.root).map(|node| &mut node.local)
        {
            *translation += *rotation * (seconds * Vec3::from(figure.velocity));
        }
        let animation = figure.animation.and_then(|index| self.animations.get(index));
        pose::globals(&nodes, animation, figure.time + seconds)
    }

    /// World from mesh for each joint of an instance in a pose, as [`crate::Mesh::posed`] takes it: one matrix for an
    /// instance without a skin.
    pub fn joints(&self, instance: &Instance, pose: &[Mat4]) -> Vec<Mat4> {
        match instance.skin.and_then(|skin| self.skins.get(skin)) {
            Some(skin) => skin.joint_matrices(pose),
            None => vec![pose.get(instance.node).copied().unwrap_or(Mat4::IDENTITY)],
        }
    }

    /// Puts the figures where they are `seconds` after the scene's time 0: their instances get posed meshes, which lie in
    /// the world and have neither joints nor tangents.
    pub fn set_time(&mut self, seconds: f32) {
        for figure in self.figures.clone() {
            let pose = self.pose(&figure, seconds);
            for (index, rest) in figure.instances.clone().zip(figure.meshes) {
                let (Some(instance), Some(mesh)) = (self.instances.get(index), self.meshes.get(rest)) else {
                    continue;
                };
                let (positions, normals) = mesh.posed(&self.joints(instance, &pose));
                let (uv0, indices) = (mesh.uv0.clone(), mesh.indices.clone());
                let (name, material) = (mesh.name.clone(), mesh.material);
                let mut posed = Mesh { name, positions, normals, uv0, indices, material, ..Mesh::default() };
                posed.hash = posed.content_hash();
                let instance = &mut self.instances[index];
                instance.transform = Mat4::IDENTITY;
                if instance.mesh == rest {
                    instance.mesh = self.meshes.len();
                    self.meshes.push(posed);
                } else {
                    self.meshes[instance.mesh] = posed;
                }
            }
        }
    }

    /// Whether an instance belongs to a figure.
    pub fn moves(&self, instance: usize) -> bool {
        self.figures.iter().any(|figure| figure.instances.contains(&instance))
    }
}
