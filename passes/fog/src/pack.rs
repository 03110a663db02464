//! From the host's view to the bytes of `frame.glsl`.

use std::f64::consts::PI;

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::camera::Rays;
use crate::error::FogError;
use crate::frame::{Counts, View};
use crate::light::Light;
use crate::medium::Thinning;
use crate::reach::{Reach, reach};
use crate::settings::{MAX_LIGHTS, Settings};

/// `FogLight` of `airlight.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct LightConstants {
    pub(crate) position_radius: [f32; 4],
    pub(crate) intensity_reach: [f32; 4],
    pub(crate) axis_cosine: [f32; 4],
    pub(crate) falloff_range: [f32; 4],
    pub(crate) low: [f32; 4],
    pub(crate) high: [f32; 4],
}

/// `Frame` of `frame.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct FrameConstants {
    start: [[f32; 4]; 3],
    direction: [[f32; 4]; 3],
    depth: [f32; 4],
    extinction: [f32; 4],
    scattering: [f32; 4],
    phase: [f32; 4],
    size: [u32; 2],
    light_count: i32,
    farthest: f32,
    lights: [LightConstants; MAX_LIGHTS],
}

impl FrameConstants {
    pub(crate) fn first_light(&self) -> LightConstants {
        self.lights[0]
    }

    pub(crate) fn extinction(&self) -> [f32; 4] {
        self.extinction
    }

    pub(crate) fn scattering(&self) -> [f32; 4] {
        self.scattering
    }

    pub(crate) fn phase(&self) -> [f32; 4] {
        self.phase
    }
}

/// A view as the shader takes it.
#[derive(Clone, Debug)]
pub(crate) struct Packed {
    pub constants: FrameConstants,
    pub counts: Counts,
}

/// Checks a view and packs it for a picture of `size` pixels. Subtraction of the eye's place is done in f64.
pub(crate) fn pack(settings: &Settings, view: &View, size: [u32; 2]) -> Result<Packed, FogError> {
    let View { world, camera, medium, lights } = view;
    world.check()?;
    camera.check()?;
    medium.check()?;
    if lights.len() > MAX_LIGHTS {
        return Err(FogError::TooManyLights { count: lights.len() });
    }
    lights.iter().enumerate().try_for_each(|(index, light)| light.check(index))?;
    let kernel = |what, mend| FogError::Kernel { what, mend };
    let phase = medium
        .phase
        .values(settings.phase)
        .ok_or_else(|| kernel("has another kind of phase function", "choose it by Settings::phase"))?;
    if medium.thinning.is_some() && !settings.height {
        return Err(kernel("thins with height", "choose Settings::height"));
    }
    let eye = world.position(camera.position);
    let [thinning, density] = match medium.thinning {
        Some(Thinning { level, scale_height }) => {
            [1.0 / scale_height, ((level - eye.y) / scale_height).exp()]
        }
        None => [0.0, 1.0],
    };
    let extinction = medium.extinction.map(|value| value * density);
    let scattering = medium.scattering().map(|value| value * density);
    let mut packed = [LightConstants::zeroed(); MAX_LIGHTS];
    let mut counts = Counts::default();
    let rays = camera.rays(world, size);
    for light in lights {
        let light = pack_light(settings, view, light, &rays, [least(medium.extinction), most(scattering)]);
        match light {
            Some(light) => {
                packed[counts.evaluated as usize] = light;
                counts.evaluated += 1;
            }
            None => counts.left_out += 1,
        }
    }
    let constants = FrameConstants {
        start: rays.start.map(|vector| wide(vector, f64::from(u8::from(world.depth.orthographic)))),
        direction: rays.direction.map(|vector| wide(vector, 0.0)),
        depth: world.depth_coefficients().map(|value| value as f32),
        extinction: rgb(extinction, thinning),
        scattering: rgb(scattering, world.pre_exposure),
        phase,
        size,
        light_count: counts.evaluated as i32,
        farthest: world.depth.farthest() as f32,
        lights: packed,
    };
    Ok(Packed { constants, counts })
}

