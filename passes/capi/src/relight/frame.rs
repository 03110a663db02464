//! What a host says of a frame: light, and what it falls on.

use std::sync::Arc;

use airglow_relight::{Environment, Frame, Instance, Light, Orientation};
use glam::DQuat;

use super::State;
use super::sky::Sky;
use crate::input::{Versioned, array};
use crate::status::Failure;

/// The light of a frame.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirglowLight {
    /// There is none: the pass is left out, and nothing is written.
    None = 0,
    /// The environment given with `airglow_relight_set_environment`.
    Environment = 1,
    /// An environment in an image of the host's, bound as `AIRGLOW_RELIGHT_RESOURCE_ENVIRONMENT`.
    EnvironmentImage = 2,
    /// SH RGB in a buffer of the host's, bound as `AIRGLOW_RELIGHT_RESOURCE_UNIFORM_LIGHT`: four floats a coefficient, the
    /// fourth unused.
    Uniform = 3,
    /// Each instance brings the light of its vertices; for `AIRGLOW_LIGHT_KIND_VERTEX`.
    Vertices = 4,
}

/// The instance brings light of each vertex, bound as `AIRGLOW_RELIGHT_RESOURCE_VERTEX_LIGHT`.
pub const AIRGLOW_INPUT_LIGHT: u32 = 1;
/// The instance brings dynamic visibility, bound as `AIRGLOW_RELIGHT_RESOURCE_VISIBILITY`.
pub const AIRGLOW_INPUT_VISIBILITY: u32 = 2;
/// The instance brings normals, bound as `AIRGLOW_RELIGHT_RESOURCE_NORMALS`.
pub const AIRGLOW_INPUT_NORMALS: u32 = 4;

/// One appearance of a mesh. Elements of arrays never grow.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowRelightInstance {
    /// The number that `airglow_relight_add_mesh` gave.
    pub mesh: u64,
    /// From object space to the world, a quaternion x, y, z, w of any length; all zero is the identity.
    pub rotation: [f64; 4],
    /// 1: the instance is mirrored; an inversion `d -> -d` follows the rotation.
    pub inverted: u32,
    /// A sum of `AIRGLOW_INPUT_...`.
    pub inputs: u32,
}

/// A frame: light, and what it falls on. The results of its instances lie one after another in a buffer of the host's.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct AirglowRelightFrame {
    /// `sizeof(AirglowRelightFrame)`.
    pub struct_size: u32,
    /// An `AirglowLight`.
    pub light: u32,
    /// Turns the light in the world, a quaternion x, y, z, w of any length; all zero is the identity.
    pub light_rotation: [f64; 4],
    /// The instances.
    pub instances: *const AirglowRelightInstance,
    /// How many.
    pub instance_count: usize,
    /// Of an environment in an image of the host's: texels of a row.
    pub environment_width: u32,
    /// Of an environment in an image of the host's: rows.
    pub environment_height: u32,
    /// Of an environment in an image of the host's: a number that changes with its contents, below 2^63; it is projected
    /// only when the number changes.
    pub environment_revision: u64,
}

// SAFETY: `#[repr(C)]`, its size first, numbers and a pointer; fields of 8 bytes are at multiples of 8.
unsafe impl Versioned for AirglowRelightFrame {
    const OLDEST: usize = size_of::<Self>();
}

/// Revisions of environments given as texels have this bit, so that they differ from those of a host's images.
const TEXELS: u64 = 1 << 63;

/// A frame whose resources have no names yet; those come with the bindings or the graph.
pub(super) struct Read {
    pub frame: Frame<(), ()>,
    pub sky: Option<Arc<Sky>>,
}

/// # Safety
/// The instances of `frame` are as many as it says.
pub(super) unsafe fn read(state: &State, frame: &AirglowRelightFrame) -> Result<Read, Failure> {
    // SAFETY: the caller's promise is ours.
    let given = unsafe { array(frame.instances, frame.instance_count, "instances")? };
    let instance = |given: &AirglowRelightInstance| {
        let has = |input| (given.inputs & input != 0).then_some(());
        if given.inputs & !(AIRGLOW_INPUT_LIGHT | AIRGLOW_INPUT_VISIBILITY | AIRGLOW_INPUT_NORMALS) != 0 {
            return Err(Failure::argument("inputs", "give a sum of AIRGLOW_INPUT_ values"));
        }
        let mut instance = Instance::new(state.mesh(given.mesh)?);
        instance.orientation = orientation(given.rotation, given.inverted);
        instance.light = has(AIRGLOW_INPUT_LIGHT);
        instance.visibility = has(AIRGLOW_INPUT_VISIBILITY);
        instance.normals = has(AIRGLOW_INPUT_NORMALS);
        Ok(instance)
    };
    let instances = given.iter().map(instance).collect::<Result<_, _>>()?;
    let (light, sky) = light(state, frame)?;
    Ok(Read { frame: Frame { light, instances, target: Some(()) }, sky })
}

/// The light, and the environment of the library's own that it comes from.
type SkyLight = (Light<(), ()>, Option<Arc<Sky>>);

fn light(state: &State, frame: &AirglowRelightFrame) -> Result<SkyLight, Failure> {
    const ENVIRONMENT: u32 = AirglowLight::Environment as u32;
    const IMAGE: u32 = AirglowLight::EnvironmentImage as u32;
    const UNIFORM: u32 = AirglowLight::Uniform as u32;
    const VERTICES: u32 = AirglowLight::Vertices as u32;
    let rotation = quaternion(frame.light_rotation);
    let environment = |[width, height]: [u32; 2], revision| {
        Light::Environment(Environment { image: (), width, height, revision, rotation })
    };
    Ok(match frame.light {
        0 => (Light::None, None),
        ENVIRONMENT => {
            let problem = "there is no environment: call airglow_relight_set_environment first";
            let sky = state.sky.clone().ok_or_else(|| Failure::argument("light", problem))?;
            (environment(sky.size(), TEXELS | sky.revision), Some(sky))
        }
        IMAGE => {
            let size = [frame.environment_width, frame.environment_height];
            (environment(size, frame.environment_revision & !TEXELS), None)
        }
        UNIFORM => (Light::Uniform { coefficients: (), rotation }, None),
        VERTICES => (Light::Vertices, None),
        _ => return Err(Failure::argument("light", "give an AirglowLight")),
    })
}

/// A quaternion of the host; all zero is the identity.
pub(super) fn quaternion(value: [f64; 4]) -> DQuat {
    if value == [0.0; 4] { DQuat::IDENTITY } else { DQuat::from_array(value) }
}

/// An orientation of the host.
pub(super) fn orientation(rotation: [f64; 4], inverted: u32) -> Orientation {
    Orientation { rotation: quaternion(rotation), inverted: inverted != 0 }
}
