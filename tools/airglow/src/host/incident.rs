//! Light from all around on surfaces with normal maps: the incident radiance of their vertices, by the relight pass once more.

use airglow::relight::{
    Frame, GraphFrame, Instance, Light, MeshId, Orientation, Output, Relight, Relit, Rotations,
};
use airglow_gpu::{Context, Imports, Record};
use airglow_graph::{Buffer, Graph, Handle};
use airglow_scene::Scene;
use glam::DQuat;

use super::draw::VertexArray;
use super::transfer::SceneTransfer;
use super::{needed, relight};
use crate::failure::{Failure, Outcome};

/// The pass with the vertices of all instances that have a normal map.
pub struct Incident {
    relight: Relight,
    /// Instances of the scene, and their visibility.
    instances: Vec<(usize, MeshId)>,
    /// Instances of the scene.
    count: usize,
}

/// Bytes of a vertex's coefficients.
pub fn vertex_bytes(scene: &Scene) -> u32 {
    12 * scene.quality.order * scene.quality.order
}

impl Incident {
    /// The pass for the instances of a scene that have maps to be drawn, where there are some.
    pub fn new(context: &Context, scene: &Scene, transfer: &SceneTransfer) -> Outcome<Option<Self>> {
        let instances: Vec<usize> =
            (0..scene.instances.len()).filter(|number| needed::incident_on(scene, *number)).collect();
        if instances.is_empty() {
            return Ok(None);
        }
        let settings = airglow::relight::Settings {
            output: Output::Incident,
            normals: false,
            ..relight::settings(scene)
        };
        let mut relight = Relight::new(context, settings).map_err(Failure::work)?;
        let mut meshes: Vec<Option<MeshId>> = vec![None; transfer.transfers.len()];
        let mut placed = Vec::with_capacity(instances.len());
        for number in instances {
            let index = transfer.instances[number].transfer;
            let mesh = match meshes[index] {
                Some(mesh) => mesh,
                None => {
                    let (baked, account) = (&transfer.transfers[index], &transfer.accounts[index]);
                    let seen = baked.visibility.as_deref();
                    let count = baked.vertex_count as u32;
                    relight.add_mesh(context, &account.name, count, seen).map_err(Failure::work)?
                }
            };
            meshes[index] = Some(mesh);
            placed.push((number, mesh));
        }
        Ok(Some(Self { relight, instances: placed, count: scene.instances.len() }))
    }

    /// Adds the pass after that of the colours, whose light and shadows it takes.
    pub fn add(
        &mut self,
        context: &Context,
        graph: &mut Graph<Record>,
        imports: &mut Imports,
        colours: &GraphFrame,
        relit: &Relit<Handle<Buffer>>,
        filter: Option<&[[f64; 3]]>,
    ) -> Outcome<(Option<VertexArray>, Option<Rotations>)> {
        // The environment is projected once for both.
        let light = match (&colours.light, relit.environment) {
            (Light::Environment(environment), Some(coefficients)) => {
                Light::Uniform { coefficients, rotation: environment.rotation }
            }
            (Light::Vertices, _) => Light::Vertices,
            _ => Light::None,
        };
        let instance =
            |&(number, mesh): &(usize, MeshId)| Instance { mesh, normals: None, ..colours.instances[number] };
        let frame = Frame { light, instances: self.instances.iter().map(instance).collect(), target: None };
        let radiance = self.relight.add(context, graph, imports, &frame).map_err(Failure::work)?;
        if let (Some(rotations), Some(factors)) = (&radiance.rotations, filter) {
            rotations.set_filter(factors).map_err(Failure::work)?;
        }
        let mut ranges = vec![(0, 0); self.count];
        for ((number, _), range) in self.instances.iter().zip(&radiance.ranges) {
            ranges[*number] = (range.offset, range.size);
        }
        Ok((radiance.results.map(|buffer| VertexArray { buffer, ranges }), radiance.rotations))
    }

    /// Turns the light of a declared frame; `all` are the orientations of the scene's instances.
    pub fn turn(&self, rotations: &Rotations, light: DQuat, all: &[Orientation]) -> Outcome {
        let ours: Vec<_> = self.instances.iter().map(|(number, _)| all[*number]).collect();
        rotations.set(light, &ours).map_err(Failure::work)
    }
}
