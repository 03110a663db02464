//! The scene's point, spot and directional lights, as the forward draw takes them.

use airglow_scene::{Light, LightKind, Medium, Scene};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// Lights that a draw takes; further ones are left out.
pub const MAX_LIGHTS: usize = 64;

/// `Light` of `host/lights.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct LightConstants {
    position_range: [f32; 4],
    intensity_scale: [f32; 4],
    axis_offset: [f32; 4],
}

/// `Lights` of `host/lights.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct LightsConstants {
    extinction: [f32; 4],
    scattering: [f32; 4],
    count: [u32; 4],
    lights: [LightConstants; MAX_LIGHTS],
}

impl LightsConstants {
    /// No light.
    pub const NONE: Self = Self {
        extinction: [0.0; 4],
        scattering: [0.0; 4],
        count: [0; 4],
        lights: [LightConstants {
            position_range: [0.0; 4],
            intensity_scale: [0.0; 4],
            axis_offset: [0.0; 4],
        }; MAX_LIGHTS],
    };

    /// Those of a scene; `None` where it has none.
    pub fn of_scene(scene: &Scene) -> Option<Self> {
        if scene.lights.is_empty() {
            return None;
        }
        let mut lights = [LightConstants::zeroed(); MAX_LIGHTS];
        for (constants, light) in lights.iter_mut().zip(&scene.lights) {
            *constants = LightConstants::new(light);
        }
        let count = [scene.lights.len().min(MAX_LIGHTS) as u32, 0, 0, 0];
        let of_medium =
            |value: fn(Medium) -> Vec3| scene.medium.map_or(Vec3::ZERO, value).extend(0.0).to_array();
        let extinction = of_medium(|medium| medium.extinction.into());
        let scattering = of_medium(|medium| Vec3::from(medium.extinction) * Vec3::from(medium.albedo));
        Some(Self { extinction, scattering, count, lights })
    }

    /// The same in clear air.
    #[must_use]
    pub fn without_medium(self) -> Self {
        Self { extinction: [0.0; 4], scattering: [0.0; 4], ..self }
    }
}

impl LightConstants {
    fn new(light: &Light) -> Self {
        let wide = |vector: [f32; 3], w: f32| Vec3::from(vector).extend(w).to_array();
        match light.kind {
            LightKind::Point { position, intensity, range } => Self {
                position_range: wide(position, range.unwrap_or(0.0)),
                intensity_scale: wide(intensity, 0.0),
                axis_offset: wide([0.0; 3], 1.0),
            },
            LightKind::Spot { position, direction, intensity, range, inner, outer } => {
                // KHR_lights_punctual: full at the inner angle, nothing at the outer.
                let scale = 1.0 / (inner.cos() - outer.cos()).max(1e-3);
                Self {
                    position_range: wide(position, range.unwrap_or(0.0)),
                    intensity_scale: wide(intensity, scale),
                    axis_offset: wide(direction, -outer.cos() * scale),
                }
            }
            LightKind::Directional { direction, irradiance } => Self {
                position_range: wide([0.0; 3], -1.0),
                intensity_scale: wide(irradiance, 0.0),
                axis_offset: wide(direction, 1.0),
            },
        }
    }
}
