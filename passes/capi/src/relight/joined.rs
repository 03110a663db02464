//! What other passes hand to this one, through C: light of each vertex by near emitters, and dynamic visibility under moving
//! spheres. The kit holds the frame to the bits of the Rust road, whose passes meet in one graph.

use std::mem::zeroed;
use std::ptr::null;

use airglow_conformance::{Declared, Given, HostDevice, HostResource, Refusal, Room, conform_on};
use airglow_gpu::ash::vk::BufferUsageFlags as Usage;
use airglow_gpu::{Context, Options, Recorder, Requirements};
use airglow_graph::Access;
use airglow_radiance::{Part, Radiance, Receiver};
use airglow_relight::{Frame, Instance, Light, MeshId, Relight};
use airglow_shadow::{Blockers, Receivers, Shadow};
use glam::DMat4;

use crate::access::Number;
use crate::checks::ground;
use crate::pass::Settings as _;
use crate::prepared::{AirglowPrepared, airglow_prepared_make_scratch};
use crate::radiance::conformance::{self as radiance, LIGHTS, ORDER};
use crate::radiance::prepared::AirglowRadianceResource as Emitted;
use crate::relight::checked::{made, numbers};
use crate::relight::frame::*;
use crate::relight::prepared::airglow_relight_prepare;
use crate::relight::resources::AirglowRelightResource as Relit;
use crate::relight::settings::{AirglowLightKind, AirglowRelightSettings};
use crate::relight::{airglow_relight_add_mesh, airglow_relight_require};
use crate::shadow::conformance::{self as shadow, SPHERES};
use crate::shadow::prepared::AirglowShadowResource as Shadowed;
use crate::through_c::{ThroughC, attempt, ends, record};

const LIGHT: Number = (Emitted::VertexLight as u32, 0);
const POSITIONS: Number = (Shadowed::Positions as u32, 0);
const VISIBILITY: Number = (Shadowed::Visibility as u32, 0);
const RECORDS: Number = (Shadowed::Records as u32, 0);
/// What relighting takes of them, and what it gives.
const RELIGHT: [Number; 3] =
    [(Relit::VertexLight as u32, 0), (Relit::Visibility as u32, 0), (Relit::Results as u32, 0)];

fn settings() -> AirglowRelightSettings {
    AirglowRelightSettings {
        struct_size: size_of::<AirglowRelightSettings>() as u32,
        order: ORDER as u32,
        light: AirglowLightKind::Vertex as u32,
        visibility: 1,
        // SAFETY: zero bytes are valid settings.
        ..unsafe { zeroed() }
    }
}

/// What a device must have for it.
pub(super) fn requirements() -> Result<Requirements, Refusal> {
    let settings = settings().read().map_err(|failure| failure.message)?;
    let others = Shadow::requirements().and(&Radiance::requirements(&radiance::rust_settings()));
    Ok(Relight::requirements(&settings).and(&others))
}

/// The three passes by Rust.
struct ByRust {
    radiance: Radiance,
    receiver: Receiver,
    shadow: Shadow,
    receivers: Receivers,
    relight: Relight,
    mesh: MeshId,
}

/// The same by the exported functions, as frames: emitters, spheres, and what relighting makes of both.
struct ByC {
    emitted: *mut AirglowPrepared,
    shadowed: *mut AirglowPrepared,
    relit: *mut AirglowPrepared,
    _made: ThroughC,
}

struct Both {
    by_rust: ByRust,
    by_c: ByC,
}

fn vectors() -> Vec<f32> {
    numbers(ORDER * ORDER * ground().len(), 0.7)
}

impl ByRust {
    fn new(context: &Context) -> Result<Self, Refusal> {
        let ground = ground();
        let whole = Part { vertices: 0..ground.len() as u32, turn: None };
        let shadow = Shadow::new(context, shadow::rust_settings())?;
        let settings = settings().read().map_err(|failure| failure.message)?;
        let mut relight = Relight::new(context, settings)?;
        let mesh = relight.add_mesh(context, "ground", ground.len() as u32, Some(&vectors()))?;
        Ok(Self {
            radiance: Radiance::new(context, radiance::rust_settings())?,
            receiver: radiance::receiver(context, &[whole])?,
            receivers: shadow.receivers(context, "ground", &ground)?,
            shadow,
            relight,
            mesh,
        })
    }
}

impl ByC {
    fn new(host: &HostDevice<'_>) -> Result<Self, Refusal> {
        let settings = settings();
        let mut through_c = ThroughC::adopt(host, |asked| {
            radiance::ask(asked)?;
            shadow::ask(asked)?;
            attempt!(airglow_relight_require, asked, &raw const settings)
        })?;
        let emitters = radiance::in_c(&mut through_c, &[])?;
        let emitted = radiance::prepare(&mut through_c, emitters)?;
        let spheres = shadow::in_c(&mut through_c)?;
        let shadowed = shadow::prepare(&mut through_c, spheres)?;
        let relight = made(&mut through_c, &settings)?;
        let inputs = AIRGLOW_INPUT_LIGHT | AIRGLOW_INPUT_VISIBILITY;
        // SAFETY: zero bytes are a valid instance.
        let mut instance = AirglowRelightInstance { inputs, ..unsafe { zeroed() } };
        let (vectors, vertices) = (vectors(), ground().len() as u32);
        let (values, count, mesh) = (vectors.as_ptr(), vectors.len(), &raw mut instance.mesh);
        attempt!(airglow_relight_add_mesh, relight, null(), vertices, values, count, mesh)?;
        let frame = AirglowRelightFrame {
            struct_size: size_of::<AirglowRelightFrame>() as u32,
            light: AirglowLight::Vertices as u32,
            instances: &raw const instance,
            instance_count: 1,
            // SAFETY: zero bytes are a valid frame.
            ..unsafe { zeroed() }
        };
        let frame = &raw const frame;
        let relit =
            through_c.prepare(|prepared| attempt!(airglow_relight_prepare, relight, frame, prepared))?;
        attempt!(airglow_prepared_make_scratch, relit)?;
        Ok(Self { emitted, shadowed, relit, _made: through_c })
    }

