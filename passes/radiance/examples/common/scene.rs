//! Receivers and emitters of scene files.

use std::ops::ControlFlow;
use std::path::Path;

use airglow_bake::{Mesh, Occluders, Settings, Silent, Threads, bake, unshadowed};
use airglow_radiance::{Hierarchy, Triangle};
use airglow_scene::{Instance, Scene, Shadow, geometry};
use glam::DVec3;

/// Whatever stops an example.
pub type Failure = Box<dyn std::error::Error>;

/// What a scene file lights, all of it in the world.
pub struct Placed {
    pub positions: Vec<[f32; 3]>,
    pub indices: Vec<u32>,
    /// Transfer vectors with the shadows that the file asks for.
    pub transfer: Vec<f32>,
    pub emitters: Vec<Triangle>,
    pub tree: Hierarchy,
    pub order: usize,
}

impl Placed {
    /// Loads `assets/scenes/NAME.toml`; `None` where it needs `data`, a file that is not here.
    pub fn load(name: &str, data: Option<&str>) -> Result<Option<Self>, Failure> {
        if data.is_some_and(|data| airglow_tests::data::find(data).is_none()) {
            return Ok(None);
        }
        let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenes");
        let folder = airglow_tests::data::folder();
        let scene = airglow_scene::load_with_data(&assets.join(format!("{name}.toml")), Some(&folder))?;
        let order = scene.quality.order as usize;
        let (mut positions, mut indices, mut transfer) = (Vec::new(), Vec::new(), Vec::new());
        for instance in &scene.instances {
            let first = positions.len() as u32;
            let mesh = &scene.meshes[instance.mesh];
            let place = |p: &[f32; 3]| instance.transform.transform_point3((*p).into()).to_array();
            positions.extend(mesh.positions.iter().map(place));
            indices.extend(mesh.indices.iter().map(|index| first + index));
            transfer.extend(vectors(&scene, instance, order)?);
        }
        let tree = Hierarchy::build(&positions, &transfer, &mut |_, _| ControlFlow::Continue(()))?;
        Ok(Some(Self { positions, indices, transfer, emitters: emitters(&scene), tree, order }))
    }

    /// A vertex, metres.
    pub fn point(&self, vertex: usize) -> DVec3 {
        DVec3::from(self.positions[vertex].map(f64::from))
    }

    /// All vertices.
    pub fn points(&self) -> Vec<DVec3> {
        (0..self.positions.len()).map(|vertex| self.point(vertex)).collect()
    }

    /// The colour of a vertex in a light.
    pub fn colour(&self, vertex: usize, light: &[DVec3]) -> DVec3 {
        let transfer = &self.transfer[vertex * light.len()..][..light.len()];
        transfer.iter().zip(light).map(|(t, l)| f64::from(*t) * *l).sum()
    }
}

/// The transfer of an instance, shadowed by nothing or by itself.
fn vectors(scene: &Scene, instance: &Instance, order: usize) -> Result<Vec<f32>, Failure> {
    let mesh = &scene.meshes[instance.mesh];
    let view =
        Mesh { name: &mesh.name, positions: &mesh.positions, normals: &mesh.normals, indices: &mesh.indices };
    if scene.quality.shadow == Shadow::Unshadowed {
        return Ok(unshadowed(&view, instance.transform, order)?.transfer.coefficients);
    }
    let occluders = Occluders::build(&[view.occluder_at(instance.transform)])?;
    let settings = Settings { order, rays: scene.quality.rays, ..Settings::default() };
    let threads = Threads::new(std::thread::available_parallelism()?.get());
    Ok(bake(&view, instance.transform, &occluders, &settings, &threads, &mut Silent)?.transfer.coefficients)
}

/// The triangles of all emitters.
pub fn emitters(scene: &Scene) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for emitter in &scene.emitters {
        let (positions, indices) = geometry::emitter(emitter);
        let corner = |index: u32| DVec3::from(positions[index as usize].map(f64::from));
        let radiance = DVec3::from(emitter.radiance.map(f64::from));
        let triangle = |i: &[u32]| Triangle { corners: [corner(i[0]), corner(i[1]), corner(i[2])], radiance };
        triangles.extend(indices.chunks_exact(3).map(triangle));
    }
    triangles
}
