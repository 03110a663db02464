//! What a receiver is lit by, as a host says it.

use airglow_radiance::{Lights, Sphere, Triangle};
use glam::DVec3;

use crate::input::{Versioned, array};
use crate::status::Failure;

/// A triangle that emits the same radiance from both sides; one of radiance zero blocks light. Elements of arrays never
/// grow.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowEmitter {
    /// Three corners, metres, in the space of the receiver's positions.
    pub corners: [[f64; 3]; 3],
    /// Linear red, green and blue radiance, W/sr/m2.
    pub radiance: [f64; 3],
}

/// A sphere that emits the same radiance everywhere; one of radiance zero blocks light. Elements of arrays never grow.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowEmitterSphere {
    /// Its centre, metres, in the space of the receiver's positions.
    pub center: [f64; 3],
    /// Its radius, metres.
    pub radius: f64,
    /// Linear red, green and blue radiance, W/sr/m2.
    pub radiance: [f64; 3],
}

/// What a receiver is lit by.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowRadianceLights {
    /// `sizeof(AirglowRadianceLights)`.
    pub struct_size: u32,
    /// Not used; 0.
    pub reserved: u32,
    /// Triangles that emit or block.
    pub emitters: *const AirglowEmitter,
    /// How many.
    pub emitter_count: usize,
    /// Spheres that emit or block.
    pub spheres: *const AirglowEmitterSphere,
    /// How many.
    pub sphere_count: usize,
    /// Light from far away about the axes of that space, which every vertex gets as well: red, green and blue of each of
    /// `order^2` coefficients of spherical harmonics. Null for none.
    pub distant: *const f32,
    /// Coefficients of it: `order^2`, or 0.
    pub distant_count: usize,
}

// SAFETY: `#[repr(C)]`, its size first, integers and pointers; fields of 8 bytes are at multiples of 8.
unsafe impl Versioned for AirglowRadianceLights {
    const OLDEST: usize = size_of::<Self>();
}

/// Emitters of the host's.
pub(super) struct Given<'a> {
    emitters: Vec<Triangle>,
    spheres: Vec<Sphere>,
    distant: &'a [[f32; 3]],
}

impl Given<'_> {
    pub(super) fn lights(&self) -> Lights<'_> {
        Lights { emitters: &self.emitters, spheres: &self.spheres, distant: self.distant, ..Lights::NONE }
    }
}

impl AirglowRadianceLights {
    /// # Safety
    /// Its arrays have as many elements as it says, which live as long as the result.
    pub(super) unsafe fn read<'a>(&self) -> Result<Given<'a>, Failure> {
        let triangle = |emitter: &AirglowEmitter| Triangle {
            corners: emitter.corners.map(DVec3::from_array),
            radiance: DVec3::from_array(emitter.radiance),
        };
        let sphere = |sphere: &AirglowEmitterSphere| Sphere {
            centre: DVec3::from_array(sphere.center),
            radius: sphere.radius,
            radiance: DVec3::from_array(sphere.radiance),
        };
        // SAFETY: the caller's promise is ours.
        unsafe {
            Ok(Given {
                emitters: emitters(self.emitters, self.emitter_count, "lights.emitters", triangle)?,
                spheres: emitters(self.spheres, self.sphere_count, "lights.spheres", sphere)?,
                distant: array(self.distant.cast(), self.distant_count, "lights.distant")?,
            })
        }
    }
}

/// A count from memory never set is refused before it is copied; samples of so many would take a second each.
const MOST_EMITTERS: usize = 1 << 20;

/// # Safety
/// As [`array`].
unsafe fn emitters<T, E>(
    pointer: *const T,
    count: usize,
    name: &str,
    read: impl Fn(&T) -> E,
) -> Result<Vec<E>, Failure> {
    if count > MOST_EMITTERS {
        return Err(Failure::argument(name, &format!("{count} are more than {MOST_EMITTERS}")));
    }
    // SAFETY: the caller's promise is ours.
    Ok(unsafe { array(pointer, count, name)? }.iter().map(read).collect())
}
