//! The pass inside a host: by the graph from Rust, by accesses and record from C. The kit holds both to the same bits,
//! layouts and state.

use std::mem::zeroed;
use std::ptr;

use airglow_conformance::{Declared, Given, HostDevice, HostResource, Outputs, Refusal, Room, conform_on};
use airglow_gpu::ash::vk::{BufferUsageFlags as Usage, Format, ImageUsageFlags};
use airglow_gpu::{Context, Options, Recorder, Requirements};
use airglow_graph::{Access, ImageDesc};
use airglow_relight::{Environment, Frame, Instance, Light, MeshId, Relight, Settings};
use glam::DQuat;

use crate::access::Number;
use crate::checks::Checks;
use crate::pass::Settings as _;
use crate::prepared::{AirglowPrepared, airglow_prepared_make_scratch};
use crate::relight::checked::{made, numbers};
use crate::relight::frame::{AirglowLight, AirglowRelightFrame, AirglowRelightInstance};
use crate::relight::prepared::airglow_relight_prepare;
use crate::relight::resources::AirglowRelightResource;
use crate::relight::settings::AirglowRelightSettings;
use crate::relight::{
    AirglowRelight, airglow_relight_add_mesh, airglow_relight_require, airglow_relight_set_environment,
    airglow_relight_set_world,
};
use crate::status::Failure;
use crate::through_c::{ThroughC, attempt, ends, record};
use crate::world::{AirglowAxis, AirglowWorld};

const WIDTH: u32 = 32;
const HEIGHT: u32 = 16;
const VERTICES: u32 = 1500;
/// About +Y by 0.7.
const ROTATION: [f64; 4] = [0.0, 0.342_897_807_455_451_34, 0.0, 0.939_372_712_847_378_9];

fn sky() -> Vec<[f32; 3]> {
    numbers((3 * WIDTH * HEIGHT) as usize, 0.3).chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()
}

/// Method, whether the library gets the sky as texels, the host's world.
pub(crate) type Case<'a> = (u32, bool, Option<&'a AirglowWorld>);

/// The host's resources that it uses.
const RESOURCES: [Number; 2] =
    [(AirglowRelightResource::Environment as u32, 0), (AirglowRelightResource::Results as u32, 0)];

/// The pass twice: made by Rust, and made by the exported functions.
pub(crate) struct Both {
    relight: Relight,
    mesh: MeshId,
    through_c: ThroughC,
    in_c: *mut AirglowRelight,
    instance: AirglowRelightInstance,
    prepared: *mut AirglowPrepared,
    /// Whether the library gets the sky as texels, in place of the host's image.
    texels: bool,
}

impl Both {
    pub(crate) fn new(
        context: &Context,
        host: &HostDevice<'_>,
        (method, texels, world): Case<'_>,
    ) -> Result<Self, Refusal> {
        let settings = settings(method);
        let vectors = numbers(16 * VERTICES as usize, 0.7);
        let mut relight = Relight::new(context, read(&settings)?)?;
        let mesh = relight.add_mesh(context, "mesh", VERTICES, Some(&vectors))?;
        let (through_c, in_c) = in_c(host, &settings)?;
        // SAFETY: zero bytes are a valid instance.
        let mut instance: AirglowRelightInstance = unsafe { zeroed() };
        let (name, values, mesh_number) = (c"mesh".as_ptr(), vectors.as_ptr(), &raw mut instance.mesh);
        attempt!(airglow_relight_add_mesh, in_c, name, VERTICES, values, vectors.len(), mesh_number)?;
        if let Some(world) = world {
            relight.set_world(world.read().map_err(said)?)?;
            attempt!(airglow_relight_set_world, in_c, world)?;
        }
        if texels {
            attempt!(airglow_relight_set_environment, in_c, WIDTH, HEIGHT, sky().as_ptr().cast())?;
        }
        Ok(Self { relight, mesh, through_c, in_c, instance, prepared: ptr::null_mut(), texels })
    }
}

/// The pass made by the exported functions.
pub(crate) fn in_c(
    host: &HostDevice<'_>,
    settings: &AirglowRelightSettings,
) -> Result<(ThroughC, *mut AirglowRelight), Refusal> {
    let asked = |asked| attempt!(airglow_relight_require, asked, settings);
    let mut through_c = ThroughC::adopt(host, asked)?;
    let relight = made(&mut through_c, settings)?;
    Ok((through_c, relight))
}

impl Room for Both {
    fn requirements(&self) -> Requirements {
        Relight::requirements(self.relight.settings())
    }

    fn resources(&self) -> Vec<HostResource> {
        let desc = ImageDesc {
            usage: ImageUsageFlags::SAMPLED,
            ..ImageDesc::new_2d(WIDTH, HEIGHT, Format::R32G32B32A32_SFLOAT)
        };
        let texels = sky().into_iter().flat_map(|[r, g, b]| [r, g, b, 1.0]);
        let texels = texels.flat_map(f32::to_le_bytes).collect();
        let (usage, bytes) = (Usage::STORAGE_BUFFER | Usage::VERTEX_BUFFER, 16 * u64::from(VERTICES));
        let colours = [Access::ComputeStorageReadWrite, Access::VertexBuffer];
        vec![
            HostResource::image("sky", desc, texels, [Access::FragmentSampled; 2]),
            HostResource::results("vertex colours", bytes, usage, colours),
        ]
    }

