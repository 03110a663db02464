//! Values of vertices drawn over the scene: white surfaces without lights, whose radiance is the value.

use airglow_scene::{Material, Scene};

use super::Shown;
use crate::compare::legend::Values;
use crate::failure::Outcome;
use crate::host::renderer::Renderer;
use crate::host::source::Source;

impl Shown<'_> {
    /// Draws three numbers a vertex, none below 0, for each instance; pixels without a surface have zeros.
    pub fn numbers(&self, vertices: Vec<Vec<[f32; 3]>>) -> Outcome<Vec<[f32; 3]>> {
        let scene = canvas(self.scene);
        let source = Source::Colours(vertices);
        let mut renderer = Renderer::new(self.device, &scene, &source, self.settings.size)?;
        Ok(renderer.draw(&self.settings, 1)?.linear.pixels)
    }

    /// Draws one number a vertex for each instance; where it is below 0 there is nothing to show.
    pub fn vertices(&self, values: &[Vec<f32>]) -> Outcome<Values> {
        let masked = |value: &f32| if *value < 0.0 { [0.0; 3] } else { [*value, 1.0, 0.0] };
        let with_mask = |values: &Vec<f32>| values.iter().map(masked).collect();
        let pixels = self.numbers(values.iter().map(with_mask).collect())?;
        let value = |[value, mask, _]: [f32; 3]| (mask > 0.0).then_some(value / mask);
        let width = self.settings.size[0] as usize;
        Ok(Values { width, values: pixels.into_iter().map(value).collect() })
    }

    /// The same number at each vertex, for instances that have no values.
    #[cfg(any(feature = "normals", feature = "shadow"))]
    pub fn everywhere(&self, instance: usize, value: f32) -> Vec<f32> {
        vec![value; self.scene.meshes[self.scene.instances[instance].mesh].positions.len()]
    }
}

/// The scene with white surfaces, and without all that shines or hides light.
fn canvas(scene: &Scene) -> Scene {
    let mut canvas = scene.clone();
    for material in &mut canvas.materials {
        *material = Material { name: std::mem::take(&mut material.name), ..Material::default() };
    }
    canvas.lights.clear();
    canvas.blockers.clear();
    canvas.figures.iter_mut().for_each(|figure| figure.spheres = 0);
    (canvas.environment, canvas.medium) = (None, None);
    canvas
}
