//! Animations played and skins applied, as glTF 2.0 says it (sections 3.7.3.3 and 3.11, appendix C).

use glam::{Mat3, Mat4, Quat, Vec3};

use crate::animation::{Animation, Channel, ChannelValues, Interpolation, LocalTransform, Node};
use crate::mesh::Mesh;

impl Animation {
    /// Seconds from 0 to the last keyframe.
    pub fn duration(&self) -> f32 {
        let last = self.channels.iter().filter_map(|channel| channel.times.last());
        last.copied().fold(0.0, f32::max)
    }
}

/// World from node for every node, at `seconds` of an animation, which loops; at rest without one. A parent that is not
/// there, and a circle of parents, end the chain.
pub(crate) fn globals(nodes: &[Node], animation: Option<&Animation>, seconds: f32) -> Vec<Mat4> {
    let mut locals: Vec<LocalTransform> = nodes.iter().map(|node| node.local).collect();
    if let Some(animation) = animation {
        let duration = animation.duration();
        let time = if duration > 0.0 { seconds.rem_euclid(duration) } else { 0.0 };
        for channel in &animation.channels {
            if let Some(local) = locals.get_mut(channel.node) {
                channel.apply(time, local);
            }
        }
    }
    let global = |node: usize| {
        let (mut matrix, mut parent) = (locals[node].matrix(), nodes[node].parent);
        for _ in 0..nodes.len() {
            let Some((at, local)) = parent.and_then(|at| Some((at, locals.get(at)?))) else { break };
            matrix = local.matrix() * matrix;
            parent = nodes[at].parent;
        }
        matrix
    };
    (0..nodes.len()).map(global).collect()
}

/// Between two keyframes: indices of both, where between them from 0 to 1, and the seconds from one to the other.
struct Place {
    before: usize,
    after: usize,
    t: f32,
    span: f32,
}

impl Channel {
    /// Sets what the channel moves of a transform; a matrix cannot be moved.
    fn apply(&self, time: f32, local: &mut LocalTransform) {
        let LocalTransform::Components { translation, rotation, scale } = local else { return };
        match &self.values {
            ChannelValues::Translation(keys) => set(translation, self.vector(keys, time)),
            ChannelValues::Scale(keys) => set(scale, self.vector(keys, time)),
            ChannelValues::Rotation(keys) => set(rotation, self.rotation(keys, time)),
        }
    }

    fn place(&self, time: f32) -> Option<Place> {
        let last = self.times.len().checked_sub(1)?;
        let after = self.times.partition_point(|key| *key <= time).min(last);
        let before = if self.times[after] <= time { after } else { after.saturating_sub(1) };
        let span = self.times[after] - self.times[before];
        let t = if span > 0.0 { ((time - self.times[before]) / span).clamp(0.0, 1.0) } else { 0.0 };
        Some(Place { before, after, t, span })
    }

    fn vector(&self, keys: &[[f32; 3]], time: f32) -> Option<Vec3> {
        let place = self.place(time)?;
        let key = |index: usize| keys.get(index).copied().map(Vec3::from);
        match self.interpolation {
            Interpolation::Step => key(place.before),
            Interpolation::Linear => Some(key(place.before)?.lerp(key(place.after)?, place.t)),
            Interpolation::CubicSpline => {
                let [a, b, c, d] = place.hermite().map(|(index, weight)| Some(weight * key(index)?));
                Some(a? + b? + c? + d?)
            }
        }
    }

    fn rotation(&self, keys: &[[f32; 4]], time: f32) -> Option<Quat> {
        let place = self.place(time)?;
        let key = |index: usize| keys.get(index).copied().map(Quat::from_array);
        let turned = match self.interpolation {
            Interpolation::Step => key(place.before)?,
            Interpolation::Linear => {
                key(place.before)?.normalize().slerp(key(place.after)?.normalize(), place.t)
            }
            Interpolation::CubicSpline => {
                let [a, b, c, d] = place.hermite().map(|(index, weight)| Some(key(index)? * weight));
                a? + b? + c? + d?
            }
        };
        // A broken rotation leaves the node as it is.
        (turned.is_finite() && turned.length_squared() > 0.0).then(|| turned.normalize())
    }
}

impl Place {
    /// Values and tangents of a cubic Hermite spline and their weights, by index among in-tangent, value, out-tangent of
    /// all keys.
    fn hermite(&self) -> [(usize, f32); 4] {
        let Self { before, after, t, span } = *self;
        let (t2, t3) = (t * t, t * t * t);
        [
            (3 * before + 1, 2.0 * t3 - 3.0 * t2 + 1.0),
            (3 * before + 2, span * (t3 - 2.0 * t2 + t)),
            (3 * after + 1, 3.0 * t2 - 2.0 * t3),
            (3 * after, span * (t3 - t2)),
        ]
    }
}

fn set<T>(place: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *place = value;
    }
}

impl Mesh {
    /// Positions and unit normals in the world, by linear blend skinning with `world_from_mesh` of each joint; of a mesh
    /// without joints all vertices follow the first matrix. A joint that is not there moves nothing.
    pub fn posed(&self, world_from_mesh: &[Mat4]) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
        let posed = |vertex: usize| {
            let matrix = self.blended(vertex, world_from_mesh);
            let normal = self.normals.get(vertex).map_or(Vec3::Y, |normal| Vec3::from(*normal));
            let position = matrix.transform_point3(Vec3::from(self.positions[vertex]));
            let normal = (cofactor(Mat3::from_mat4(matrix)) * normal).normalize_or_zero();
            (position.to_array(), normal.to_array())
        };
        (0..self.positions.len()).map(posed).unzip()
    }

    fn blended(&self, vertex: usize, matrices: &[Mat4]) -> Mat4 {
        match (self.joints.get(vertex), self.weights.get(vertex)) {
            (Some(joints), Some(weights)) => {
                let matrix = |joint: u16| matrices.get(usize::from(joint)).copied().unwrap_or(Mat4::ZERO);
                joints.iter().zip(weights).map(|(joint, weight)| matrix(*joint) * *weight).sum()
            }
            _ => matrices.first().copied().unwrap_or(Mat4::IDENTITY),
        }
    }
}

