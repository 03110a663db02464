//! Nodes, skins and animations as glTF has them; `pose` plays them.

use glam::{Mat4, Quat, Vec3};

/// A node of the transform tree. Parents may stand after their children.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The file's name, or `node N`.
    pub name: String,
    /// Index of the parent in [`crate::Scene::nodes`].
    pub parent: Option<usize>,
    /// Parent from node.
    pub local: LocalTransform,
    /// World from node, at rest.
    pub global: Mat4,
}

/// A node's transform relative to its parent; only components can be animated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LocalTransform {
    /// Scale first, then rotation, then translation.
    Components {
        /// Metres.
        translation: Vec3,
        /// Unit quaternion.
        rotation: Quat,
        /// Along the node's own axes.
        scale: Vec3,
    },
    /// Any affine map.
    Matrix(Mat4),
}

impl LocalTransform {
    /// The transform as one matrix.
    pub fn matrix(&self) -> Mat4 {
        match *self {
            Self::Components { translation, rotation, scale } => {
                Mat4::from_scale_rotation_translation(scale, rotation, translation)
            }
            Self::Matrix(matrix) => matrix,
        }
    }
}

/// The joints that move a skinned mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Skin {
    /// The file's name, or `skin N`.
    pub name: String,
    /// Nodes that [`crate::Mesh::joints`] index.
    pub joints: Vec<usize>,
    /// Joint from mesh in the bind pose, one for each joint.
    pub inverse_bind: Vec<Mat4>,
}

impl Skin {
    /// World from mesh for each joint: global transform of the joint times its inverse bind matrix.
    ///
    /// `globals` holds world from node for every node of the scene; a joint beyond its end gets the identity
    /// as its global transform. The transform of the node that carries the mesh plays no part (glTF 2.0, 3.7.3.3).
    pub fn joint_matrices(&self, globals: &[Mat4]) -> Vec<Mat4> {
        let global = |joint: &usize| globals.get(*joint).copied().unwrap_or(Mat4::IDENTITY);
        self.joints.iter().zip(&self.inverse_bind).map(|(joint, bind)| global(joint) * *bind).collect()
    }
}

/// A named set of keyframes.
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    /// The file's name, or `animation N`.
    pub name: String,
    /// What it moves.
    pub channels: Vec<Channel>,
}

/// The keyframes of one property of one node.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Index into [`crate::Scene::nodes`].
    pub node: usize,
    /// How values between keyframes are found.
    pub interpolation: Interpolation,
    /// Seconds, strictly growing, not negative.
    pub times: Vec<f32>,
    /// One value for each time; for [`Interpolation::CubicSpline`] three: in-tangent, value, out-tangent.
    pub values: ChannelValues,
}

/// How values between keyframes are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Linearly; rotations along the great circle.
    Linear,
    /// The last keyframe holds.
    Step,
    /// Cubic Hermite splines.
    CubicSpline,
}

/// The property that a [`Channel`] moves, with its values.
#[derive(Clone, Debug, PartialEq)]
pub enum ChannelValues {
    /// Metres.
    Translation(Vec<[f32; 3]>),
    /// Quaternions x, y, z, w.
    Rotation(Vec<[f32; 4]>),
    /// Along the node's own axes.
    Scale(Vec<[f32; 3]>),
}
