//! A build inside a host: by the graph from Rust, by record from C. The kit holds both to the same bits and state.

use std::mem::zeroed;

use airglow_conformance::{
    Declared, Given, HostDevice, HostResource, Outputs, Refusal, Room, conform_on, copy_mips,
};
use airglow_gpu::ash::vk::{BufferUsageFlags, Format, Handle, Image, ImageUsageFlags};
use airglow_gpu::{Context, Label, Options, Recorder, Requirements};
use airglow_graph::{Access, ImageDesc};
use airglow_normals::{Build, FitSettings, NormalMap, Normals, Settings};

use crate::checks::Checks;
use crate::normals::info::{AirglowNormalFormat, AirglowNormalMapInfo};
use crate::normals::map::{
    AirglowLobeTexture, AirglowNormalMap, airglow_normal_map_drop, airglow_normal_map_new,
    airglow_normal_map_texture,
};
use crate::normals::prepared::airglow_normal_map_prepare;
use crate::normals::settings::AirglowNormalsSettings;
use crate::normals::{AirglowNormals, airglow_normals_drop, airglow_normals_new, airglow_normals_require};
use crate::prepared::AirglowPrepared;
use crate::through_c::{ThroughC, attempt, record};

/// Few, since compiling their kernel is most of the time.
const LOBES: usize = 2;
const ITERATIONS: usize = 4;
const SIDE: usize = 8;

/// Grooves, as four bytes a texel.
pub(crate) fn texels() -> Vec<[u8; 4]> {
    (0..SIDE * SIDE).map(|i| if i % 3 == 0 { [204, 128, 230, 255] } else { [51, 128, 230, 255] }).collect()
}

fn rust_settings() -> Settings {
    let fit = FitSettings { lobes: LOBES, iterations: ITERATIONS, ..FitSettings::default() };
    Settings { fit, ..Settings::default() }
}

pub(crate) fn settings() -> AirglowNormalsSettings {
    AirglowNormalsSettings {
        struct_size: size_of::<AirglowNormalsSettings>() as u32,
        lobes: LOBES as u32,
        iterations: ITERATIONS as u32,
        // SAFETY: zero bytes are valid settings.
        ..unsafe { zeroed() }
    }
}

/// What a device must have for it.
pub(crate) fn requirements() -> Requirements {
    Normals::requirements(&rust_settings())
}

/// A map of those texels.
pub(crate) fn info(texels: &[[u8; 4]]) -> AirglowNormalMapInfo {
    AirglowNormalMapInfo {
        struct_size: size_of::<AirglowNormalMapInfo>() as u32,
        format: AirglowNormalFormat::Rgba8 as u32,
        width: SIDE as u32,
        height: SIDE as u32,
        texels: texels.as_ptr().cast(),
        texel_bytes: size_of_val(texels),
        // SAFETY: zero bytes are a valid description.
        ..unsafe { zeroed() }
    }
}

/// The pass made by the exported functions.
pub(crate) fn in_c(host: &HostDevice<'_>) -> Result<(ThroughC, *mut AirglowNormals), Refusal> {
    let settings = settings();
    let settings = &raw const settings;
    let mut through_c = ThroughC::adopt(host, |asked| attempt!(airglow_normals_require, asked, settings))?;
    let context = through_c.context;
    let normals = through_c
        .hold(airglow_normals_drop, |normals| attempt!(airglow_normals_new, context, settings, normals))?;
    Ok((through_c, normals))
}

/// A map of the texels.
pub(crate) fn map(
    through_c: &mut ThroughC,
    normals: *const AirglowNormals,
    info: &AirglowNormalMapInfo,
) -> Result<*mut AirglowNormalMap, Refusal> {
    let info = &raw const *info;
    through_c.hold(airglow_normal_map_drop, |map| attempt!(airglow_normal_map_new, normals, info, map))
}

/// The texture of a map.
pub(crate) fn texture(map: *const AirglowNormalMap) -> Result<AirglowLobeTexture, Refusal> {
    // SAFETY: zero bytes are a valid row.
    let mut texture: AirglowLobeTexture = unsafe { zeroed() };
    attempt!(airglow_normal_map_texture, map, &raw mut texture)?;
    Ok(texture)
}

