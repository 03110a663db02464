//! Pictures of hundreds of samples a pixel.

use airglow_math::sequence;
use airglow_scene::FloatImage;

use super::picture::Compiled;
use super::renderer::Renderer;
use super::settings::Settings;
use super::view;
use crate::failure::{Failure, Outcome};

impl Renderer<'_> {
    /// The mean of `passes` frames, each moved by its own fraction of a sample: scene-linear.
    pub fn average(&mut self, settings: &Settings, passes: u32) -> Outcome<FloatImage> {
        let Compiled { mut execution, imports, turning, .. } = self.compile(settings, 1, false)?;
        self.move_to(settings.time)?;
        let size = settings.picture_size();
        let mut sums = vec![0.0_f64; 3 * size[0] as usize * size[1] as usize];
        let sides = settings.size.map(|side| (side * settings.samples) as f32);
        for pass in 0..passes {
            let [x, y] = sequence::sobol(pass, 0).map(|place| 2.0 * place as f32 - 1.0);
            let offset = if passes > 1 { [x / sides[0], y / sides[1]] } else { [0.0; 2] };
            for (shared, view) in turning.views.iter().zip(self.views(settings, settings.turn)) {
                shared.set(view.moved(offset));
            }
            self.device.frames(&mut execution, &imports, None, 1, |_| Ok(()))?;
            let linear: Vec<f32> = self.linear.read(0, sums.len()).map_err(Failure::work)?;
            sums.iter_mut().zip(linear).for_each(|(sum, value)| *sum += f64::from(value));
        }
        let values: Vec<f32> = sums.iter().map(|sum| (sum / f64::from(passes)) as f32).collect();
        Ok(view::picture(size, &values))
    }
}
