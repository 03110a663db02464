//! The pass inside a host: by the graph from Rust, by accesses and record from C. The kit holds both to the same bits and
//! state.

use std::mem::zeroed;
use std::ops::ControlFlow;
use std::ptr::null_mut;

use airglow_conformance::{Declared, Given, HostDevice, HostResource, Outputs, Refusal, Room, conform_on};
use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{Context, Options, Recorder, Requirements};
use airglow_graph::Access;
use airglow_radiance::{Hierarchy, Lights, Part, PassSettings, Radiance, Receiver, Sphere, Triangle};
use glam::{DMat3, DVec3};

use crate::access::Number;
use crate::checks::{Checks, ground};
use crate::prepared::AirglowPrepared;
use crate::radiance::lights::{AirglowEmitter, AirglowEmitterSphere, AirglowRadianceLights};
use crate::radiance::prepared::{AirglowRadianceResource, airglow_radiance_prepare};
use crate::radiance::receiver::{
    AirglowRadiancePart, AirglowRadianceReceiver, AirglowRadianceReceiverInfo,
    airglow_radiance_receiver_drop, airglow_radiance_receiver_new,
};
use crate::radiance::settings::AirglowRadianceSettings;
use crate::radiance::{
    AirglowRadiance, airglow_radiance_drop, airglow_radiance_new, airglow_radiance_require,
};
use crate::requirements::AirglowRequirements;
use crate::through_c::{ThroughC, attempt, ends, record};

/// The least that has kernels: compiling them is most of the time.
pub(crate) const ORDER: usize = 3;
const RESOURCES: [Number; 2] =
    [(AirglowRadianceResource::VertexLight as u32, 0), (AirglowRadianceResource::VertexLight as u32, 1)];
/// Two instances: the first as it is, the second turned.
const PARTS: [[u32; 2]; 2] = [[0, 70], [70, 230]];

/// A lamp over the ground, and a ball that emits, too.
pub(crate) const LAMP: Triangle = Triangle {
    corners: [DVec3::new(2.0, 3.0, 2.0), DVec3::new(9.0, 3.0, 2.0), DVec3::new(2.0, 3.0, 9.0)],
    radiance: DVec3::new(3.0, 2.0, 1.0),
};
pub(crate) const BALL: Sphere =
    Sphere { centre: DVec3::new(15.0, 4.0, 10.0), radius: 0.5, radiance: DVec3::splat(9.0) };

/// All lights, by Rust.
pub(crate) const LIGHTS: Lights<'_> = Lights { emitters: &[LAMP], spheres: &[BALL], ..Lights::NONE };

fn turn() -> DMat3 {
    DMat3::from_rotation_x(0.4)
}

/// Settings with few samples and few kernels.
pub(crate) fn rust_settings() -> PassSettings {
    let default = PassSettings::default();
    let refinement = airglow_radiance::Settings { limit: 40, ..default.refinement };
    let (gradients, closed_forms) = (false, false);
    PassSettings { order: ORDER, gradients, rays: 1, closed_forms, keep: 0.0, refinement, ..default }
}

/// The same as C has them.
pub(crate) fn settings() -> AirglowRadianceSettings {
    AirglowRadianceSettings {
        struct_size: size_of::<AirglowRadianceSettings>() as u32,
        order: ORDER as u32,
        without_gradients: 1,
        rays: 1,
        limit: 40,
        keep: -1.0,
        without_closed_forms: 1,
        // SAFETY: zero bytes are valid settings.
        ..unsafe { zeroed() }
    }
}

/// The lamp and the ball as C has them.
pub(crate) fn emitters() -> (AirglowEmitter, AirglowEmitterSphere) {
    let corners = LAMP.corners.map(|corner| corner.to_array());
    let lamp = AirglowEmitter { corners, radiance: LAMP.radiance.to_array() };
    let center = BALL.centre.to_array();
    (lamp, AirglowEmitterSphere { center, radius: BALL.radius, radiance: BALL.radiance.to_array() })
}

/// Lights that point at them.
pub(crate) fn lights((lamp, ball): &(AirglowEmitter, AirglowEmitterSphere)) -> AirglowRadianceLights {
    AirglowRadianceLights {
        struct_size: size_of::<AirglowRadianceLights>() as u32,
        emitters: lamp,
        emitter_count: 1,
        spheres: ball,
        sphere_count: 1,
        // SAFETY: zero bytes are valid lights.
        ..unsafe { zeroed() }
    }
}

/// A receiver of those parts by Rust.
pub(crate) fn receiver(context: &Context, parts: &[Part]) -> Result<Receiver, Refusal> {
    let ground = ground();
    let tree = Hierarchy::build(&ground, &[], &mut |_, _| ControlFlow::Continue(()))?;
    Ok(Receiver::new(context, rust_settings(), &tree, &ground, parts)?)
}

