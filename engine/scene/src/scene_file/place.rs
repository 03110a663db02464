//! Puts what glTF files hold into one scene: arrays once for each file, instances once for each placement.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use glam::{Mat4, Vec3};

use super::placed::Placed;
use crate::animation::{LocalTransform, Node};
use crate::camera::Camera;
use crate::error::{SceneError, at_most, invalid};
use crate::geometry::subdivide;
use crate::gltf_file;
use crate::light::LightKind;
use crate::limits::{MAX_INSTANCES, MAX_VERTICES};
use crate::material::Texture;
use crate::scene::{Instance, Scene};
use crate::warning::Warning;

/// What names of files begin with that lie in the folder of data.
const DATA: &str = "data:";

/// The scene so far and the files it was filled from.
pub(super) struct Builder<'a> {
    pub(super) file: &'a Path,
    pub(super) scene: Scene,
    /// Where files named `data:…` lie.
    data: Option<&'a Path>,
    /// By path and how often they are subdivided.
    sources: HashMap<(PathBuf, u32), Scene>,
}

impl<'a> Builder<'a> {
    pub(super) fn new(file: &'a Path, data: Option<&'a Path>) -> Self {
        Self { file, scene: Scene::default(), data, sources: HashMap::new() }
    }

    /// Places a whole file: meshes, lights, cameras, skins and animations.
    pub(super) fn place_file(&mut self, entry: &Placed) -> Result<(), SceneError> {
        let key = self.load(entry)?;
        let Some(source) = self.sources.get(&key) else { return Ok(()) };
        let source = source.clone();
        let placement = entry.transform();
        let material = self.override_material(entry);
        let root = self.push_root(entry);
        let (first_node, first_skin) = (self.scene.nodes.len(), self.scene.skins.len());
        for node in source.nodes {
            let parent = Some(node.parent.map_or(root, |parent| parent + first_node));
            self.scene.nodes.push(Node { parent, global: placement * node.global, ..node });
        }
        for mut skin in source.skins {
            skin.joints.iter_mut().for_each(|joint| *joint += first_node);
            self.scene.skins.push(skin);
        }
        for mut animation in source.animations {
            animation.channels.iter_mut().for_each(|channel| channel.node += first_node);
            self.scene.animations.push(animation);
        }
        for instance in source.instances {
            self.scene.instances.push(Instance {
                node: instance.node + first_node,
                skin: instance.skin.map(|skin| skin + first_skin),
                transform: placement * instance.transform,
                material: material.unwrap_or(instance.material),
                ..instance
            });
        }
        for mut light in source.lights {
            light.node += first_node;
            light.kind = place_light(light.kind, placement);
            self.scene.lights.push(light);
        }
        self.scene.cameras.extend(source.cameras.iter().filter_map(|camera| place_camera(camera, placement)));
        self.check_count()
    }

    /// Places the meshes of a file, or those named `entry.mesh` without their nodes' transforms. Returns how many.
    pub(super) fn place_meshes(&mut self, entry: &Placed) -> Result<usize, SceneError> {
        let key = self.load(entry)?;
        let Some(source) = self.sources.get(&key) else { return Ok(0) };
        let mut instances = source.instances.clone();
        let placement = entry.transform();
        if let Some(wanted) = &entry.mesh {
            // Each mesh once, however often the file places it.
            instances.sort_by_key(|instance| instance.mesh);
            instances.dedup_by_key(|instance| instance.mesh);
            instances.retain(|instance| {
                let name = &self.scene.meshes[instance.mesh].name;
                name == wanted.get_ref()
                    || name.rsplit_once('/').is_some_and(|(name, _)| name == wanted.get_ref())
            });
            instances.iter_mut().for_each(|instance| instance.transform = Mat4::IDENTITY);
        }
        if instances.iter().any(|instance| instance.skin.is_some()) {
            self.warn(entry, "skins left out: only [[gltf]] keeps them; the bind pose is placed");
        }
        let material = self.override_material(entry);
        let root = self.push_root(entry);
        let count = instances.len();
        for instance in instances {
            self.scene.instances.push(Instance {
                node: root,
                skin: None,
                transform: placement * instance.transform,
                material: material.unwrap_or(instance.material),
                ..instance
            });
        }
        self.check_count()?;
        Ok(count)
    }

    pub(super) fn warn(&mut self, entry: &Placed, message: &str) {
        let item = format!("{}", entry.file.display());
        self.scene.warnings.push(Warning { file: self.file.to_path_buf(), item, message: message.into() });
    }

    /// The path of a file named relative to the scene file.
    pub(super) fn resolve(&self, named: &Path) -> PathBuf {
        self.file.parent().unwrap_or(Path::new("")).join(named)
    }

