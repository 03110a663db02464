//! A scene's lamps, medium and camera over the ground: coherent rays, and errors as the eye gets them.

use std::f64::consts::PI;

use airglow::fog::reference::airlight::{Sight, airlight};
use airglow::fog::rivals::Row;
use airglow::fog::{Light, Phase, View};
use airglow_gpu::ash::vk;
use airglow_math::quadrature::gauss_legendre;
use airglow_math::statistics::percentiles;
use airglow_scene::{Exposure, Scene};

use crate::failure::{Failure, Outcome};
use crate::host::device::Device;
use crate::host::fog::SceneFog;
use crate::report::model::Distribution;

/// Pixels along a side.
pub const SIDE: u32 = 512;

/// Truths are taken at every so many pixels along a side.
const STRIDE: u32 = 8;

/// Rays of a picture through a medium.
pub struct Picture {
    /// Camera, medium and lights, these as points that shine everywhere and scatter alike in all directions.
    pub view: View,
    /// Length of each pixel's ray, metres; infinite above the ground.
    pub lengths: Vec<f64>,
    /// Depth of each pixel, as the view's world has it.
    pub depths: Vec<f32>,
    /// Rays of each light: all pixels of the first light, then all of the next.
    pub rows: Vec<Row>,
    /// Pixels with a truth, and the airlight there, W/sr/m2.
    pub truths: Vec<(usize, [f64; 3])>,
    /// From radiance to the display.
    pub exposure: f64,
}

impl Picture {
    /// The scene's camera and lamps over a floor at height 0.
    pub fn new(device: &Device<'_>, scene: &Scene) -> Outcome<Self> {
        let fog = SceneFog::new(device, scene, None, vk::Format::R32G32B32A32_SFLOAT)?;
        let Some(fog) = fog else {
            return Err(Failure::input("the scene has no medium; give it a [medium]"));
        };
        let mut view = fog.view(&scene.camera(), 1.0, glam::DQuat::IDENTITY)?;
        if view.lights.is_empty() || view.world.depth.orthographic {
            return Err(Failure::input("the scene needs point or spot lights and a perspective camera"));
        }
        let point =
            |light: &Light| Light { radius: light.radius, ..Light::point(light.position, light.intensity) };
        view.lights = view.lights.iter().map(point).collect();
        view.medium.phase = Phase::Isotropic;
        (view.world.depth.far, view.world.depth.reversed) = (None, true);
        let exposure = match scene.exposure {
            Exposure::Fixed { scale } => f64::from(scale),
            _ => 1.0,
        };
        let mut picture = Self {
            view,
            lengths: Vec::new(),
            depths: Vec::new(),
            rows: Vec::new(),
            truths: Vec::new(),
            exposure,
        };
        picture.trace();
        picture.solve()?;
        Ok(picture)
    }

    fn trace(&mut self) {
        let camera = &self.view.camera;
        let [left, right, low, high] = camera.edges;
        let at = |pixel: u32| (f64::from(pixel) + 0.5) / f64::from(SIDE);
        let mut directions = Vec::with_capacity((SIDE * SIDE) as usize);
        for y in 0..SIDE {
            for x in 0..SIDE {
                let across = left + (right - left) * at(x);
                let up = high + (low - high) * at(y);
                let ray = camera.forward + across * camera.right + up * camera.up;
                let direction = ray.normalize();
                // Down to the floor, or without end.
                let length = if direction.y < 0.0 && camera.position.y > 0.0 {
                    camera.position.y / -direction.y
                } else {
                    f64::INFINITY
                };
                let depth = &self.view.world.depth;
                self.depths.push(match length.is_finite() {
                    true => depth.value(length / ray.length()) as f32,
                    false => depth.farthest() as f32,
                });
                self.lengths.push(length);
                directions.push(direction);
            }
        }
        for light in &self.view.lights {
            let towards = light.position - camera.position;
            for (&direction, &length) in directions.iter().zip(&self.lengths) {
                let off = towards.cross(direction).length().hypot(light.radius);
                self.rows.push(self.row(light, towards.dot(direction), off, length));
            }
        }
    }

    fn row(&self, light: &Light, along: f64, off: f64, length: f64) -> Row {
        let (medium, scattering) = (&self.view.medium, self.view.medium.scattering());
        let weight = |channel: usize| scattering[channel] * light.intensity[channel] / (4.0 * PI);
        Row {
            extinction: medium.extinction.map(|extinction| extinction as f32),
            extent: length.min(1e32) as f32,
            seen: medium.extinction.map(|extinction| (-extinction * along.hypot(off)).exp() as f32),
            along: along as f32,
            off: off as f32,
            weight: [0, 1, 2].map(|channel| weight(channel) as f32),
        }
    }

    /// Truths from the rows in f64: the f32 of a row is its input.
    fn solve(&mut self) -> Outcome {
        let pixels = (SIDE * SIDE) as usize;
        for y in (STRIDE / 2..SIDE).step_by(STRIDE as usize) {
            for x in (STRIDE / 2..SIDE).step_by(STRIDE as usize) {
                let pixel = (y * SIDE + x) as usize;
                let mut sum = [0.0; 3];
                for row in self.rows[pixel..].iter().step_by(pixels) {
                    let sight = Sight { along: f64::from(row.along), offset: f64::from(row.off) };
                    for (channel, sum) in sum.iter_mut().enumerate() {
                        let extinction = f64::from(row.extinction[channel]);
                        let integral =
                            airlight(extinction, sight, 0.0, self.lengths[pixel], Phase::Isotropic);
                        *sum +=
                            f64::from(row.weight[channel]) * 4.0 * PI * integral.map_err(Failure::work)?;
                    }
                }
                self.truths.push((pixel, sum));
            }
        }
        Ok(())
    }

