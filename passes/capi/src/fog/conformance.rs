//! The pass inside a host: by the graph from Rust, by accesses and record from C. The kit holds both to the same bits,
//! layouts and state.

use std::mem::zeroed;
use std::ptr::{self, null, null_mut};

use airglow_conformance::{Given, HostDevice, HostResource, Named, Outputs, Refusal, Room, conform_on};
use airglow_fog::{ACCESSES, Camera, Fog, Frame, Light, Medium, Phase, Settings, View};
use airglow_gpu::ash::vk::{Format, Handle, ImageUsageFlags};
use airglow_gpu::{Context, Image, Imports, Options, Record, Recorder, Requirements};
use airglow_graph::{Access, Graph, ImageDesc};
use airglow_math::World;
use glam::DVec3;

use crate::access::AirglowAccess;
use crate::binding::AirglowBinding;
use crate::conformance::{Checks, adopt, attempt, ends};
use crate::context::{AirglowContext, airglow_context_drop};
use crate::fog::prepared::*;
use crate::fog::settings::AirglowFogSettings;
use crate::fog::view::{AirglowFogLight, AirglowFogView};
use crate::fog::{AirglowFog, airglow_fog_drop, airglow_fog_new, airglow_fog_require};
use crate::requirements::{AirglowRequirements, airglow_requirements_drop, airglow_requirements_new};

pub(crate) const SIZE: [u32; 2] = [40, 24];
const PIXELS: usize = (SIZE[0] * SIZE[1]) as usize;
const EYE: [f64; 3] = [0.0, 1.7, 8.0];
const LAMP: ([f64; 3], [f64; 3]) = ([1.0, 3.0, 0.0], [40.0, 30.0, 15.0]);
const EDGES: [f64; 4] = [-0.8, 0.8, -0.45, 0.45];
const EXTINCTION: [f64; 3] = [0.065, 0.06, 0.055];
const G: f64 = 0.4;

/// The view as Rust says it.
fn view() -> View {
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
    View { world: World::default(), camera, medium, lights: vec![lamp], environment: None }
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
    }
}

/// Settings that are all default.
pub(crate) fn settings() -> AirglowFogSettings {
    let struct_size = size_of::<AirglowFogSettings>() as u32;
    // SAFETY: zero bytes are valid settings.
    AirglowFogSettings { struct_size, ..unsafe { zeroed() } }
}

/// What the pass asks for.
pub(crate) fn requirements(settings: &AirglowFogSettings) -> Result<*mut AirglowRequirements, Refusal> {
    let mut requirements = null_mut();
    attempt!(airglow_requirements_new, &raw mut requirements)?;
    attempt!(airglow_fog_require, requirements, settings)?;
    Ok(requirements)
}

/// The pass made by the exported functions.
pub(crate) struct ThroughC {
    pub context: *mut AirglowContext,
    pub fog: *mut AirglowFog,
    pub prepared: *mut AirglowFogPrepared,
}

impl ThroughC {
    pub(crate) fn new(host: &HostDevice<'_>) -> Result<Self, Refusal> {
        let settings = settings();
        let asked = requirements(&settings)?;
        let adopted = adopt(host, asked);
        // SAFETY: they were read by the call above alone.
        unsafe { airglow_requirements_drop(asked) };
        let mut made = Self { context: adopted?, fog: null_mut(), prepared: null_mut() };
        attempt!(airglow_fog_new, made.context, &raw const settings, &raw mut made.fog)?;
        Ok(made)
    }

    pub(crate) fn prepare(&mut self, view: &AirglowFogView) -> Result<(), Refusal> {
        let [width, height] = SIZE;
        attempt!(airglow_fog_prepare, self.fog, width, height, view, &raw mut self.prepared)
    }
}

impl Drop for ThroughC {
    fn drop(&mut self) {
        // The context first: what was made from it may outlive it.
        // SAFETY: they came from the functions above and are not used again.
        unsafe {
            airglow_context_drop(self.context);
            airglow_fog_drop(self.fog);
            airglow_fog_prepared_drop(self.prepared);
        }
    }
}

