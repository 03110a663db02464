//! The scene: everything that was read, as plain data.

use glam::{Mat4, Vec3};

use crate::animation::{Animation, Node, Skin};
use crate::camera::{Camera, Sphere};
use crate::environment::Environment;
use crate::exposure::Exposure;
use crate::figure::Figure;
use crate::image::Image;
use crate::light::{Blocker, Emitter, Light, Medium};
use crate::limits::MAX_COORDINATE;
use crate::material::Material;
use crate::mesh::Mesh;
use crate::presets::Presets;
use crate::settings::Quality;
use crate::warning::Warning;

/// Everything that a scene file or a glTF file holds. World space: metres, right-handed, +Y up.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// One for each glTF primitive, shared by its instances.
    pub meshes: Vec<Mesh>,
    /// Meshes placed in the world.
    pub instances: Vec<Instance>,
    /// Surfaces: those of the files, [`Material::default`] for primitives that name none, and those that a scene
    /// file states.
    pub materials: Vec<Material>,
    /// Decoded textures; an image used both as colour and as data stands here twice.
    pub images: Vec<Image>,
    /// Point, spot and directional lights.
    pub lights: Vec<Light>,
    /// Cameras of the files.
    pub cameras: Vec<Camera>,
    /// Transform tree.
    pub nodes: Vec<Node>,
    /// Skins of the instances.
    pub skins: Vec<Skin>,
    /// Animations of the nodes.
    pub animations: Vec<Animation>,
    /// What moves by itself.
    pub figures: Vec<Figure>,
    /// Distant light.
    pub environment: Option<Environment>,
    /// What fills the space between the surfaces.
    pub medium: Option<Medium>,
    /// Glowing spheres and boxes near the surfaces.
    pub emitters: Vec<Emitter>,
    /// Spheres that only cast shadows.
    pub blockers: Vec<Blocker>,
    /// The camera that the scene file makes or names; see [`Scene::camera`].
    pub chosen_camera: Option<Camera>,
    /// From scene-linear values to the display.
    pub exposure: Exposure,
    /// What the light transport is computed with.
    pub quality: Quality,
    /// How exactly each room is to work.
    pub presets: Presets,
    /// What was left out or mended.
    pub warnings: Vec<Warning>,
}

/// A mesh placed in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// Name of the node.
    pub name: String,
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// Index into [`Scene::nodes`].
    pub node: usize,
    /// Index into [`Scene::skins`]. A skinned mesh follows its joints and not its node.
    pub skin: Option<usize>,
    /// World from object, invertible. For a skinned mesh it shows the bind pose.
    pub transform: Mat4,
    /// Index into [`Scene::materials`]: the mesh's own, unless a scene file overrides it.
    pub material: usize,
}

impl Instance {
    /// The transform turns the mesh inside out: the winding of its triangles is reversed in the world.
    pub fn is_mirrored(&self) -> bool {
        self.transform.determinant() < 0.0
    }

    /// The uniform scale and true, or false if the transform scales its axes unequally or shears
    /// (by more than a thousandth).
    pub fn is_uniformly_scaled(&self) -> bool {
        let columns = [self.transform.x_axis, self.transform.y_axis, self.transform.z_axis];
        let [x, y, z] = columns.map(|column| column.truncate());
        let squared = x.length_squared();
        let close = |value: f32, target: f32| (value - target).abs() <= 1e-3 * squared;
        close(y.length_squared(), squared)
            && close(z.length_squared(), squared)
            && close(x.dot(y), 0.0)
            && close(y.dot(z), 0.0)
            && close(z.dot(x), 0.0)
    }
}

impl Scene {
    /// The camera to render from: the scene file's, else the first of the files, else one that frames the scene.
    pub fn camera(&self) -> Camera {
        let stated = self.chosen_camera.as_ref().or(self.cameras.first());
        stated.cloned().unwrap_or_else(|| {
            Camera::framing(self.bounding_sphere().unwrap_or(Sphere { center: [0.0; 3], radius: 1.0 }))
        })
    }

    /// A sphere around the middle of the bounding box that holds every vertex of every instance.
    /// `None` without instances.
    pub fn bounding_sphere(&self) -> Option<Sphere> {
        let (low, high) = self.bounding_box()?;
        let center = 0.5 * (Vec3::from(low) + Vec3::from(high));
        let squared =
            self.world_positions().map(|position| position.distance_squared(center)).fold(0.0, f32::max);
        Some(Sphere { center: center.into(), radius: squared.sqrt() })
    }

    /// The smallest and largest coordinates of every vertex of every instance, metres. `None` without instances.
    pub fn bounding_box(&self) -> Option<([f32; 3], [f32; 3])> {
        let mut positions = self.world_positions();
        let first = positions.next()?;
        let (low, high) =
            positions.fold((first, first), |(low, high), position| (low.min(position), high.max(position)));
        Some((low.into(), high.into()))
    }

    /// The first instance with a vertex that is not within [`MAX_COORDINATE`] of the origin along each axis.
    pub(crate) fn find_far_instance(&self) -> Option<&Instance> {
        self.instances.iter().find(|instance| {
            let near = |position: Vec3| position.to_array().iter().all(|x| x.abs() <= MAX_COORDINATE);
            self.positions_of(instance).any(|position| !near(position))
        })
    }

    fn world_positions(&self) -> impl Iterator<Item = Vec3> {
        self.instances.iter().flat_map(|instance| self.positions_of(instance))
    }

    fn positions_of<'a>(&'a self, instance: &'a Instance) -> impl Iterator<Item = Vec3> + 'a {
        let positions = self.meshes.get(instance.mesh).map_or(&[][..], |mesh| &mesh.positions);
        positions.iter().map(|position| instance.transform.transform_point3(Vec3::from(*position)))
    }
}
