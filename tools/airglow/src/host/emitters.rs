//! The scene's near emitters as things that are drawn, and as the triangles that the radiance pass samples.

use airglow::radiance::{Sphere, Triangle};
use airglow_scene::geometry::emitter;
use airglow_scene::{Emitter, EmitterShape, Instance, Material, Mesh, Scene};
use glam::{DVec3, Mat4, Vec3};

/// Puts every emitter into the scene as a mesh that glows and reflects nothing, after all other instances.
pub fn place(scene: &mut Scene) {
    for glowing in &scene.emitters {
        let mesh = mesh(glowing, scene.materials.len());
        scene.materials.push(Material {
            name: glowing.name.clone(),
            base_color: [0.0, 0.0, 0.0, 1.0],
            emissive: glowing.radiance,
            ..Material::default()
        });
        scene.instances.push(Instance {
            name: glowing.name.clone(),
            mesh: scene.meshes.len(),
            node: 0,
            skin: None,
            transform: Mat4::IDENTITY,
            material: mesh.material,
        });
        scene.meshes.push(mesh);
    }
}

/// Takes all emitters out of a scene again.
pub fn remove(scene: &mut Scene) {
    scene.instances.truncate(surfaces(scene));
    scene.emitters.clear();
}

/// Instances that are no emitters: the first ones.
pub fn surfaces(scene: &Scene) -> usize {
    scene.instances.len().saturating_sub(scene.emitters.len())
}

fn mesh(glowing: &Emitter, material: usize) -> Mesh {
    let (positions, indices) = emitter(glowing);
    let middle = Vec3::from(glowing.center);
    let normals = positions.iter().map(|p| (Vec3::from(*p) - middle).normalize_or(Vec3::Y).to_array());
    let name = glowing.name.clone();
    let mut mesh = Mesh { name, normals: normals.collect(), positions, indices, material, ..Mesh::default() };
    mesh.hash = mesh.content_hash();
    mesh
}

/// How far an emitter has moved when all are at `part` of their ways, metres.
pub fn offset(emitter: &Emitter, part: f32) -> Vec3 {
    let center = Vec3::from(emitter.center);
    emitter.to.map_or(Vec3::ZERO, |to| part * (Vec3::from(to) - center))
}

/// All emitters in the world as the pass takes them, at `part` of their ways: boxes as triangles, spheres as such.
pub fn shapes(emitters: &[Emitter], part: f32) -> (Vec<Triangle>, Vec<Sphere>) {
    let sphere = |glowing: &Emitter| match glowing.shape {
        EmitterShape::Sphere { radius } => Some(Sphere {
            centre: (Vec3::from(glowing.center) + offset(glowing, part)).as_dvec3(),
            radius: f64::from(radius),
            radiance: DVec3::from(glowing.radiance.map(f64::from)),
        }),
        EmitterShape::Box { .. } => None,
    };
    let boxes = emitters.iter().filter(|glowing| sphere(glowing).is_none());
    (triangles(&boxes.cloned().collect::<Vec<_>>(), part), emitters.iter().filter_map(sphere).collect())
}

/// The triangles of all emitters in the world, at `part` of their ways.
pub fn triangles(emitters: &[Emitter], part: f32) -> Vec<Triangle> {
    let emitted = |glowing: &Emitter| {
        let center = (Vec3::from(glowing.center) + offset(glowing, part)).to_array();
        let (positions, indices) = emitter(&Emitter { center, ..glowing.clone() });
        let corner = |i: &u32| DVec3::from(positions[*i as usize].map(f64::from));
        let radiance = DVec3::from(glowing.radiance.map(f64::from));
        let triangle =
            |i: &[u32]| Triangle { corners: [corner(&i[0]), corner(&i[1]), corner(&i[2])], radiance };
        indices.chunks_exact(3).map(triangle).collect::<Vec<_>>()
    };
    emitters.iter().flat_map(emitted).collect()
}