/// The pass and a receiver made by the exported functions.
pub(crate) fn in_c(
    through_c: &mut ThroughC,
    parts: &[AirglowRadiancePart],
) -> Result<(*mut AirglowRadiance, *mut AirglowRadianceReceiver), Refusal> {
    let (settings, context, ground) = (settings(), through_c.context, ground());
    let settings = &raw const settings;
    let radiance = through_c.hold(airglow_radiance_drop, |radiance| {
        attempt!(airglow_radiance_new, context, settings, radiance)
    })?;
    let info = AirglowRadianceReceiverInfo {
        struct_size: size_of::<AirglowRadianceReceiverInfo>() as u32,
        positions: ground.as_ptr().cast(),
        vertex_count: ground.len(),
        parts: parts.as_ptr(),
        part_count: parts.len(),
        // SAFETY: zero bytes are a valid description.
        ..unsafe { zeroed() }
    };
    let info = &raw const info;
    let receiver = through_c.hold(airglow_radiance_receiver_drop, |receiver| {
        attempt!(airglow_radiance_receiver_new, radiance, info, receiver)
    })?;
    Ok((radiance, receiver))
}

/// A frame under both emitters.
pub(crate) fn prepare(
    through_c: &mut ThroughC,
    (radiance, receiver): (*mut AirglowRadiance, *mut AirglowRadianceReceiver),
) -> Result<*mut AirglowPrepared, Refusal> {
    let emitters = emitters();
    let lights = lights(&emitters);
    let lights = &raw const lights;
    through_c.prepare(|prepared| attempt!(airglow_radiance_prepare, radiance, receiver, lights, prepared))
}

/// Asks for what the pass needs.
pub(crate) fn ask(asked: *mut AirglowRequirements) -> Result<(), Refusal> {
    let settings = settings();
    attempt!(airglow_radiance_require, asked, &raw const settings)
}

/// The pass twice: made by Rust, and made by the exported functions.
struct Both {
    radiance: Radiance,
    receiver: Receiver,
    through_c: ThroughC,
    in_c: (*mut AirglowRadiance, *mut AirglowRadianceReceiver),
    prepared: *mut AirglowPrepared,
}

impl Both {
    fn new(context: &Context, host: &HostDevice<'_>) -> Result<Self, Refusal> {
        let turns = [None, Some(turn())];
        let parts = PARTS.into_iter().zip(turns);
        let parts = parts.map(|([first, count], turn)| Part { vertices: first..first + count, turn });
        let receiver = receiver(context, &parts.collect::<Vec<_>>())?;
        let radiance = Radiance::new(context, rust_settings())?;
        let mut through_c = ThroughC::adopt(host, ask)?;
        let turns = [[0.0; 9], turn().to_cols_array()];
        let parts = PARTS.into_iter().zip(turns);
        let parts = parts.map(|([first, count], turn)| AirglowRadiancePart { first, count, turn });
        let in_c = in_c(&mut through_c, &parts.collect::<Vec<_>>())?;
        Ok(Self { radiance, receiver, through_c, in_c, prepared: null_mut() })
    }
}

impl Room for Both {
    fn requirements(&self) -> Requirements {
        Radiance::requirements(self.radiance.settings())
    }

    fn resources(&self) -> Vec<HostResource> {
        let ends = [Access::ComputeStorageWrite, Access::ComputeStorageRead];
        let results = |(name, [_, count]): (_, [u32; 2])| {
            let bytes = rust_settings().light_bytes() * u64::from(count);
            HostResource::results(name, bytes, BufferUsageFlags::STORAGE_BUFFER, ends)
        };
        ["light of the first part", "light of the second part"].into_iter().zip(PARTS).map(results).collect()
    }

    fn add(&mut self, to: &mut Declared<'_>) -> Result<(), Refusal> {
        let lit = self.radiance.add(to.graph, to.imports, &self.receiver, &LIGHTS)?;
        (0..).zip(lit.light).try_for_each(|(place, light)| to.keep(light, place))
    }

    fn accesses(&mut self, _: &Context) -> Result<Vec<Option<(Access, Access)>>, Refusal> {
        self.prepared = prepare(&mut self.through_c, self.in_c)?;
        ends(self.prepared, &RESOURCES)
    }

    fn record(&mut self, recorder: &mut Recorder<'_>, host: &[Given]) -> Result<(), Refusal> {
        record(self.prepared, recorder, RESOURCES.into_iter().zip(host))
    }
}

/// What the kit holds the pass to.
pub(crate) const CHECKS: Checks = Checks {
    requirements: || Ok(Radiance::requirements(&rust_settings())),
    checks: &[(c"radiance: two instances under near emitters", |host| {
        let asked = Radiance::requirements(&rust_settings());
        // SAFETY: whoever runs the kit vouches for the device and its queue.
        check_lit(&unsafe { conform_on(host, &asked, &Options::default(), Both::new)? })
    })],
};

/// Vertices of both parts are lit, but for a few far ones whose few rays miss the lamp, and red is more than blue below it.
fn check_lit(outputs: &Outputs) -> Result<(), Refusal> {
    let vertices = outputs.iter().flat_map(|bytes| bytes.chunks_exact(12 * ORDER * ORDER));
    let mean = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    let means: Vec<_> = vertices.map(|light| [mean(light), mean(&light[8..])]).collect();
    let lit = means.iter().filter(|[red, blue]| red.is_finite() && *blue > 0.0).count();
    let warm = means.get(45).is_some_and(|[red, blue]| red > &(1.5 * blue));
    match warm && 10 * lit >= 9 * means.len() {
        true => Ok(()),
        false => Err(format!("{lit} of {} vertices are lit, below the lamp {warm}", means.len()).into()),
    }
}