/// What normals are turned by: the transposed inverse times the size of the determinant, which is there for flat matrices
/// too.
fn cofactor(matrix: Mat3) -> Mat3 {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let side = if matrix.determinant() < 0.0 { -1.0 } else { 1.0 };
    Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * side
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channel(interpolation: Interpolation, times: &[f32], values: ChannelValues) -> Animation {
        let channel = Channel { node: 0, interpolation, times: times.to_vec(), values };
        Animation { name: String::new(), channels: vec![channel] }
    }

    fn nodes() -> Vec<Node> {
        let local = |translation| LocalTransform::Components {
            translation,
            rotation: Quat::IDENTITY,
            scale: Vec3::ONE,
        };
        let node = |parent, translation| Node {
            name: String::new(),
            parent,
            local: local(translation),
            global: Mat4::IDENTITY,
        };
        // The child stands before nothing; the last two are each other's parents.
        vec![node(None, Vec3::ZERO), node(Some(0), Vec3::X), node(Some(3), Vec3::Z), node(Some(2), Vec3::Z)]
    }

    fn at(animation: &Animation, seconds: f32) -> Vec3 {
        globals(&nodes(), Some(animation), seconds)[1].transform_point3(Vec3::ZERO)
    }

    #[test]
    fn keys_are_joined_as_they_say_and_animations_loop() {
        let keys = || ChannelValues::Translation(vec![[0.0; 3], [0.0, 2.0, 0.0], [0.0, 4.0, 0.0]]);
        let linear = channel(Interpolation::Linear, &[0.0, 1.0, 3.0], keys());
        assert_eq!(linear.duration(), 3.0);
        for (seconds, y) in [(0.0, 0.0), (0.5, 1.0), (2.0, 3.0), (3.5, 1.0), (-1.0, 3.0)] {
            assert!((at(&linear, seconds) - Vec3::new(1.0, y, 0.0)).length() < 1e-6, "{seconds}: {y}");
        }
        let step = channel(Interpolation::Step, &[0.0, 1.0, 3.0], keys());
        assert_eq!(at(&step, 2.9).y, 2.0);
        // One key, and a time before the first: both hold.
        let one = channel(Interpolation::Linear, &[2.0], ChannelValues::Translation(vec![[0.0, 5.0, 0.0]]));
        assert_eq!([at(&one, 0.1).y, at(&one, 1.9).y], [5.0; 2]);
    }

    #[test]
    fn a_spline_has_the_values_and_slopes_of_its_keys() {
        let y = |y: f32| [0.0, y, 0.0];
        let values = vec![y(9.0), y(1.0), y(3.0), y(-1.0), y(2.0), y(9.0)];
        let spline = channel(Interpolation::CubicSpline, &[0.0, 2.0], ChannelValues::Translation(values));
        let slope = |at_: f32| (at(&spline, at_ + 1e-2).y - at(&spline, at_).y) / 1e-2;
        assert!((at(&spline, 0.0).y - 1.0).abs() < 1e-6 && (slope(0.0) - 3.0).abs() < 0.05);
        assert!((at(&spline, 1.9999).y - 2.0).abs() < 1e-3 && (slope(1.985) + 1.0).abs() < 0.05);
    }

    #[test]
    fn a_turned_joint_takes_positions_and_normals_along() {
        let end = Quat::from_rotation_z(2.0).to_array();
        let turn = channel(
            Interpolation::Linear,
            &[0.0, 1.0],
            ChannelValues::Rotation(vec![Quat::IDENTITY.to_array(), end]),
        );
        let matrices = globals(&nodes(), Some(&turn), 0.5);
        assert!(matrices[2].is_finite() && matrices[3].is_finite(), "a circle of parents ends");
        let mut mesh = Mesh {
            positions: vec![[1.0, 0.0, 0.0]; 3],
            normals: vec![[1.0, 0.0, 0.0]; 3],
            joints: vec![[0, 0, 0, 0], [0, 9, 0, 0], [0; 4]],
            weights: vec![[1.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0], [0.0; 4]],
            ..Mesh::default()
        };
        let (positions, normals) = mesh.posed(&matrices);
        let turned = Vec3::new(1.0_f32.cos(), 1.0_f32.sin(), 0.0);
        assert!((Vec3::from(positions[0]) - turned).length() < 1e-6, "{positions:?}");
        assert!((Vec3::from(normals[1]) - turned).length() < 1e-6, "{normals:?}");
        assert_eq!((positions[2], normals[2]), ([0.0; 3], [0.0; 3]), "no weights: finite all the same");
        (mesh.joints, mesh.weights) = (Vec::new(), Vec::new());
        let mirrored = Mat4::from_scale(Vec3::new(1.0, -1.0, 2.0));
        assert_eq!(mesh.posed(&[mirrored]).1[0], [1.0, 0.0, 0.0], "outwards stays outwards");
        let flat = Mat4::from_scale(Vec3::new(2.0, 0.0, 1.0));
        let (positions, normals) = mesh.posed(&[flat]);
        assert_eq!((positions[0], normals[0]), ([2.0, 0.0, 0.0], [0.0; 3]), "{normals:?}");
    }
}
