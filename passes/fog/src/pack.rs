//! From the host's view to the bytes of `frame.glsl`.

mod light;

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::beam::{Beam, Region};
use crate::camera::Rays;
use crate::environment::ENVIRONMENT_ORDER;
use crate::error::FogError;
use crate::limits::MAX_LIGHTS;
use crate::medium::Thinning;
use crate::settings::Settings;
use crate::tiles::{Regions, TILE};
use crate::view::View;

const COEFFICIENTS: usize = ENVIRONMENT_ORDER * ENVIRONMENT_ORDER;

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

/// `FogFrame` of `frame.glsl`.
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
    /// Coefficients of the environment's radiance, times the albedo and what is left of it; the first three hold its
    /// optical distance beside them.
    environment: [[f32; 4]; COEFFICIENTS],
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
    /// Lights of the view, and where those of the constants may be seen.
    pub lights: u32,
    pub rays: Rays,
    pub regions: Regions,
}

/// Checks a view and packs it for a picture of `size` pixels. Subtraction of the eye's place is done in f64.
pub(crate) fn pack(settings: &Settings, view: &View, size: [u32; 2]) -> Result<Packed, FogError> {
    let View { world, camera, medium, lights, environment: _ } = view;
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
    let environment = pack_environment(settings, view)?;
    let eye = world.position(camera.position);
    let [thinning, density] = match medium.thinning {
        Some(Thinning { level, scale_height }) => {
            [1.0 / scale_height, ((level - eye.y) / scale_height).exp()]
        }
        None => [0.0, 1.0],
    };
    let extinction = medium.extinction.map(|value| value * density);
    let scattering = medium.scattering().map(|value| value * density);
    let rays = camera.rays(world, size);
    let whole = Beam::new(&rays, world.depth.orthographic, [0.0; 2], [1.0; 2]);
    let mut packed = [LightConstants::zeroed(); MAX_LIGHTS];
    let mut regions = Regions { regions: [Region::default(); MAX_LIGHTS], count: 0, featured: 0 };
    for light in lights {
        let strongest = [least(medium.extinction), most(scattering)];
        let Some((constants, region)) = light::pack(settings, view, light, strongest) else { continue };
        if whole.meets(&region) {
            let featured = light.cone.is_some() || light.range.is_some() || light.bounds.is_some();
            packed[regions.count] = constants;
            regions.regions[regions.count] = region;
            regions.featured |= u64::from(featured) << regions.count;
            regions.count += 1;
        }
    }
    let [start, to_right, to_lower] = rays.start;
    let constants = FrameConstants {
        start: [
            wide(start, f64::from(u8::from(world.depth.orthographic))),
            wide(to_right, f64::from(TILE)),
            wide(to_lower, 0.0),
        ],
        direction: rays.direction.map(|vector| wide(vector, 0.0)),
        depth: world.depth_coefficients().map(|value| value as f32),
        extinction: rgb(extinction, thinning),
        scattering: rgb(scattering, world.pre_exposure),
        phase,
        size,
        light_count: regions.count as i32,
        farthest: world.depth.farthest() as f32,
        environment,
        lights: packed,
    };
    Ok(Packed { constants, lights: lights.len() as u32, rays, regions })
}

/// What is left of the environment's light, or nothing where there is none.
fn pack_environment(settings: &Settings, view: &View) -> Result<[[f32; 4]; COEFFICIENTS], FogError> {
    let Some(environment) = &view.environment else { return Ok([[0.0; 4]; COEFFICIENTS]) };
    if !settings.environment {
        let (what, mend) = ("lies before an environment", "choose Settings::environment");
        return Err(FogError::Kernel { what, mend });
    }
    let metres = view.world.distance(environment.distance);
    let distant = environment.distant(&view.medium, metres)?;
    let [red, green, blue] = distant.optical_distance;
    let optical = [red, green, blue].into_iter().chain(std::iter::repeat(0.0));
    let left = DVec3::from(distant.albedo) * DVec3::new((-red).exp(), (-green).exp(), (-blue).exp());
    let mut packed = [[0.0; 4]; COEFFICIENTS];
    for ((packed, radiance), optical) in packed.iter_mut().zip(environment.radiance).zip(optical) {
        *packed = wide(left * DVec3::from(radiance), optical);
    }
    Ok(packed)
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
