//! A pose of the figure's first animation.

use airglow_scene::{ChannelValues, LocalTransform, Mesh, Scene};
use glam::{DMat4, Mat4, Quat, Vec3};

/// World from mesh for each joint of the first skin, at a time of the first animation, which loops.
pub fn joints(scene: &Scene, seconds: f32) -> Vec<DMat4> {
    let mut locals: Vec<LocalTransform> = scene.nodes.iter().map(|node| node.local).collect();
    for channel in scene.animations.iter().take(1).flat_map(|animation| &animation.channels) {
        let end = channel.times.last().copied().unwrap_or(1.0);
        let time = seconds.rem_euclid(end);
        let after = channel.times.partition_point(|key| *key <= time).clamp(1, channel.times.len() - 1);
        let t = (time - channel.times[after - 1]) / (channel.times[after] - channel.times[after - 1]);
        if let LocalTransform::Components { translation, rotation, .. } = &mut locals[channel.node] {
            match &channel.values {
                ChannelValues::Translation(keys) => {
                    *translation = Vec3::from(keys[after - 1]).lerp(Vec3::from(keys[after]), t);
                }
                ChannelValues::Rotation(keys) => {
                    *rotation = Quat::from_array(keys[after - 1]).slerp(Quat::from_array(keys[after]), t);
                }
                ChannelValues::Scale(_) => {}
            }
        }
    }
    let global = |node: usize| {
        let (mut matrix, mut at) = (locals[node].matrix(), scene.nodes[node].parent);
        while let Some(parent) = at {
            matrix = locals[parent].matrix() * matrix;
            at = scene.nodes[parent].parent;
        }
        matrix
    };
    let globals: Vec<Mat4> = (0..scene.nodes.len()).map(global).collect();
    scene.skins[0].joint_matrices(&globals).into_iter().map(|matrix| matrix.as_dmat4()).collect()
}

/// The positions of a mesh in a pose.
pub fn skinned(positions: &[[f32; 3]], mesh: &Mesh, joints: &[DMat4]) -> Vec<[f32; 3]> {
    let moved = |((position, by), weights): ((&[f32; 3], &[u16; 4]), &[f32; 4])| {
        let place = Vec3::from(*position).as_dvec3();
        let part = |(joint, weight): (&u16, &f32)| {
            f64::from(*weight) * joints[usize::from(*joint)].transform_point3(place)
        };
        by.iter().zip(weights).map(part).sum::<glam::DVec3>().as_vec3().to_array()
    };
    positions.iter().zip(&mesh.joints).zip(&mesh.weights).map(moved).collect()
}
