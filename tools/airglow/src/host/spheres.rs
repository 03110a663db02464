//! The spheres that stand for moving meshes: fitted once, then kept in files.

use std::path::Path;

use airglow::shadow::Sphere;
use airglow::shadow::spheres::{self, FitSettings, SphereSet, SphereWeights};
use airglow_scene::{Mesh, Scene};
use glam::{DMat4, DVec3, Mat4};
use serde::{Deserialize, Serialize};

use super::skin::bound;
use crate::failure::{Failure, Outcome};
use crate::files::{self, file_name};
use crate::output::Output;

/// Version of the files; other ones are fitted anew.
const SCHEMA: u32 = 1;

/// The spheres of an instance of a figure, in the space of its mesh.
#[derive(Clone, Debug)]
pub struct InstanceSpheres {
    /// Index into the scene's figures.
    pub figure: usize,
    /// Index into the scene's instances.
    pub instance: usize,
    /// In the space of its mesh.
    pub spheres: Vec<Sphere>,
    weights: Vec<SphereWeights>,
}

/// A sphere set as it is written: metres and cubic metres, in the space of the mesh.
#[derive(Debug, Serialize, Deserialize)]
pub struct SphereFile {
    schema: u32,
    /// Name of the mesh.
    pub mesh: String,
    /// Hash of the mesh, and what was asked for.
    key: String,
    /// Centre and radius.
    pub spheres: Vec<[f64; 4]>,
    /// The sphere of each vertex.
    pub assignment: Vec<u32>,
    /// Sum over the spheres of the volume outside the mesh; what several share counts for each.
    pub outside: f64,
    /// Volume of the mesh.
    pub volume: f64,
}

impl SphereFile {
    /// Of a set that was fitted to a mesh.
    pub fn new(mesh: &Mesh, settings: &FitSettings, set: &SphereSet) -> Self {
        let sphere = |sphere: &Sphere| sphere.center.extend(sphere.radius).to_array();
        Self {
            schema: SCHEMA,
            mesh: mesh.name.clone(),
            key: key(mesh, settings),
            spheres: set.spheres.iter().map(sphere).collect(),
            assignment: set.assignment.clone(),
            outside: set.outside,
            volume: set.volume,
        }
    }

    /// The set again, where the file is one of this mesh with these settings.
    fn set(self, mesh: &Mesh, settings: &FitSettings) -> Option<SphereSet> {
        let vertices = mesh.positions.len();
        let fits =
            self.schema == SCHEMA && self.key == key(mesh, settings) && self.assignment.len() == vertices;
        let sphere = |[x, y, z, radius]: [f64; 4]| Sphere { center: DVec3::new(x, y, z), radius };
        let spheres = self.spheres.into_iter().map(sphere).collect();
        let Self { assignment, outside, volume, .. } = self;
        fits.then_some(SphereSet { spheres, assignment, outside, volume })
    }
}

fn key(mesh: &Mesh, settings: &FitSettings) -> String {
    format!("{} {settings:?}", mesh.hash)
}

/// The spheres of every figure of a scene, fitted or found in `cache`.
pub fn of_scene(scene: &Scene, cache: &Path, output: &Output) -> Outcome<Vec<InstanceSpheres>> {
    each_instance(scene, |mesh, count| {
        let settings = FitSettings { spheres: count, ..FitSettings::default() };
        cached(mesh, &settings, cache, output)
    })
}

/// One sphere for each instance, for plans, which do not depend on where spheres are.
pub fn unfitted(scene: &Scene) -> Outcome<Vec<InstanceSpheres>> {
    each_instance(scene, |mesh, _| {
        let spheres = vec![Sphere { center: DVec3::ZERO, radius: 1.0 }];
        Ok(SphereSet { spheres, assignment: vec![0; mesh.positions.len()], outside: 0.0, volume: 0.0 })
    })
}

/// `fit` for the mesh of each instance of a figure and its share of the figure's spheres, by triangles.
fn each_instance(
    scene: &Scene,
    fit: impl Fn(&Mesh, usize) -> Outcome<SphereSet>,
) -> Outcome<Vec<InstanceSpheres>> {
    let mut all = Vec::new();
    for (figure, index) in scene.figures.iter().zip(0..).filter(|(figure, _)| figure.spheres > 0) {
        let triangles: usize = figure.meshes.iter().map(|mesh| scene.meshes[*mesh].triangle_count()).sum();
        for (instance, mesh) in figure.instances.clone().zip(&figure.meshes) {
            let mesh = &scene.meshes[*mesh];
            let share = figure.spheres as usize * mesh.triangle_count() / triangles.max(1);
            let set = fit(mesh, share.max(1))?;
            let (joints, shares) = bound(mesh);
            let weights = spheres::weights(&set, &joints, &shares).map_err(Failure::work)?;
            all.push(InstanceSpheres { figure: index, instance, spheres: set.spheres, weights });
        }
    }
    Ok(all)
}

/// The spheres of a mesh from their file, or fitted and written there.
fn cached(mesh: &Mesh, settings: &FitSettings, cache: &Path, output: &Output) -> Outcome<SphereSet> {
    let name = format!(
        "{}-{}-{}.spheres.json",
        file_name(&mesh.name),
        &mesh.hash.to_string()[..16],
        settings.spheres
    );
    let file = cache.join(name);
    let kept = files::read_text(&file).ok().and_then(|text| serde_json::from_str::<SphereFile>(&text).ok());
    if let Some(set) = kept.and_then(|kept| kept.set(mesh, settings)) {
        return Ok(set);
    }
    let set = fitted(mesh, settings, output)?;
    let json = serde_json::to_vec(&SphereFile::new(mesh, settings, &set)).map_err(Failure::work)?;
    files::write(&file, &json)?;
    Ok(set)
}

/// Fits spheres to a mesh, with a bar of progress.
pub fn fitted(mesh: &Mesh, settings: &FitSettings, output: &Output) -> Outcome<SphereSet> {
    let bar = output.progress(&format!("spheres: {}", mesh.name), settings.teleports as u64, "teleports");
    let set =
        spheres::fit(&mesh.positions, &mesh.indices, settings, &mut |done| bar.set_position(done as u64));
    bar.finish_and_clear();
    set.map_err(|error| Failure::input(format!("{}: {error}", mesh.name)))
}

impl InstanceSpheres {
    /// How many.
    pub fn count(&self) -> usize {
        self.spheres.len()
    }

    /// Where they are in the world, in a pose.
    pub fn in_pose(&self, scene: &Scene, pose: &[Mat4]) -> Vec<Sphere> {
        let joints = scene.joints(&scene.instances[self.instance], pose);
        let joints: Vec<DMat4> = joints.iter().map(Mat4::as_dmat4).collect();
        spheres::skinned(&self.spheres, &self.weights, &joints)
    }
}