    /// The path of a glTF file, which may lie in the folder of data.
    fn resolve_model(&self, named: &Path) -> Result<PathBuf, SceneError> {
        let Some(name) = named.to_str().and_then(|named| named.strip_prefix(DATA)) else {
            return Ok(self.resolve(named));
        };
        let Some(folder) = self.data else {
            let problem = "the file is not shipped, and no folder of data was given".to_owned();
            let mend = "set AIRGLOW_DATA to a folder that has it, or load with one";
            return Err(invalid(self.file, named.display().to_string(), problem, mend));
        };
        Ok(folder.join(name))
    }

    /// Loads the file of `entry` unless it is there, and moves its arrays into the scene.
    fn load(&mut self, entry: &Placed) -> Result<(PathBuf, u32), SceneError> {
        let key = (self.resolve_model(&entry.file)?, entry.subdivide.0);
        if self.sources.contains_key(&key) {
            return Ok(key);
        }
        let mut source = gltf_file::load(&key.0)?;
        for _ in 0..key.1 {
            self.subdivide(entry, &mut source)?;
        }
        let scene = &mut self.scene;
        let (first_mesh, first_material) = (scene.meshes.len(), scene.materials.len());
        let first_image = scene.images.len();
        for mut mesh in source.meshes.drain(..) {
            mesh.material += first_material;
            scene.meshes.push(mesh);
        }
        for mut material in source.materials.drain(..) {
            let shift = |texture: &mut Texture| texture.image += first_image;
            [
                &mut material.base_color_texture,
                &mut material.metallic_roughness_texture,
                &mut material.normal_texture,
                &mut material.emissive_texture,
            ]
            .into_iter()
            .flatten()
            .for_each(shift);
            scene.materials.push(material);
        }
        scene.images.append(&mut source.images);
        scene.warnings.append(&mut source.warnings);
        for instance in &mut source.instances {
            instance.mesh += first_mesh;
            instance.material += first_material;
        }
        self.sources.insert(key.clone(), source);
        Ok(key)
    }

    /// Cuts all triangles of a file into four.
    fn subdivide(&self, entry: &Placed, source: &mut Scene) -> Result<(), SceneError> {
        let item = entry.file.display().to_string();
        if !source.skins.is_empty() {
            let problem = "a skinned mesh cannot be subdivided".to_owned();
            return Err(invalid(self.file, item, problem, "leave out subdivide"));
        }
        for mesh in &mut source.meshes {
            let most = mesh.positions.len() as u64 + mesh.indices.len() as u64;
            at_most(self.file, &item, most, MAX_VERTICES, "vertices", "subdivide less often")?;
            *mesh = subdivide(mesh);
        }
        Ok(())
    }

    fn override_material(&mut self, entry: &Placed) -> Option<usize> {
        let table = entry.material.as_ref()?;
        self.scene.materials.push(table.material(format!("material of {}", entry.file.display())));
        Some(self.scene.materials.len() - 1)
    }

    /// A node that carries the placement.
    fn push_root(&mut self, entry: &Placed) -> usize {
        let (scale, rotation, translation) = entry.components();
        self.scene.nodes.push(Node {
            name: format!("placement of {}", entry.file.display()),
            parent: None,
            local: LocalTransform::Components { translation, rotation, scale },
            global: entry.transform(),
        });
        self.scene.nodes.len() - 1
    }

    fn check_count(&self) -> Result<(), SceneError> {
        let count = self.scene.instances.len() as u64;
        at_most(self.file, "scene", count, MAX_INSTANCES, "instances", "place fewer meshes")
    }
}

/// A light in the world. Scale moves it, but changes neither its strength nor its cone (KHR_lights_punctual).
fn place_light(kind: LightKind, placement: Mat4) -> LightKind {
    let point = |position| placement.transform_point3(Vec3::from(position)).into();
    let turn = |direction| {
        placement.transform_vector3(Vec3::from(direction)).try_normalize().map_or(direction, Into::into)
    };
    match kind {
        LightKind::Point { position, intensity, range } => {
            LightKind::Point { position: point(position), intensity, range }
        }
        LightKind::Spot { position, direction, intensity, range, inner, outer } => {
            let (position, direction) = (point(position), turn(direction));
            LightKind::Spot { position, direction, intensity, range, inner, outer }
        }
        LightKind::Directional { direction, irradiance } => {
            LightKind::Directional { direction: turn(direction), irradiance }
        }
    }
}

fn place_camera(camera: &Camera, placement: Mat4) -> Option<Camera> {
    let placed = placement * camera.transform;
    let axis = |column: glam::Vec4| column.truncate();
    let (from, back, up) = (axis(placed.w_axis), axis(placed.z_axis), axis(placed.y_axis));
    Camera::oriented(&camera.name, from, back, up, camera.projection)
}