    fn add(&mut self, to: &mut Declared<'_>) -> Result<(), Refusal> {
        let (image, results) = (to.image(0)?, to.buffer(1)?);
        let rotation = DQuat::from_array(ROTATION);
        let environment = Environment { image, width: WIDTH, height: HEIGHT, revision: 1, rotation };
        let light = Light::Environment(environment);
        let frame = Frame { light, instances: vec![Instance::new(self.mesh)], target: Some(results) };
        self.relight.add(to.context, to.graph, to.imports, &frame)?;
        Ok(())
    }

    fn accesses(&mut self, _: &Context) -> Result<Vec<Option<(Access, Access)>>, Refusal> {
        let light = if self.texels { AirglowLight::Environment } else { AirglowLight::EnvironmentImage };
        let frame = AirglowRelightFrame {
            struct_size: size_of::<AirglowRelightFrame>() as u32,
            light: light as u32,
            light_rotation: ROTATION,
            instances: &raw const self.instance,
            instance_count: 1,
            environment_width: WIDTH,
            environment_height: HEIGHT,
            environment_revision: 1,
        };
        let (relight, frame) = (self.in_c, &raw const frame);
        self.prepared =
            self.through_c.prepare(|prepared| attempt!(airglow_relight_prepare, relight, frame, prepared))?;
        attempt!(airglow_prepared_make_scratch, self.prepared)?;
        let mut ends = ends(self.prepared, &RESOURCES)?;
        ends[0] = ends[0].filter(|_| !self.texels);
        Ok(ends)
    }

    fn record(&mut self, recorder: &mut Recorder<'_>, host: &[Given]) -> Result<(), Refusal> {
        let bound = RESOURCES.into_iter().zip(host).skip(usize::from(self.texels));
        record(self.prepared, recorder, bound)
    }
}

/// Settings that are all default but for the method.
pub(crate) fn settings(method: u32) -> AirglowRelightSettings {
    let struct_size = size_of::<AirglowRelightSettings>() as u32;
    // SAFETY: zero bytes are valid settings.
    AirglowRelightSettings { struct_size, method, ..unsafe { zeroed() } }
}

/// The settings as Rust has them.
fn read(settings: &AirglowRelightSettings) -> Result<Settings, Refusal> {
    settings.read().map_err(said)
}

fn said(failure: Failure) -> Refusal {
    failure.message.into()
}

/// What the kit holds the pass to.
pub(crate) const CHECKS: Checks = Checks {
    requirements: || {
        let asked = asked(0)?.and(&asked(1)?);
        #[cfg(all(feature = "radiance", feature = "shadow"))]
        let asked = asked.and(&super::joined::requirements()?);
        Ok(asked)
    },
    checks: &[
        (c"relight: compute, an environment in the host's image", |host| check(host, (0, false, None))),
        (c"relight: compute, an environment as texels", |host| check(host, (0, true, None))),
        (c"relight: fragment, an environment in the host's image", |host| check(host, (1, false, None))),
        (c"relight: a host with Z up, left-handed, exposed", |host| check(host, (0, false, Some(&z_up())))),
        #[cfg(all(feature = "radiance", feature = "shadow"))]
        (c"relight: light of near emitters, and what moving spheres leave of it", super::joined::check),
    ],
};

fn asked(method: u32) -> Result<Requirements, Refusal> {
    Ok(Relight::requirements(&read(&settings(method))?))
}

/// A host that differs from airglow in all that the pass reads.
pub(crate) fn z_up() -> AirglowWorld {
    AirglowWorld {
        struct_size: size_of::<AirglowWorld>() as u32,
        right: AirglowAxis::PlusY as u32,
        up: AirglowAxis::PlusZ as u32,
        forward: AirglowAxis::PlusX as u32,
        metres_per_unit: 0.01,
        pre_exposure: 0.37,
        // SAFETY: zero bytes are a valid world.
        ..unsafe { zeroed() }
    }
}

fn check(host: &HostDevice<'_>, case: Case<'_>) -> Result<(), Refusal> {
    let make = |context: &Context, host: &HostDevice<'_>| Both::new(context, host, case);
    // SAFETY: whoever runs the kit vouches for the device and its queue.
    let outputs = unsafe { conform_on(host, &asked(case.0)?, &Options::default(), make)? };
    check_written(&outputs)
}

/// Every vertex was written, and none is black.
pub(crate) fn check_written(outputs: &Outputs) -> Result<(), Refusal> {
    let colours = outputs.iter().take(1).flat_map(|bytes| bytes.chunks_exact(16));
    let lit = colours.filter(|colour| colour[12..] == 1f32.to_le_bytes() && colour[..4] != [0; 4]).count();
    match lit == VERTICES as usize {
        true => Ok(()),
        false => Err(format!("{lit} of {VERTICES} vertices are lit").into()),
    }
}