    /// The host's own barrier from what a pass writes to what relighting reads.
    fn hand_over(
        &self,
        recorder: &mut Recorder<'_>,
        from: (*mut AirglowPrepared, Number),
        to: Number,
    ) -> Result<(), Refusal> {
        let (written, read) = (ends(from.0, &[from.1])?[0], ends(self.relit, &[to])?[0]);
        let (Some((_, written)), Some((read, _))) = (written, read) else {
            return Err("a pass does not list what it hands over".into());
        };
        Ok(recorder.memory_barrier(written, read)?)
    }
}

impl Room for Both {
    fn requirements(&self) -> Requirements {
        let ByRust { radiance, relight, .. } = &self.by_rust;
        let others = Shadow::requirements().and(&Radiance::requirements(radiance.settings()));
        Relight::requirements(relight.settings()).and(&others)
    }

    fn resources(&self) -> Vec<HostResource> {
        let (read, write) = (Access::ComputeStorageRead, Access::ComputeStorageWrite);
        let positions = ground().into_iter().flatten().flat_map(f32::to_le_bytes).collect();
        let results = |name, bytes| HostResource::results(name, bytes, Usage::STORAGE_BUFFER, [write, read]);
        let ByRust { receivers, radiance, .. } = &self.by_rust;
        let vertices = u64::from(receivers.count());
        vec![
            HostResource::buffer("positions", positions, Usage::STORAGE_BUFFER, [read; 2]),
            results("light", radiance.settings().light_bytes() * vertices),
            results("visibility", receivers.visibility_bytes(ORDER)),
            results("records", receivers.record_bytes()),
            results("colours", 16 * vertices),
        ]
    }

    fn add(&mut self, to: &mut Declared<'_>) -> Result<(), Refusal> {
        let ByRust { radiance, receiver, shadow, receivers, relight, mesh } = &mut self.by_rust;
        let light = radiance.add(to.graph, to.imports, receiver, &LIGHTS)?.light.pop();
        let blockers = Blockers::default();
        blockers.set(&SPHERES, DMat4::IDENTITY)?;
        let positions = to.buffer(0)?;
        let shadowed = shadow.add(to.graph, receivers, &blockers, positions, None);
        let instance = Instance { light, visibility: shadowed.visibility, ..Instance::new(*mesh) };
        let target = Some(to.buffer(4)?);
        let frame = Frame { light: Light::Vertices, instances: vec![instance], target };
        relight.add(to.context, to.graph, to.imports, &frame)?;
        to.keep(light.ok_or("there is no light")?, 1)?;
        to.keep(shadowed.visibility.ok_or("nothing blocks")?, 2)?;
        to.keep(shadowed.records.ok_or("nothing blocks")?, 3)
    }

    fn accesses(&mut self, _: &Context) -> Result<Vec<Option<(Access, Access)>>, Refusal> {
        let ByC { emitted, shadowed, relit, .. } = &self.by_c;
        let shadowed = ends(*shadowed, &[POSITIONS, VISIBILITY, RECORDS])?;
        let (emitted, relit) = (ends(*emitted, &[LIGHT])?[0], ends(*relit, &RELIGHT)?);
        let through = |first: Option<(Access, _)>, last: Option<(_, Access)>| Some((first?.0, last?.1));
        Ok(vec![
            shadowed[0],
            through(emitted, relit[0]),
            through(shadowed[1], relit[1]),
            shadowed[2],
            relit[2],
        ])
    }

    fn record(&mut self, recorder: &mut Recorder<'_>, host: &[Given]) -> Result<(), Refusal> {
        let [positions, light, visibility, records, colours] = host else {
            return Err("other resources".into());
        };
        let ByC { emitted, shadowed, relit, .. } = &self.by_c;
        record(*emitted, recorder, [(LIGHT, light)])?;
        let bound = [(POSITIONS, positions), (VISIBILITY, visibility), (RECORDS, records)];
        record(*shadowed, recorder, bound)?;
        self.by_c.hand_over(recorder, (*emitted, LIGHT), RELIGHT[0])?;
        self.by_c.hand_over(recorder, (*shadowed, VISIBILITY), RELIGHT[1])?;
        record(*relit, recorder, RELIGHT.into_iter().zip([light, visibility, colours]))
    }
}

/// What the kit holds the three to, in a row.
pub(super) fn check(host: &HostDevice<'_>) -> Result<(), Refusal> {
    let make = |context: &Context, host: &HostDevice<'_>| {
        Ok(Both { by_rust: ByRust::new(context)?, by_c: ByC::new(host)? })
    };
    // SAFETY: whoever runs the kit vouches for the device and its queue.
    let outputs = unsafe { conform_on(host, &requirements()?, &Options::default(), make)? };
    let colours = outputs[4].chunks_exact(16);
    let lit = colours.filter(|colour| colour[12..] == 1f32.to_le_bytes() && colour[..4] != [0; 4]).count();
    // Few rays of far vertices miss the lamp.
    match 10 * lit >= 9 * ground().len() {
        true => Ok(()),
        false => Err(format!("{lit} of {} vertices are lit", ground().len()).into()),
    }
}
