//! The pass inside a host: by the graph from Rust, by accesses and record from C. The kit holds both to the same bits and
//! state.

use std::mem::zeroed;
use std::ptr::{null, null_mut};

use airglow_conformance::{Declared, Given, HostDevice, HostResource, Outputs, Refusal, Room, conform_on};
use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{Context, Options, Recorder, Requirements};
use airglow_graph::Access;
use airglow_shadow::{ACCESSES, Blockers, Receivers, Settings, Shadow, Sphere};
use glam::{DMat4, DVec3};

use crate::access::Number;
use crate::checks::{Checks, ground};
use crate::prepared::AirglowPrepared;
use crate::requirements::AirglowRequirements;
use crate::shadow::prepared::{
    AirglowShadowResource, AirglowSphere, airglow_shadow_prepare, airglow_shadow_set,
};
use crate::shadow::settings::AirglowShadowSettings;
use crate::shadow::{
    AirglowShadow, AirglowShadowReceivers, airglow_shadow_drop, airglow_shadow_new,
    airglow_shadow_receivers_drop, airglow_shadow_receivers_new, airglow_shadow_require,
};
use crate::through_c::{ThroughC, attempt, ends, record};

/// The least that has a kernel: compiling it is most of the time.
pub(crate) const ORDER: usize = 3;
pub(crate) const RESOURCES: [Number; 3] = [
    (AirglowShadowResource::Positions as u32, 0),
    (AirglowShadowResource::Visibility as u32, 0),
    (AirglowShadowResource::Records as u32, 0),
];
/// One that hangs over the ground, one that no one is to see for its distance.
pub(crate) const SPHERES: [Sphere; 2] = [
    Sphere { center: DVec3::new(3.0, 1.0, 2.0), radius: 0.7 },
    Sphere { center: DVec3::new(5.0, 90000.0, 6.0), radius: 0.01 },
];

pub(crate) fn rust_settings() -> Settings {
    Settings { order: ORDER, ..Settings::default() }
}

pub(crate) fn settings() -> AirglowShadowSettings {
    let (struct_size, order) = (size_of::<AirglowShadowSettings>() as u32, ORDER as u32);
    // SAFETY: zero bytes are valid settings.
    AirglowShadowSettings { struct_size, order, ..unsafe { zeroed() } }
}

pub(crate) fn spheres() -> [AirglowSphere; 2] {
    SPHERES.map(|sphere| AirglowSphere { center: sphere.center.to_array(), radius: sphere.radius })
}

/// The pass made by the exported functions, and the receivers of the ground.
pub(crate) fn in_c(
    through_c: &mut ThroughC,
) -> Result<(*mut AirglowShadow, *mut AirglowShadowReceivers), Refusal> {
    let (settings, context, ground) = (settings(), through_c.context, ground());
    let settings = &raw const settings;
    let shadow = through_c
        .hold(airglow_shadow_drop, |shadow| attempt!(airglow_shadow_new, context, settings, shadow))?;
    let (name, positions, count) = (c"ground".as_ptr(), ground.as_ptr().cast(), ground.len());
    let receivers = through_c.hold(airglow_shadow_receivers_drop, |receivers| {
        attempt!(airglow_shadow_receivers_new, shadow, name, positions, count, receivers)
    })?;
    Ok((shadow, receivers))
}

/// A frame with both spheres.
pub(crate) fn prepare(
    through_c: &mut ThroughC,
    (shadow, receivers): (*mut AirglowShadow, *mut AirglowShadowReceivers),
) -> Result<*mut AirglowPrepared, Refusal> {
    let prepared =
        through_c.prepare(|prepared| attempt!(airglow_shadow_prepare, shadow, receivers, prepared))?;
    let spheres = spheres();
    attempt!(airglow_shadow_set, prepared, spheres.as_ptr(), spheres.len(), null(), null_mut())?;
    Ok(prepared)
}

/// Asks for what the pass needs.
pub(crate) fn ask(asked: *mut AirglowRequirements) -> Result<(), Refusal> {
    let settings = settings();
    attempt!(airglow_shadow_require, asked, &raw const settings)
}

/// The pass twice: made by Rust, and made by the exported functions.
struct Both {
    shadow: Shadow,
    receivers: Receivers,
    through_c: ThroughC,
    in_c: (*mut AirglowShadow, *mut AirglowShadowReceivers),
    prepared: *mut AirglowPrepared,
}

impl Both {
    fn new(context: &Context, host: &HostDevice<'_>) -> Result<Self, Refusal> {
        let shadow = Shadow::new(context, rust_settings())?;
        let receivers = shadow.receivers(context, "ground", &ground())?;
        let mut through_c = ThroughC::adopt(host, ask)?;
        let in_c = in_c(&mut through_c)?;
        Ok(Self { shadow, receivers, through_c, in_c, prepared: null_mut() })
    }
}

impl Room for Both {
    fn requirements(&self) -> Requirements {
        Shadow::requirements()
    }

    fn resources(&self) -> Vec<HostResource> {
        let [(_, read), _, (_, write), _] = ACCESSES;
        let positions = ground().into_iter().flatten().flat_map(f32::to_le_bytes).collect();
        let (usage, ends) = (BufferUsageFlags::STORAGE_BUFFER, [write, read]);
        let visibility = self.receivers.visibility_bytes(ORDER);
        vec![
            HostResource::buffer("positions", positions, usage, [read; 2]),
            HostResource::results("visibility", visibility, usage, ends),
            HostResource::results("records", self.receivers.record_bytes(), usage, ends),
        ]
    }

    fn add(&mut self, to: &mut Declared<'_>) -> Result<(), Refusal> {
        let (positions, blockers) = (to.buffer(0)?, Blockers::default());
        blockers.set(&SPHERES, DMat4::IDENTITY)?;
        let shadowed = self.shadow.add(to.graph, &self.receivers, &blockers, positions, None);
        to.keep(shadowed.visibility.ok_or("nothing blocks")?, 1)?;
        to.keep(shadowed.records.ok_or("nothing blocks")?, 2)
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
    requirements: || Ok(Shadow::requirements()),
    checks: &[(c"shadow: a sphere over a plane", |host| {
        // SAFETY: whoever runs the kit vouches for the device and its queue.
        check_lit(&unsafe { conform_on(host, &Shadow::requirements(), &Options::default(), Both::new)? })
    })],
};

/// Vertices see something, below the sphere less than far from it.
fn check_lit(outputs: &Outputs) -> Result<(), Refusal> {
    let values: Vec<f32> = outputs[1].as_chunks().0.iter().map(|word| f32::from_le_bytes(*word)).collect();
    let mean = |vertex: usize| values[ORDER * ORDER * vertex];
    let (below, far) = (mean(2 * 20 + 3), mean(299));
    match 0.5 < below && below + 0.2 < far && far < 3.6 {
        true => Ok(()),
        false => Err(format!("vertices are not lit as they should be: {below} and {far}").into()),
    }
}