    /// Errors of a picture in half steps of 8 bits of the display, over black surfaces, where steps are finest.
    pub fn errors(&self, airlight: &[[f32; 3]]) -> Outcome<Distribution> {
        let (mut errors, mut bad) = (Vec::with_capacity(3 * self.truths.len()), 0);
        let shown = |radiance: f64| 2.0 * 255.0 * encode(self.exposure * radiance);
        for (pixel, truth) in &self.truths {
            for (&value, &truth) in airlight[*pixel].iter().zip(truth) {
                match value.is_finite() && value >= 0.0 {
                    true => errors.push((shown(f64::from(value)) - shown(truth)).abs()),
                    false => bad += 1,
                }
            }
        }
        let at = percentiles(&errors, &[50.0, 99.0, 100.0]).map_err(Failure::work)?;
        Ok(Distribution { median: at[0], p99: at[1], largest: at[2], below: 0.0, bad })
    }

    /// The taps' own airlight at the pixels with a truth, in f64: what the device would give without rounding.
    pub fn taps(&self, count: usize, cut: f64) -> Outcome<Vec<[f64; 3]>> {
        let rule = gauss_legendre(count).map_err(Failure::work)?;
        let pixels = (SIDE * SIDE) as usize;
        let at = |&(pixel, _): &(usize, [f64; 3])| {
            let mut sum = [0.0; 3];
            for row in self.rows[pixel..].iter().step_by(pixels) {
                let integrals = taps_of(row, self.lengths[pixel], &rule, cut);
                sum = [0, 1, 2]
                    .map(|channel| sum[channel] + f64::from(row.weight[channel]) * integrals[channel]);
            }
            sum
        };
        Ok(self.truths.iter().map(at).collect())
    }

    /// Largest difference of a picture from airlight at the pixels with a truth, in half steps.
    pub fn difference(&self, airlight: &[[f32; 3]], exact: &[[f64; 3]]) -> f64 {
        let shown = |radiance: f64| 2.0 * 255.0 * encode(self.exposure * radiance);
        let pairs = self.truths.iter().zip(exact).flat_map(|((pixel, _), exact)| {
            [0, 1, 2].map(|channel| (f64::from(airlight[*pixel][channel]), exact[channel]))
        });
        pairs.map(|(value, exact)| (shown(value) - shown(exact)).abs()).fold(0.0, f64::max)
    }

    /// The airlight times what brings it closest to the truths, channel by channel.
    pub fn fit(&self, airlight: &[[f32; 3]]) -> Vec<[f32; 3]> {
        let factor = [0, 1, 2].map(|channel| {
            let pairs = self
                .truths
                .iter()
                .map(|(pixel, truth)| (f64::from(airlight[*pixel][channel]), truth[channel]));
            let (both, own) =
                pairs.fold((0.0, 0.0), |(both, own), (a, truth)| (both + a * truth, own + a * a));
            if own > 0.0 { (both / own) as f32 } else { 0.0 }
        });
        airlight.iter().map(|values| [0, 1, 2].map(|channel| values[channel] * factor[channel])).collect()
    }

    /// Optical distance of the nearest lamp, by the mean extinction.
    pub fn nearest(&self) -> f64 {
        let distance = |light: &Light| light.position.distance(self.view.camera.position);
        let nearest = self.view.lights.iter().map(distance).fold(f64::INFINITY, f64::min);
        nearest * self.view.medium.extinction.iter().sum::<f64>() / 3.0
    }

    /// In words.
    pub fn words(&self) -> String {
        format!(
            "{SIDE} x {SIDE} pixels, {} lamps of the scene as points that shine everywhere and an isotropic phase \
             function, over a floor at height 0 and under an open sky",
            self.view.lights.len()
        )
    }
}

/// `shaders/glsl/fog/taps.glsl` for one light and ray, without its guards against rounding.
fn taps_of(row: &Row, length: f64, rule: &[(f64, f64)], cut: f64) -> [f64; 3] {
    let [along, off] = [row.along, row.off].map(f64::from);
    let extinction = row.extinction.map(f64::from);
    let least = extinction.into_iter().fold(f64::INFINITY, f64::min);
    let beyond = |ahead: f64| {
        let distance = off.hypot(ahead);
        if ahead >= 0.0 { ahead + distance } else { off * off / (distance - ahead) }
    };
    let start = beyond(-along);
    let excess = if length.is_finite() { beyond(length - along) - start } else { f64::INFINITY };
    let scale = 1.5 * off.hypot(start);
    let ratio = excess.min(cut / least) / scale;
    let end = 1.0 - 2.0 / (1.0 + (1.0 + 4.0 * ratio).sqrt());
    let mut sum = [0.0; 3];
    for (node, weight) in rule {
        let y = end * 0.5 * (1.0 + node);
        let excess = scale * y / (1.0 - y).powi(2);
        let slope = scale * (1.0 + y) / (1.0 - y).powi(3);
        let share = weight * end * slope / (off * off + (start + excess).powi(2));
        sum = [0, 1, 2].map(|c| sum[c] + share * (-extinction[c] * (off.hypot(along) + excess)).exp());
    }
    sum
}

/// sRGB of a linear value, clamped.
fn encode(linear: f64) -> f64 {
    let linear = linear.clamp(0.0, 1.0);
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}
