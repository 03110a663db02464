//! The pass inside a host: by the graph from Rust, by accesses and record from C. The kit holds both to the same bits,
//! layouts and state.

use std::mem::zeroed;
use std::ptr::{null, null_mut};

use airglow_conformance::{Declared, Given, HostDevice, HostResource, Outputs, Refusal, Room, conform_on};
use airglow_fog::{ACCESSES, Camera, Environment, Fog, Frame, Light, Medium, Phase, Settings, View};
use airglow_gpu::ash::vk::{Format, ImageUsageFlags};
use airglow_gpu::{Context, Options, Recorder, Requirements};
use airglow_graph::{Access, ImageDesc};
use airglow_math::World;
use glam::DVec3;

use crate::access::Number;
use crate::checks::Checks;
use crate::fog::prepared::{AirglowFogResource, airglow_fog_prepare};
use crate::fog::settings::AirglowFogSettings;
use crate::fog::view::{AirglowFogLight, AirglowFogView};
use crate::fog::{AirglowFog, airglow_fog_drop, airglow_fog_new, airglow_fog_require};
use crate::prepared::AirglowPrepared;
use crate::through_c::{ThroughC, attempt, ends, record};

/// What it uses, in the order of [`images`].
pub(crate) const RESOURCES: [Number; 3] = [
    (AirglowFogResource::Surface as u32, 0),
    (AirglowFogResource::Depth as u32, 0),
    (AirglowFogResource::Target as u32, 0),
];
pub(crate) const SIZE: [u32; 2] = [40, 24];
const PIXELS: usize = (SIZE[0] * SIZE[1]) as usize;
const EYE: [f64; 3] = [0.0, 1.7, 8.0];
const LAMP: ([f64; 3], [f64; 3]) = ([1.0, 3.0, 0.0], [40.0, 30.0, 15.0]);
const EDGES: [f64; 4] = [-0.8, 0.8, -0.45, 0.45];
const EXTINCTION: [f64; 3] = [0.065, 0.06, 0.055];
const G: f64 = 0.4;

/// How far an environment is, and its radiance.
const ENVIRONMENT: (f64, [[f64; 3]; 9]) = (80.0, [[0.9, 0.5, 0.3]; 9]);

/// The view as Rust says it, with an environment or without.
fn view(environment: bool) -> View {
    let camera = Camera {
        position: DVec3::from_array(EYE),
        right: DVec3::X,
        up: DVec3::Y,
        forward: DVec3::NEG_Z,
        edges: EDGES,
    };
    let phase = Phase::HenyeyGreenstein { g: G };
    let medium = Medium { extinction: EXTINCTION, albedo: [0.9; 3], phase, thinning: None };
    let lamp = Light { radius: 0.1, ..Light::point(DVec3::from_array(LAMP.0), LAMP.1) };
    let (distance, radiance) = ENVIRONMENT;
    let environment = environment.then_some(Environment { distance, radiance });
    View { world: World::default(), camera, medium, lights: vec![lamp], environment }
}

/// The lamp as C says it.
pub(crate) fn lamp() -> AirglowFogLight {
    // SAFETY: zero bytes are a valid light.
    AirglowFogLight { position: LAMP.0, intensity: LAMP.1, radius: 0.1, ..unsafe { zeroed() } }
}

/// The view as C says it.
pub(crate) fn view_in_c(lights: &[AirglowFogLight]) -> AirglowFogView {
    AirglowFogView {
        struct_size: size_of::<AirglowFogView>() as u32,
        reserved: 0,
        world: null(),
        eye: EYE,
        right: [1.0, 0.0, 0.0],
        up: [0.0, 1.0, 0.0],
        forward: [0.0, 0.0, -1.0],
        edges: EDGES,
        extinction: EXTINCTION,
        albedo: [0.9; 3],
        phase: [G, 0.0, 0.0, 0.0],
        thinning_level: 0.0,
        scale_height: 0.0,
        lights: lights.as_ptr(),
        light_count: lights.len(),
        environment: null(),
        environment_distance: 0.0,
    }
}

/// Settings that are all default but for the environment.
pub(crate) fn settings(environment: bool) -> AirglowFogSettings {
    let struct_size = size_of::<AirglowFogSettings>() as u32;
    // SAFETY: zero bytes are valid settings.
    AirglowFogSettings { struct_size, environment: environment.into(), ..unsafe { zeroed() } }
}

/// The pass made by the exported functions.
pub(crate) fn in_c(
    host: &HostDevice<'_>,
    settings: AirglowFogSettings,
) -> Result<(ThroughC, *mut AirglowFog), Refusal> {
    let settings = &raw const settings;
    let mut through_c = ThroughC::adopt(host, |asked| attempt!(airglow_fog_require, asked, settings))?;
    let context = through_c.context;
    let fog = through_c.hold(airglow_fog_drop, |fog| attempt!(airglow_fog_new, context, settings, fog))?;
    Ok((through_c, fog))
}

/// A view prepared by the exported functions.
pub(crate) fn prepare(
    through_c: &mut ThroughC,
    fog: *const AirglowFog,
    view: &AirglowFogView,
) -> Result<*mut AirglowPrepared, Refusal> {
    let ([width, height], view) = (SIZE, &raw const *view);
    through_c.prepare(|prepared| attempt!(airglow_fog_prepare, fog, width, height, view, prepared))
}