/// The pass twice: made by Rust, and made by the exported functions.
pub(crate) struct Both {
    fog: Fog,
    through_c: ThroughC,
}

impl Both {
    pub(crate) fn new(context: &Context, host: &HostDevice<'_>) -> Result<Self, Refusal> {
        let fog = Fog::new(context, Settings::default())?;
        Ok(Self { fog, through_c: ThroughC::new(host)? })
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

/// An image of the host's as a binding.
pub(crate) fn binding(resource: AirglowFogResource, image: &Image) -> AirglowBinding {
    AirglowBinding {
        resource: resource as u32,
        image: image.raw().as_raw(),
        format: image.desc().format.as_raw() as u32,
        usage: image.desc().usage.as_raw(),
        extent: SIZE,
        // SAFETY: zero bytes are a valid binding.
        ..unsafe { zeroed() }
    }
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

    fn add(
        &mut self,
        _: &Context,
        graph: &mut Graph<Record>,
        _: &mut Imports,
        host: &[Named],
    ) -> Result<(), Refusal> {
        let [Named::Image(surface), Named::Image(depth), Named::Image(picture)] = *host else {
            return Err("other resources".into());
        };
        self.fog.add(graph, &Frame { size: SIZE, surface, depth, target: Some(picture), view: view() })?;
        Ok(())
    }

    fn accesses(&mut self, _: &Context) -> Result<Vec<Option<(Access, Access)>>, Refusal> {
        self.through_c.prepare(&view_in_c(&[lamp()]))?;
        let mut count = ACCESSES.len();
        // SAFETY: zero bytes are a valid access.
        let mut uses = vec![unsafe { zeroed::<AirglowAccess>() }; count];
        attempt!(
            airglow_fog_accesses,
            self.through_c.prepared,
            uses.as_mut_ptr(),
            ptr::from_mut(&mut count)
        )?;
        [0, 1, 2].into_iter().map(|resource| ends(&uses, resource)).collect()
    }

    fn record(&mut self, recorder: &mut Recorder<'_>, host: &[Given]) -> Result<(), Refusal> {
        use AirglowFogResource::{Depth, Surface, Target};
        let [Given::Image(surface), Given::Image(depth), Given::Image(picture)] = host else {
            return Err("other resources".into());
        };
        let bindings = [binding(Surface, surface), binding(Depth, depth), binding(Target, picture)];
        let (commands, prepared) = (recorder.command_buffer().as_raw(), self.through_c.prepared);
        attempt!(airglow_fog_record, prepared, commands, bindings.as_ptr(), bindings.len())
    }
}

/// What the kit holds the pass to.
pub(crate) const CHECKS: Checks = Checks {
    requirements: || Ok(Fog::requirements(&Settings::default())),
    checks: &[(c"fog: a lamp in a medium", |host| {
        let asked = Fog::requirements(&Settings::default());
        // SAFETY: whoever runs the kit vouches for the device and its queue.
        check_lit(&unsafe { conform_on(host, &asked, &Options::default(), Both::new)? })
    })],
};

/// Every pixel was written, and where there is no surface there is airlight of the lamp's colour.
pub(crate) fn check_lit(outputs: &Outputs) -> Result<(), Refusal> {
    let bytes = outputs.iter().take(1).flat_map(|bytes| bytes.chunks_exact(4));
    let values: Vec<f32> = bytes.map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
    let texels = values.chunks_exact(4).enumerate();
    let lit = texels.filter(|(i, t)| t[..3].iter().all(|v| *v > 0.0) && (*i >= PIXELS / 3 || t[0] > t[2]));
    match lit.count() {
        PIXELS => Ok(()),
        lit => Err(format!("{lit} of {PIXELS} pixels are lit as they should be").into()),
    }
}
