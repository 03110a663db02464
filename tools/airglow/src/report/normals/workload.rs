//! The normal maps of a scene, each with the material that has it.

use std::collections::BTreeSet;

use airglow::normals::{Brdf, NormalMap};
use airglow_scene::Scene;

use crate::failure::{Failure, Outcome};
use crate::host::mapped;

/// A map and what it is seen on.
pub struct Map {
    /// Of the material.
    pub name: String,
    /// Its normals.
    pub normals: NormalMap,
    /// What the material reflects by.
    pub brdf: Brdf,
}

/// The maps of a scene, each once, by the names of their materials.
fn of_scene(scene: &Scene) -> Outcome<Vec<Map>> {
    let mut maps: Vec<Map> = Vec::new();
    let mut seen = BTreeSet::new();
    for material in &scene.materials {
        let texture = material.normal_texture.as_ref().filter(|texture| seen.insert(texture.image));
        let Some(image) = texture.and_then(|texture| scene.images.get(texture.image)) else { continue };
        maps.push(Map {
            name: material.name.clone(),
            normals: mapped::normals(image, material.normal_scale)?,
            brdf: mapped::brdf(material),
        });
    }
    Ok(maps)
}

impl Map {
    /// The maps of a scene that must have some.
    pub fn of_scenes(scenes: &[Scene]) -> Outcome<Vec<Self>> {
        let maps = scenes.iter().map(of_scene).collect::<Outcome<Vec<_>>>()?;
        let maps: Vec<Self> = maps.into_iter().flatten().collect();
        if maps.is_empty() {
            return Err(Failure::input("the scene has no normal map: give one with --scene".to_owned()));
        }
        Ok(maps)
    }

    /// The map repeated to so many columns and rows, for what depends on its size.
    pub fn repeated(&self, side: usize) -> Outcome<NormalMap> {
        let [width, height] = self.normals.size(0);
        let normal = |at: usize| {
            let (x, y) = (at % side % width, at / side % height);
            self.normals.normals()[y * width + x].as_vec3().to_array()
        };
        let vectors: Vec<[f32; 3]> = (0..side * side).map(normal).collect();
        NormalMap::from_vectors(side, side, &vectors).map_err(Failure::work)
    }

    /// Its name and size.
    pub fn words(&self) -> String {
        let [width, height] = self.normals.size(0);
        format!("{}, {width} x {height}", self.name)
    }
}