/// The pass twice: made by Rust, and made by the exported functions.
pub(crate) struct Both {
    fog: Fog,
    through_c: ThroughC,
    in_c: *mut AirglowFog,
    prepared: *mut AirglowPrepared,
}

impl Both {
    pub(crate) fn new(context: &Context, host: &HostDevice<'_>, environment: bool) -> Result<Self, Refusal> {
        let fog = Fog::new(context, Settings { environment, ..Settings::default() })?;
        let (through_c, in_c) = in_c(host, settings(environment))?;
        Ok(Self { fog, through_c, in_c, prepared: null_mut() })
    }
}

/// What a host gives: the surface, its depth, the picture.
pub(crate) fn images() -> [ImageDesc; 3] {
    let (hdr, sampled) = (Format::R32G32B32A32_SFLOAT, ImageUsageFlags::SAMPLED);
    let depth = sampled | ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
    let written = ImageUsageFlags::COLOR_ATTACHMENT | ImageUsageFlags::TRANSFER_SRC;
    let image = |(format, usage)| ImageDesc { usage, ..ImageDesc::new_2d(SIZE[0], SIZE[1], format) };
    [(hdr, sampled), (Format::D32_SFLOAT, depth), (hdr, written)].map(image)
}

impl Room for Both {
    fn requirements(&self) -> Requirements {
        Fog::requirements(self.fog.settings())
    }

    fn resources(&self) -> Vec<HostResource> {
        let [surface, depth, picture] = images();
        let floats =
            |value: fn(usize) -> f32, count: usize| (0..count).flat_map(move |i| value(i).to_le_bytes());
        let radiance = floats(|i| 0.01 * i as f32, 4 * PIXELS).collect();
        // The upper rows show no surface.
        let far = |i| if i < PIXELS / 3 { 1.0 } else { 0.9 + 0.09 * i as f32 / PIXELS as f32 };
        let drawn = [Access::ColorAttachmentWrite, Access::TransferSource];
        let [(_, reads), (_, reads_depth), _] = ACCESSES;
        vec![
            HostResource::image("surface", surface, radiance, [reads; 2]),
            HostResource::image("depth", depth, floats(far, PIXELS).collect(), [reads_depth; 2]),
            HostResource::image("picture", picture, vec![0xff; 16 * PIXELS], drawn),
        ]
    }

    fn add(&mut self, to: &mut Declared<'_>) -> Result<(), Refusal> {
        let (surface, depth, target) = (to.image(0)?, to.image(1)?, Some(to.image(2)?));
        self.fog.add(
            to.graph,
            &Frame { size: SIZE, surface, depth, target, view: view(self.fog.settings().environment) },
        )?;
        Ok(())
    }

    fn accesses(&mut self, _: &Context) -> Result<Vec<Option<(Access, Access)>>, Refusal> {
        let (lamps, (environment_distance, radiance)) = ([lamp()], ENVIRONMENT);
        let mut view = view_in_c(&lamps);
        if self.fog.settings().environment {
            view = AirglowFogView { environment: radiance.as_ptr().cast(), environment_distance, ..view };
        }
        self.prepared = prepare(&mut self.through_c, self.in_c, &view)?;
        ends(self.prepared, &RESOURCES)
    }

    fn record(&mut self, recorder: &mut Recorder<'_>, host: &[Given]) -> Result<(), Refusal> {
        record(self.prepared, recorder, RESOURCES.into_iter().zip(host))
    }
}

/// What the kit holds the pass to.
pub(crate) const CHECKS: Checks = Checks {
    requirements: || {
        let background = super::background::conformance::requirements();
        Ok(Fog::requirements(&Settings::default()).and(&background))
    },
    checks: &[
        (c"fog: a lamp in a medium", |host| check_lit(&outputs(host, false)?, true)),
        (c"fog: an environment behind it", |host| check_lit(&outputs(host, true)?, false)),
        (c"fog: an environment as it is seen through it", super::background::conformance::check),
    ],
};

fn outputs(host: &HostDevice<'_>, environment: bool) -> Result<Outputs, Refusal> {
    let asked = Fog::requirements(&Settings::default());
    let make = |context: &Context, host: &HostDevice<'_>| Both::new(context, host, environment);
    // SAFETY: whoever runs the kit vouches for the device and its queue.
    unsafe { conform_on(host, &asked, &Options::default(), make) }
}

/// Every pixel was written, and where there is no surface there is, if the air is all that is `warm`, airlight of the lamp's
/// colour.
pub(crate) fn check_lit(outputs: &Outputs, warm: bool) -> Result<(), Refusal> {
    let bytes = outputs.iter().take(1).flat_map(|bytes| bytes.chunks_exact(4));
    let values: Vec<f32> = bytes.map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
    let texels = values.chunks_exact(4).enumerate();
    let near = |i: usize| i >= PIXELS / 3 || !warm;
    let lit = texels.filter(|(i, t)| t[..3].iter().all(|v| *v > 0.0) && (near(*i) || t[0] > t[2]));
    match lit.count() {
        PIXELS => Ok(()),
        lit => Err(format!("{lit} of {PIXELS} pixels are lit as they should be").into()),
    }
}