/// The constants of a light, or `None` where no pixel can show its airlight.
fn pack_light(
    settings: &Settings,
    view: &View,
    light: &Light,
    rays: &Rays,
    [extinction, scattering]: [f64; 2],
) -> Option<LightConstants> {
    let View { world, camera, medium, .. } = view;
    let position = world.position(light.position) - world.position(camera.position);
    let distance = position.length();
    let intensity = light.intensity.map(|value| value * light.scatter);
    // Where the medium thins, neither its density nor what the path loses is bounded by that of the eye.
    let reached = if medium.thinning.is_some() {
        if most(intensity) > 0.0 { Reach::Everywhere } else { Reach::Nowhere }
    } else {
        let strongest = scattering * medium.phase.most() * most(intensity) * (-extinction * distance).exp();
        reach(strongest, distance, world.distance(light.radius), settings.bound / world.pre_exposure)
    };
    // The sphere of a range is seen within the angle whose sine is range / distance.
    let range = light
        .range
        .map(|range| world.distance(range) / distance)
        .filter(|sine| settings.bound > 0.0 && *sine < 1.0);
    let angle = match reached {
        Reach::Nowhere => return None,
        Reach::Within(angle) => range.map_or(angle, |sine| angle.min(sine.asin())),
        Reach::Everywhere => range.map_or(PI, f64::asin),
    };
    let least_along = if angle == PI || world.depth.orthographic {
        f64::from(f32::MIN)
    } else if rays.come_within(position, angle) {
        // Rounded outwards by more than f32 loses.
        distance * angle.cos() - 1e-6 * distance
    } else {
        return None;
    };
    let mut constants = LightConstants {
        position_radius: wide(position, world.distance(light.radius)),
        intensity_reach: rgb(seen(view, intensity, position, world.distance(light.radius)), least_along),
        axis_cosine: [0.0, 0.0, 0.0, -2.0],
        falloff_range: [0.0; 4],
        low: [0.0; 4],
        high: [0.0; 4],
    };
    if let Some(cone) = light.cone {
        constants.axis_cosine = wide(world.direction(cone.direction).normalize(), cone.outer.cos());
        // KHR_lights_punctual: full at the inner angle, nothing at the outer.
        let scale = 1.0 / (cone.inner.cos() - cone.outer.cos()).max(1e-3);
        constants.falloff_range[..2].copy_from_slice(&[scale as f32, (-cone.outer.cos() * scale) as f32]);
    }
    if let Some(range) = light.range {
        constants.falloff_range[2] = world.distance(range) as f32;
    }
    if let Some(bounds) = light.bounds {
        let ends = [bounds.low, bounds.high].map(|end| world.position(end) - world.position(camera.position));
        constants.falloff_range[3] = 1.0;
        constants.low = wide(ends[0].min(ends[1]), 0.0);
        constants.high = wide(ends[0].max(ends[1]), 0.0);
    }
    Some(constants)
}

/// `fog_seen` of `airlight.glsl`, in f64; left to the shader where each ray has an eye of its own.
fn seen(view: &View, intensity: [f64; 3], position: DVec3, radius: f64) -> [f64; 3] {
    if view.world.depth.orthographic || view.medium.thinning.is_some() {
        return intensity;
    }
    let path = position.length().hypot(radius);
    [0, 1, 2].map(|channel| intensity[channel] * (-view.medium.extinction[channel] * path).exp())
}

impl Rays {
    /// Whether a ray of the picture may come within `angle` of the direction to `position`: none outside the cone about
    /// the picture's middle that holds its corners does if the two cones are apart. Rays of a perspective.
    fn come_within(&self, position: DVec3, angle: f64) -> bool {
        let [corner, across, down] = self.direction;
        let middle = (corner + 0.5 * (across + down)).normalize();
        let corners = [corner, corner + across, corner + down, corner + across + down];
        let widest = corners.map(|corner| middle.angle_between(corner)).into_iter().fold(0.0, f64::max);
        middle.angle_between(position) <= widest + angle
    }
}

fn most(values: [f64; 3]) -> f64 {
    values.into_iter().fold(0.0, f64::max)
}

fn least(values: [f64; 3]) -> f64 {
    values.into_iter().fold(f64::INFINITY, f64::min)
}

fn wide(vector: DVec3, w: f64) -> [f32; 4] {
    vector.extend(w).as_vec4().to_array()
}

fn rgb(values: [f64; 3], w: f64) -> [f32; 4] {
    wide(DVec3::from(values), w)
}

#[cfg(test)]
mod tests;
