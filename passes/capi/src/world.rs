//! A host's conventions, stated once.

use airglow_math::World;
use airglow_math::world::{Axes, Axis, Depth, NormalMapGreen, Winding};
use glam::DVec3;

use crate::input::{Versioned, versioned};
use crate::status::{AirglowError, AirglowStatus, Failure, edge};

/// One of the six directions along a host's axes.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowAxis {
    /// As airglow has it: +X right, +Y up, -Z forward.
    Default = 0,
    /// +X.
    PlusX = 1,
    /// -X.
    MinusX = 2,
    /// +Y.
    PlusY = 3,
    /// -Y.
    MinusY = 4,
    /// +Z.
    PlusZ = 5,
    /// -Z.
    MinusZ = 6,
}

/// A host's conventions: axes, units, winding, depth, exposure. All zero is airglow's own: metres, right-handed, +Y up,
/// -Z forward, counter-clockwise fronts.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowWorld {
    /// `sizeof(AirglowWorld)`.
    pub struct_size: u32,
    /// What points to the right of an upright viewer who looks forward, an `AirglowAxis`. The three lie along different
    /// lines; which hand they are follows from them.
    pub right: u32,
    /// What points up, an `AirglowAxis`.
    pub up: u32,
    /// What points forward, an `AirglowAxis`.
    pub forward: u32,
    /// 1: front faces wind clockwise in the picture.
    pub front_face_clockwise: u32,
    /// 1: green of normal maps points down the texture, along v.
    pub normal_map_green_down: u32,
    /// 1: depth is 1 near and 0 far.
    pub depth_reversed: u32,
    /// 1: the projection is orthographic.
    pub depth_orthographic: u32,
    /// Length of the unit in metres; 0 is 1.
    pub metres_per_unit: f64,
    /// View distance of the near plane, in units; 0 is 0.1.
    pub depth_near: f64,
    /// View distance of the far plane, in units; infinity for an infinite perspective, 0 is 1000.
    pub depth_far: f64,
    /// Pixels by which the projection shifts the picture, right and down.
    pub jitter: [f64; 2],
    /// What colours are multiplied with before they are stored; 0 is 1. Radiance that comes in is not multiplied yet.
    pub pre_exposure: f64,
    /// Where the zero of the positions that the host gives lies in its world, in its axes and units.
    pub origin: [f64; 3],
    /// Views of a frame; 0 is 1.
    pub views: u32,
    /// Not used; 0.
    pub reserved: u32,
}

// SAFETY: `#[repr(C)]`, its size first, numbers; fields of 8 bytes are at multiples of 8.
unsafe impl Versioned for AirglowWorld {
    const OLDEST: usize = size_of::<Self>();
}

impl AirglowWorld {
    /// The conventions, checked.
    pub(crate) fn read(&self) -> Result<World, Failure> {
        let refuse = |error: airglow_math::MathError| Failure::argument("world", &error.to_string());
        let own = World::default();
        let or = |value: f64, default: f64| if value == 0.0 { default } else { value };
        let flag = |name, value| match value {
            0 | 1 => Ok(value == 1),
            _ => Err(Failure::argument(name, &format!("it is {value}: give 0 or 1"))),
        };
        let world = World {
            axes: Axes::new(
                axis(self.right, Axis::PlusX)?,
                axis(self.up, Axis::PlusY)?,
                axis(self.forward, Axis::MinusZ)?,
            )
            .map_err(refuse)?,
            metres_per_unit: or(self.metres_per_unit, own.metres_per_unit),
            front_face: match flag("front_face_clockwise", self.front_face_clockwise)? {
                true => Winding::Clockwise,
                false => Winding::CounterClockwise,
            },
            normal_map_green: match flag("normal_map_green_down", self.normal_map_green_down)? {
                true => NormalMapGreen::Down,
                false => NormalMapGreen::Up,
            },
            depth: Depth {
                reversed: flag("depth_reversed", self.depth_reversed)?,
                near: or(self.depth_near, own.depth.near),
                far: match self.depth_far {
                    0.0 => own.depth.far,
                    f64::INFINITY => None,
                    far => Some(far),
                },
                orthographic: flag("depth_orthographic", self.depth_orthographic)?,
            },
            jitter: self.jitter,
            pre_exposure: or(self.pre_exposure, own.pre_exposure),
            origin: DVec3::from_array(self.origin),
            views: self.views.max(1),
        };
        world.check().map_err(refuse)?;
        Ok(world)
    }
}

fn axis(value: u32, default: Axis) -> Result<Axis, Failure> {
    use Axis::{MinusX, MinusY, MinusZ, PlusX, PlusY, PlusZ};
    let axes = [default, PlusX, MinusX, PlusY, MinusY, PlusZ, MinusZ];
    let problem = || format!("it is {value}: give an AirglowAxis");
    axes.get(value as usize).copied().ok_or_else(|| Failure::argument("an axis", &problem()))
}

/// Refuses what no host can mean, with the reason; passes refuse it, too.
///
/// # Safety
/// `world` points at as many bytes as it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_world_check(
    world: *const AirglowWorld,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe { edge(error, || versioned(world, "world")?.read().map(drop)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn zero() -> AirglowWorld {
        // SAFETY: zero bytes are a valid world.
        AirglowWorld { struct_size: size_of::<AirglowWorld>() as u32, ..unsafe { std::mem::zeroed() } }
    }

    #[test]
    fn zero_is_airglow_s_own_and_every_field_arrives() {
        assert_eq!(zero().read().unwrap(), World::default());
        let unreal = AirglowWorld {
            right: AirglowAxis::PlusY as u32,
            up: AirglowAxis::PlusZ as u32,
            forward: AirglowAxis::PlusX as u32,
            front_face_clockwise: 1,
            normal_map_green_down: 1,
            depth_reversed: 1,
            metres_per_unit: 0.01,
            depth_near: 10.0,
            depth_far: f64::INFINITY,
            jitter: [0.25, -0.5],
            pre_exposure: 0.37,
            origin: [1.0, 2.0, 3.0],
            views: 2,
            ..zero()
        };
        let expected = World {
            axes: Axes::Z_UP_LEFT_HANDED,
            metres_per_unit: 0.01,
            front_face: Winding::Clockwise,
            normal_map_green: NormalMapGreen::Down,
            depth: Depth { reversed: true, near: 10.0, far: None, orthographic: false },
            jitter: [0.25, -0.5],
            pre_exposure: 0.37,
            origin: DVec3::new(1.0, 2.0, 3.0),
            views: 2,
        };
        assert_eq!(unreal.read().unwrap(), expected);
    }

    #[test]
    fn what_no_host_can_mean_is_refused() {
        for (wrong, word) in [
            (AirglowWorld { up: 7, ..zero() }, "AirglowAxis"),
            (AirglowWorld { up: AirglowAxis::MinusX as u32, ..zero() }, "MinusX"),
            (AirglowWorld { depth_reversed: 2, ..zero() }, "depth_reversed"),
            (AirglowWorld { metres_per_unit: -1.0, ..zero() }, "metres"),
            (AirglowWorld { pre_exposure: f64::NAN, ..zero() }, "pre-exposure"),
            (AirglowWorld { depth_far: 0.01, ..zero() }, "far plane"),
            (AirglowWorld { origin: [f64::INFINITY; 3], ..zero() }, "origin"),
        ] {
            let said = wrong.read().unwrap_err().message;
            assert!(said.contains(word), "{said}");
        }
    }
}
