//! The background inside a host: by the graph from Rust, by accesses and record from C. The kit holds both to the same bits
//! and state.

use std::mem::zeroed;

use airglow_conformance::{Declared, Given, HostDevice, HostResource, Refusal, Room, conform_on, copy_mips};
use airglow_fog::{Asked, Background, Distant, Seen};
use airglow_gpu::ash::vk::{BufferUsageFlags, Format, ImageUsageFlags};
use airglow_gpu::{Context, Image, Label, Options, Recorder, Requirements};
use airglow_graph::{Access, ImageDesc, State};

use super::{
    AirglowFogBackground, AirglowFogBackgroundSettings, AirglowFogBackgroundView, ENVIRONMENT, TARGET,
    airglow_fog_background_drop, airglow_fog_background_new, airglow_fog_background_prepare,
    airglow_fog_background_require,
};
use crate::prepared::AirglowPrepared;
use crate::through_c::{ThroughC, attempt, ends, record};

const FORMAT: Format = Format::R32G32B32A32_SFLOAT;
const SIZE: [u32; 2] = [16, 8];
const BYTES: u64 = 16 * (SIZE[0] * SIZE[1]) as u64;
const DISTANT: Distant = Distant { optical_distance: [0.5, 0.7, 0.9], albedo: [0.9, 0.8, 0.7] };

/// What a device must have for it.
pub(crate) fn requirements() -> Requirements {
    Background::requirements(FORMAT)
}

pub(crate) fn settings() -> AirglowFogBackgroundSettings {
    let [width, height] = SIZE;
    let struct_size = size_of::<AirglowFogBackgroundSettings>() as u32;
    AirglowFogBackgroundSettings { struct_size, format: 0, width, height }
}

pub(crate) fn view() -> AirglowFogBackgroundView {
    AirglowFogBackgroundView {
        struct_size: size_of::<AirglowFogBackgroundView>() as u32,
        optical_distance: DISTANT.optical_distance,
        albedo: DISTANT.albedo,
        // SAFETY: zero bytes are a valid view.
        ..unsafe { zeroed() }
    }
}

/// The background made by the exported functions, and a picture prepared.
pub(crate) fn in_c(
    host: &HostDevice<'_>,
) -> Result<(ThroughC, *mut AirglowFogBackground, *mut AirglowPrepared), Refusal> {
    let (settings, view) = (settings(), view());
    let (settings, view) = (&raw const settings, &raw const view);
    let asked = |asked| attempt!(airglow_fog_background_require, asked, settings);
    let mut through_c = ThroughC::adopt(host, asked)?;
    let context = through_c.context;
    let background = through_c.hold(airglow_fog_background_drop, |background| {
        attempt!(airglow_fog_background_new, context, settings, background)
    })?;
    let prepared =
        through_c.prepare(|prepared| attempt!(airglow_fog_background_prepare, background, view, prepared))?;
    Ok((through_c, background, prepared))
}

/// The background twice: made by Rust, and made by the exported functions.
struct Both {
    background: Background,
    /// The host's image that it is kept in.
    picture: Image,
    prepared: *mut AirglowPrepared,
    _made: ThroughC,
}

impl Both {
    fn new(context: &Context, host: &HostDevice<'_>) -> Result<Self, Refusal> {
        let usage =
            ImageUsageFlags::COLOR_ATTACHMENT | ImageUsageFlags::SAMPLED | ImageUsageFlags::TRANSFER_SRC;
        let desc = ImageDesc { usage, ..ImageDesc::new_2d(SIZE[0], SIZE[1], FORMAT) };
        let picture = context.create_image(Label::new("host", "picture"), &desc)?;
        let (made, _, prepared) = in_c(host)?;
        Ok(Self { background: Background::new(context, SIZE, FORMAT)?, picture, prepared, _made: made })
    }
}

impl Room for Both {
    fn requirements(&self) -> Requirements {
        requirements()
    }

    fn resources(&self) -> Vec<HostResource> {
        let usage = ImageUsageFlags::SAMPLED;
        let desc = ImageDesc { usage, ..ImageDesc::new_2d(SIZE[0], SIZE[1], FORMAT) };
        let radiance = (0..BYTES / 4).flat_map(|i| (0.1 * (i % 7) as f32 + 0.01).to_le_bytes()).collect();
        let kept = [Access::TransferDestination; 2];
        vec![
            HostResource::image("environment", desc, radiance, [Access::FragmentSampled; 2]),
            HostResource::results("picture", BYTES, BufferUsageFlags::STORAGE_BUFFER, kept),
        ]
    }

    fn add(&mut self, to: &mut Declared<'_>) -> Result<(), Refusal> {
        let (asked, environment) = (Asked { distant: DISTANT, seen: Seen::Whole, version: 1 }, to.image(0)?);
        let seen = self.background.add(to.graph, to.imports, environment, &self.picture, asked)?;
        to.keep_image(seen, 1)
    }

    fn accesses(&mut self, _: &Context) -> Result<Vec<Option<(Access, Access)>>, Refusal> {
        let kept = Some((Access::TransferDestination, Access::TransferDestination));
        Ok(vec![ends(self.prepared, &[ENVIRONMENT])?[0], kept])
    }

    fn record(&mut self, recorder: &mut Recorder<'_>, host: &[Given]) -> Result<(), Refusal> {
        let (picture, drawn) = (&self.picture, Access::ColorAttachmentWrite);
        recorder.transition(picture, State::UNDEFINED, drawn)?;
        let target = Given::Image(picture.clone());
        record(self.prepared, recorder, [(ENVIRONMENT, &host[0]), (TARGET, &target)])?;
        recorder.transition(picture, drawn, Access::TransferSource)?;
        Ok(copy_mips(recorder, picture, host[1].buffer()?)?)
    }
}

/// What the kit holds it to: every texel sees something of the environment.
pub(crate) fn check(host: &HostDevice<'_>) -> Result<(), Refusal> {
    // SAFETY: whoever runs the kit vouches for the device and its queue.
    let outputs = unsafe { conform_on(host, &requirements(), &Options::default(), Both::new)? };
    let words = outputs.iter().flat_map(|bytes| bytes.as_chunks().0).map(|word| f32::from_le_bytes(*word));
    let values: Vec<f32> = words.collect();
    let lit = values.chunks_exact(4).filter(|texel| texel[..3].iter().all(|value| *value > 0.0)).count();
    match 16 * lit as u64 == BYTES {
        true => Ok(()),
        false => Err(format!("{lit} texels are lit").into()),
    }
}
