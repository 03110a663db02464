//! A view through a medium, as a host says it.

use std::mem::offset_of;

use airglow_fog::{Bounds, Camera, Cone, Environment, Light, Medium, Phase, PhaseKind, Thinning, View};
use airglow_math::World;
use glam::DVec3;

use crate::input::{Versioned, array, shared, versioned};
use crate::status::Failure;
use crate::world::AirglowWorld;

/// A point light or spot light, in the host's axes and units. Elements of arrays never grow.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowFogLight {
    /// Where it is.
    pub position: [f64; 3],
    /// Radiant intensity, W/sr, of red, green and blue.
    pub intensity: [f64; 3],
    /// Factor on what the medium scatters of it; 0 is 1.
    pub scatter: f64,
    /// Radius; 0 is a point.
    pub radius: f64,
    /// Axis of a spot light, away from it.
    pub cone_direction: [f64; 3],
    /// Half angle of full intensity, radians.
    pub cone_inner: f64,
    /// Half angle from which on nothing arrives, radians; 0: no spot light.
    pub cone_outer: f64,
    /// Distance from which on nothing arrives; 0: none.
    pub range: f64,
    /// Lowest coordinates of the box in which it shines.
    pub bounds_low: [f64; 3],
    /// Highest coordinates of that box; where both are all zero there is none.
    pub bounds_high: [f64; 3],
}

/// A view through a medium: all that may change while a prepared view stays.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowFogView {
    /// `sizeof(AirglowFogView)`.
    pub struct_size: u32,
    /// Not used; 0.
    pub reserved: u32,
    /// The host's conventions; null is airglow's own.
    pub world: *const AirglowWorld,
    /// The eye, in the host's axes and units.
    pub eye: [f64; 3],
    /// Unit vector to the right of the picture.
    pub right: [f64; 3],
    /// Unit vector up the picture.
    pub up: [f64; 3],
    /// Unit vector into the picture.
    pub forward: [f64; 3],
    /// Left, right, lower and upper edge of the picture at distance 1: tangents of the angles from `forward`; of an
    /// orthographic view the edges themselves.
    pub edges: [f64; 4],
    /// Extinction coefficient of the medium, 1/m, of red, green and blue. All zero: the pass is left out.
    pub extinction: [f64; 3],
    /// What of the extinction is scattering, 0 to 1 each.
    pub albedo: [f64; 3],
    /// Numbers of the phase function: see `AirglowFogPhase`.
    pub phase: [f64; 4],
    /// Where a medium that thins with height is as dense as it says, metres up.
    pub thinning_level: f64,
    /// Metres up in which it thins by a factor of e; 0: it does not.
    pub scale_height: f64,
    /// Lights inside the medium, at most 64.
    pub lights: *const AirglowFogLight,
    /// How many.
    pub light_count: usize,
    /// Radiance of what lies behind the scene, without the medium, W/sr/m2: red, green and blue of each of 9 coefficients
    /// of spherical harmonics, in right-handed axes with +Y up. Null: darkness. Some needs `environment` in the settings.
    pub environment: *const f64,
    /// How far its light comes through the medium, in the host's units.
    pub environment_distance: f64,
}

// SAFETY: `#[repr(C)]`, its size first, numbers and pointers; fields of 8 bytes are at multiples of 8.
unsafe impl Versioned for AirglowFogView {
    const OLDEST: usize = offset_of!(Self, environment);
}

impl AirglowFogView {
    /// The view, its lights in `lights`, which are cleared first; the pass checks the numbers.
    ///
    /// # Safety
    /// `world` points at as many bytes as it says, `lights` at as many elements as stated, `environment` at 27 values.
    pub(super) unsafe fn read(&self, kind: PhaseKind, mut lights: Vec<Light>) -> Result<View, Failure> {
        let [eye, right, up, forward] = [self.eye, self.right, self.up, self.forward].map(DVec3::from_array);
        // SAFETY: the caller's promise is ours.
        let (world, given, environment) = unsafe {
            let world = match self.world.is_null() {
                true => World::default(),
                false => versioned(self.world, "view.world")?.read()?,
            };
            let environment = match self.environment.is_null() {
                true => None,
                false => {
                    let radiance = *shared(self.environment.cast(), "view.environment")?;
                    Some(Environment { distance: self.environment_distance, radiance })
                }
            };
            (world, array(self.lights, self.light_count, "view.lights")?, environment)
        };
        lights.clear();
        lights.extend(given.iter().map(AirglowFogLight::read));
        let [g, alpha, ..] = self.phase;
        let phase = match kind {
            PhaseKind::Isotropic => Phase::Isotropic,
            PhaseKind::Polynomial => Phase::Polynomial(self.phase),
            PhaseKind::HenyeyGreenstein => Phase::HenyeyGreenstein { g },
            PhaseKind::Draine => Phase::Draine { g, alpha },
        };
        let thinning = (self.scale_height != 0.0)
            .then_some(Thinning { level: self.thinning_level, scale_height: self.scale_height });
        Ok(View {
            world,
            camera: Camera { position: eye, right, up, forward, edges: self.edges },
            medium: Medium { extinction: self.extinction, albedo: self.albedo, phase, thinning },
            lights,
            environment,
        })
    }
}

impl AirglowFogLight {
    fn read(&self) -> Light {
        let cone = Cone {
            direction: DVec3::from_array(self.cone_direction),
            inner: self.cone_inner,
            outer: self.cone_outer,
        };
        let [low, high] = [self.bounds_low, self.bounds_high].map(DVec3::from_array);
        Light {
            scatter: if self.scatter == 0.0 { 1.0 } else { self.scatter },
            radius: self.radius,
            cone: (self.cone_outer != 0.0).then_some(cone),
            range: (self.range != 0.0).then_some(self.range),
            bounds: (low != DVec3::ZERO || high != DVec3::ZERO).then_some(Bounds { low, high }),
            ..Light::point(DVec3::from_array(self.position), self.intensity)
        }
    }
}