/// The build twice: made by Rust, and made by the exported functions.
struct Both {
    build: Build,
    through_c: ThroughC,
    map: *mut AirglowNormalMap,
    steps: Vec<*mut AirglowPrepared>,
}

impl Both {
    fn new(context: &Context, host: &HostDevice<'_>) -> Result<Self, Refusal> {
        let texels = texels();
        let wide: Vec<_> = texels.iter().map(|[x, y, z, _]| [*x, *y, *z].map(u16::from)).collect();
        let rust = NormalMap::from_unsigned(SIDE, SIDE, &wide, 255)?;
        let build = Normals::new(context, rust_settings())?.build(context, &rust)?;
        let (mut through_c, normals) = in_c(host)?;
        let map = map(&mut through_c, normals, &info(&texels))?;
        Ok(Self { build, through_c, map, steps: Vec::new() })
    }
}

impl Room for Both {
    fn requirements(&self) -> Requirements {
        requirements()
    }

    fn resources(&self) -> Vec<HostResource> {
        let bytes = self.build.texture().map_or(0, |texture| texture.bytes);
        let ends = [Access::TransferDestination; 2];
        vec![HostResource::results("lobes", bytes, BufferUsageFlags::STORAGE_BUFFER, ends)]
    }

    fn add(&mut self, to: &mut Declared<'_>) -> Result<(), Refusal> {
        let texture = self.build.add(to.graph, to.imports, usize::MAX);
        to.keep_image(texture.ok_or("there is no texture")?, 0)
    }

    fn accesses(&mut self, _: &Context) -> Result<Vec<Option<(Access, Access)>>, Refusal> {
        let map = self.map;
        // A host that takes three steps at a time.
        loop {
            let next =
                self.through_c.prepare(|prepared| attempt!(airglow_normal_map_prepare, map, 3, prepared))?;
            if next.is_null() {
                return Ok(vec![Some((Access::TransferDestination, Access::TransferDestination))]);
            }
            self.steps.push(next);
        }
    }

    fn record(&mut self, recorder: &mut Recorder<'_>, host: &[Given]) -> Result<(), Refusal> {
        for step in &self.steps {
            record(*step, recorder, [])?;
        }
        let made = texture(self.map)?;
        let desc = ImageDesc {
            mips: made.mips,
            layers: made.layers,
            usage: ImageUsageFlags::TRANSFER_SRC,
            ..ImageDesc::new_2d(made.width, made.height, Format::from_raw(made.format as i32))
        };
        let (raw, label) = (Image::from_raw(made.image), Label::new("host", "lobes"));
        // SAFETY: a live image of the device, as its maker describes it.
        let image = unsafe { recorder.context().import_image(raw, label, &desc) };
        recorder.transition(&image, Access::FragmentSampled, Access::TransferSource)?;
        Ok(copy_mips(recorder, &image, host[0].buffer()?)?)
    }
}

/// What the kit holds the pass to.
pub(crate) const CHECKS: Checks = Checks {
    requirements: || Ok(requirements()),
    checks: &[(c"normals: a map built in steps", |host| {
        // SAFETY: whoever runs the kit vouches for the device and its queue.
        check_lit(&unsafe { conform_on(host, &requirements(), &Options::default(), Both::new)? })
    })],
};

/// The weights of the coarsest texel's lobes sum to 1.
fn check_lit(outputs: &Outputs) -> Result<(), Refusal> {
    let halves = outputs[0].as_chunks().0.iter().map(|half| half_to_f32(u16::from_le_bytes(*half)));
    let texels = halves.collect::<Vec<_>>();
    let weights = texels.rchunks(4).take(LOBES).map(|texel| texel[3]).collect::<Vec<_>>();
    match (weights.iter().sum::<f32>() - 1.0).abs() < 0.01 {
        true => Ok(()),
        false => Err(format!("no texel can be lit by lobes of weights {weights:?}").into()),
    }
}

/// A positive half that is no NaN, infinity or subnormal number; NaN stands for what is none.
fn half_to_f32(bits: u16) -> f32 {
    let (exponent, fraction) = (u32::from(bits >> 10), u32::from(bits & 0x3ff));
    match exponent {
        1..31 => f32::from_bits(((exponent + 112) << 23) | (fraction << 13)),
        _ => {
            if bits & 0x7fff == 0 {
                0.0
            } else {
                f32::NAN
            }
        }
    }
}
