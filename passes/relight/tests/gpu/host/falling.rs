//! Everything that can fall on the vertices of a mesh, at random, and how the GPU lights them by it.

#![expect(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

use airglow_relight::pack::ChunkLimits;
use airglow_relight::{Bench, Case, CaseLight, LightKind, MeshId, Relight, Settings};
use glam::DQuat;

use super::Numbers;

/// Light of the mesh and of each vertex, dynamic visibility of each vertex, turns of light and mesh.
pub struct Falling {
    pub light: Vec<[f32; 3]>,
    pub vertex_light: Vec<[f32; 3]>,
    pub visibility: Vec<f32>,
    pub turn: DQuat,
    pub rotation: DQuat,
}

impl Falling {
    pub fn new(numbers: &mut Numbers, order: usize, vertices: usize) -> Self {
        let count = order * order;
        let mut turn = || DQuat::from_xyzw(numbers.next(), numbers.next(), numbers.next(), numbers.next());
        let (turn, rotation) = (turn(), turn());
        Self {
            light: numbers.rgb(count),
            vertex_light: numbers.rgb(count * vertices),
            visibility: numbers.values(count * vertices),
            turn,
            rotation,
        }
    }

    /// What falls on a mesh under these settings.
    pub fn case(&self, settings: Settings, mesh: MeshId) -> Case<'_> {
        let light = match settings.light {
            LightKind::Uniform => CaseLight::Uniform(&self.light, self.turn),
            LightKind::Vertex => CaseLight::Vertices(&self.vertex_light),
        };
        let visibility = settings.visibility.then_some(&self.visibility[..]);
        Case { orientation: self.rotation.into(), visibility, ..Case::new(light, mesh) }
    }

    /// The results of a mesh of so many vertices, with vectors or with normals.
    pub fn run(
        &self,
        bench: &Bench<'_>,
        settings: Settings,
        limits: Option<&ChunkLimits>,
        vertices: usize,
        (vectors, normals): (Option<&[f32]>, Option<&[[f32; 3]]>),
    ) -> Vec<f32> {
        let mut relight = match limits {
            Some(limits) => Relight::with_chunk_limits(bench.context, settings, limits),
            None => Relight::new(bench.context, settings),
        }
        .unwrap();
        let mesh = relight.add_mesh(bench.context, "mesh", vertices as u32, vectors).unwrap();
        bench.results(&mut relight, &Case { normals, ..self.case(settings, mesh) }).unwrap()
    }
}
