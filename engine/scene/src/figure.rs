//! Things of a scene that move by themselves: glTF files with an animation.

use std::ops::Range;

/// A glTF file that is drawn in the pose of its animation, and walks along its own axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The scene file's, or `figure N`.
    pub name: String,
    /// Indices into [`crate::Scene::instances`] of what it is made of.
    pub instances: Range<usize>,
    /// Index into [`crate::Scene::meshes`] of the mesh of each instance at rest.
    pub meshes: Vec<usize>,
    /// Index into [`crate::Scene::nodes`] of the node that places it.
    pub root: usize,
    /// Index into [`crate::Scene::animations`]; at rest without one.
    pub animation: Option<usize>,
    /// Seconds of the animation at the scene's time 0.
    pub time: f32,
    /// Metres a second along its own axes, before scale.
    pub velocity: [f32; 3],
    /// How many spheres stand for it where it casts shadows, 1 to 1024; 0 where it casts none.
    pub spheres: u32,
}
