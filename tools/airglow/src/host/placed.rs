//! The vertices of a scene as near emitters light them: all in the world, beside what each makes of its light.

use std::ops::ControlFlow;

use airglow::radiance::{Hierarchy, Part};
use airglow_scene::Scene;
use glam::DMat3;

use super::emitters;
use super::transfer::SceneTransfer;
use crate::failure::{Failure, Outcome};

/// What is lit, placed in the world.
pub struct Placed {
    /// Metres.
    pub positions: Vec<[f32; 3]>,
    /// Transfer vectors of as many bands as the scene's quality says, each about the axes of its part.
    pub vectors: Vec<f32>,
    /// The instances.
    pub parts: Vec<Part>,
}

impl Placed {
    /// All instances of a scene with their transfer; emitters reflect nothing.
    pub fn new(scene: &Scene, transfer: &SceneTransfer) -> Self {
        let (mut positions, mut vectors, mut parts) = (Vec::new(), Vec::new(), Vec::new());
        let surfaces = emitters::surfaces(scene);
        for (index, (instance, lit)) in scene.instances.iter().zip(&transfer.instances).enumerate() {
            let first = positions.len() as u32;
            let place = |p: &[f32; 3]| instance.transform.transform_point3((*p).into()).to_array();
            let mesh = &scene.meshes[instance.mesh].positions;
            let baked = &transfer.transfers[lit.transfer].coefficients;
            if index < surfaces {
                positions.extend(mesh.iter().map(place));
                vectors.extend_from_slice(baked);
            } else {
                // It reflects nothing, and must not widen the tree of what does.
                let anywhere = positions.first().copied().unwrap_or_default();
                positions.resize(positions.len() + mesh.len(), anywhere);
                vectors.resize(vectors.len() + baked.len(), 0.0);
            }
            let side = if lit.inverted { -1.0 } else { 1.0 };
            let turn = side * DMat3::from_quat(lit.rotation.conjugate());
            parts.push(Part { vertices: first..positions.len() as u32, turn: Some(turn) });
        }
        Self { positions, vectors, parts }
    }

    /// The tree over the vertices.
    pub fn tree(&self) -> Outcome<Hierarchy> {
        Hierarchy::build(&self.positions, &self.vectors, &mut |_, _| ControlFlow::Continue(()))
            .map_err(Failure::work)
    }
}
