//! Directions drawn from an environment in proportion to its light: Pharr, Jakob, Humphreys, "Physically Based
//! Rendering", 4th ed. (2023), 12.5, with the density constant on each texel as the environment itself is.

use std::f64::consts::{PI, TAU};

use airglow_math::MathError;
use airglow_math::sphere::equirect;
use airglow_scene::{Environment, luminance};
use glam::{DQuat, DVec3};

/// An environment that can be looked up and sampled, in world space.
pub struct EnvironmentSamples<'a> {
    environment: &'a Environment,
    world_from_map: DQuat,
    /// Running sums of luminance times solid angle over all texels, row by row; the last is the total.
    running: Vec<f64>,
    solid_angles: Vec<f64>,
}

impl<'a> EnvironmentSamples<'a> {
    /// Sums up the environment.
    pub fn new(environment: &'a Environment) -> Result<Self, MathError> {
        let (width, height) = (environment.width, environment.height);
        let solid_angles = (0..height)
            .map(|row| equirect::texel_solid_angle(width, height, row))
            .collect::<Result<Vec<_>, _>>()?;
        let mut total = 0.0;
        let running = environment.pixels.iter().enumerate().map(|(at, &pixel)| {
            total += f64::from(luminance(pixel)) * solid_angles[at / width];
            total
        });
        let running = running.collect();
        Ok(Self {
            environment,
            world_from_map: environment.rotation.as_dquat().normalize(),
            running,
            solid_angles,
        })
    }

    /// Radiance from a world direction, and the density with which [`sample`](Self::sample) picks it (per sr).
    pub fn look_up(&self, direction: DVec3) -> ([f32; 3], f64) {
        let (width, height) = (self.environment.width, self.environment.height);
        let [u, v] = equirect::uv(self.world_from_map.inverse() * direction);
        let column = ((u * width as f64) as usize).min(width - 1);
        let row = ((v * height as f64) as usize).min(height - 1);
        let radiance = self.environment.pixels[row * width + column];
        let total = self.total();
        (radiance, if total > 0.0 { f64::from(luminance(radiance)) / total } else { 0.0 })
    }

    /// A world direction for a point of the unit square; `None` for an environment without light.
    pub fn sample(&self, [x, y]: [f64; 2]) -> Option<DVec3> {
        let total = self.total();
        if total <= 0.0 {
            return None;
        }
        let target = x * total;
        let texel = self.running.partition_point(|&sum| sum <= target).min(self.running.len() - 1);
        let before = if texel == 0 { 0.0 } else { self.running[texel - 1] };
        // What is left of x within the texel is uniform again.
        let rest = ((target - before) / (self.running[texel] - before)).clamp(0.0, 1.0);
        let (width, height) = (self.environment.width as f64, self.environment.height as f64);
        let (row, column) = (texel / self.environment.width, texel % self.environment.width);
        let (top, bottom) = ((PI * row as f64 / height).cos(), (PI * (row + 1) as f64 / height).cos());
        let cosine = top + y * (bottom - top);
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let (sin_phi, cos_phi) = (TAU * ((column as f64 + rest) / width - 0.5)).sin_cos();
        Some(self.world_from_map * DVec3::new(sine * sin_phi, cosine, -sine * cos_phi))
    }

    /// Mean radiance over all directions: what a white surface would send out if it came evenly from everywhere.
    pub fn mean_radiance(&self) -> [f32; 3] {
        let mut sum = [0.0_f64; 3];
        for (pixels, solid_angle) in
            self.environment.pixels.chunks(self.environment.width).zip(&self.solid_angles)
        {
            for pixel in pixels {
                sum = [0, 1, 2].map(|c| sum[c] + solid_angle * f64::from(pixel[c]));
            }
        }
        sum.map(|value| (value / (2.0 * TAU)) as f32)
    }

    fn total(&self) -> f64 {
        self.running.last().copied().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use airglow_math::sequence;
    use glam::Quat;

    fn environment(pixels: Vec<[f32; 3]>, width: usize) -> Environment {
        let rotation = Quat::from_rotation_x(0.7) * Quat::from_rotation_y(-2.0);
        let height = pixels.len() / width;
        Environment { file: "test".into(), width, height, pixels, rotation, distance: None }
    }

    #[test]
    fn samples_fall_into_texels_in_proportion_to_their_light() {
        let pixels = (0..8 * 5).map(|i| [(i * i % 13) as f32, 0.5, 0.0]).collect();
        let environment = environment(pixels, 8);
        let samples = EnvironmentSamples::new(&environment).unwrap();
        // Each sample weighs radiance over density: the mean is the integral of radiance over the sphere.
        let count = 1 << 14;
        let mut sum = 0.0;
        for index in 0..count {
            let direction = samples.sample(sequence::sobol(index, 3)).unwrap();
            let (radiance, density) = samples.look_up(direction);
            assert!((direction.length() - 1.0).abs() < 1e-12 && density > 0.0, "{direction} {density}");
            sum += f64::from(radiance[0]) / density;
        }
        let (found, truth) = (sum / f64::from(count), f64::from(samples.mean_radiance()[0]) * 2.0 * TAU);
        assert!((found / truth - 1.0).abs() < 0.01, "{found} instead of {truth}");
    }

    #[test]
    fn a_uniform_environment_has_its_own_mean_and_a_black_one_no_samples() {
        let uniform = environment(vec![[2.0, 0.5, 0.0]; 35], 7);
        let mean = EnvironmentSamples::new(&uniform).unwrap().mean_radiance();
        assert!((mean[0] - 2.0).abs() < 1e-6 && (mean[1] - 0.5).abs() < 1e-6, "{mean:?}");
        let black = environment(vec![[0.0; 3]; 2], 2);
        assert!(EnvironmentSamples::new(&black).unwrap().sample([0.5, 0.5]).is_none());
    }
}
