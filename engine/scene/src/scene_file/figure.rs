//! `[[figure]]`: a glTF file that moves.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::Spanned;

use super::at;
use super::place::Builder;
use super::placed::{MaterialTable, Placed};
use super::values::{Finite, Rotation, Scale, Vector};
use crate::error::SceneError;
use crate::figure::Figure;

/// Spheres that stand for a figure unless the scene file says otherwise.
const SPHERES: u32 = 60;

/// `[[figure]]`.
#[derive(Debug, Deserialize)]
#[serde(try_from = "FigureFields")]
pub(super) struct FigureTable {
    pub(super) name: Option<String>,
    pub(super) placed: Placed,
    pub(super) animation: Option<Spanned<String>>,
    pub(super) time: f32,
    pub(super) velocity: [f32; 3],
    pub(super) spheres: u32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FigureFields {
    name: Option<String>,
    file: PathBuf,
    animation: Option<Spanned<String>>,
    time: Option<Finite>,
    translation: Option<Vector>,
    #[serde(default)]
    rotation: Rotation,
    scale: Option<Scale>,
    velocity: Option<Vector>,
    spheres: Option<u32>,
    material: Option<MaterialTable>,
}

impl TryFrom<FigureFields> for FigureTable {
    type Error = &'static str;

    fn try_from(fields: FigureFields) -> Result<Self, Self::Error> {
        let FigureFields { name, file, animation, time, translation, rotation, scale, velocity, .. } = fields;
        let spheres = fields.spheres.unwrap_or(SPHERES);
        if !(1..=1024).contains(&spheres) {
            return Err("spheres of a figure is a whole number from 1 to 1024");
        }
        let placed =
            Placed { file, translation, rotation, scale, material: fields.material, ..Placed::default() };
        let time = time.map_or(0.0, |time| time.0);
        let velocity = velocity.map_or([0.0; 3], |velocity| glam::Vec3::from(velocity).into());
        Ok(Self { name, placed, animation, time, velocity, spheres })
    }
}

/// Places a file as something that moves.
pub(super) fn place(
    file: &Path,
    text: &str,
    table: &FigureTable,
    index: usize,
    builder: &mut Builder<'_>,
) -> Result<(), SceneError> {
    let (first_instance, first_animation) = (builder.scene.instances.len(), builder.scene.animations.len());
    let (root, cameras) = (builder.scene.nodes.len(), builder.scene.cameras.len());
    builder.place_file(&table.placed)?;
    let scene = &mut builder.scene;
    // What looks at a figure in its own file is not what looks at the scene.
    scene.cameras.truncate(cameras);
    let animations = scene.animations.get(first_animation..).unwrap_or_default();
    let number = match &table.animation {
        None => (!animations.is_empty()).then_some(0),
        Some(wanted) => {
            let (name, start) = (wanted.get_ref(), wanted.span().start);
            let number = animations.iter().position(|animation| animation.name == *name);
            let names: Vec<_> = animations.iter().map(|animation| animation.name.as_str()).collect();
            let source = table.placed.file.display();
            let problem = format!("{source} has no animation {name:?}; it has {names:?}");
            Some(number.ok_or_else(|| at(file, text, start, problem))?)
        }
    };
    let instances = first_instance..scene.instances.len();
    scene.figures.push(Figure {
        name: table.name.clone().unwrap_or_else(|| format!("figure {index}")),
        meshes: scene.instances.get(instances.clone()).unwrap_or_default().iter().map(|i| i.mesh).collect(),
        instances,
        root,
        animation: number.map(|number| first_animation + number),
        time: table.time,
        velocity: table.velocity,
        spheres: table.spheres,
    });
    Ok(())
}
