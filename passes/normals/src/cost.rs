//! What sampling and shading take, method by method, in one kernel over the pixels of a picture: for reports.

use airglow_gpu::ash::vk::{Format, ImageUsageFlags, ImageViewType};
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Buffer, ComputePipeline, ComputePipelineDesc, Context, GpuError,
    Image, ImageView, Label, Location, Recorder, Sampler, ViewDesc,
};
use airglow_graph::{Access, BufferDesc, ImageDesc, State};
use bytemuck::{Pod, Zeroable};
use half::f16;

use crate::NormalsError;
use crate::bench::Bench;
use crate::brdf::Brdf;
use crate::harmonics::band_factors;
use crate::kernels::words;
use crate::map::NormalMap;
use crate::method::Method;
use crate::settings::Settings;
use crate::storage::Storage;

/// `Settings` of `cost.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct CostConstants {
    /// Pixels.
    pub size: [u32; 2],
    /// Mip of the texture; a fraction blends two.
    pub level: f32,
    /// Exponent or alpha.
    pub parameter: f32,
    /// Bands of the BRDF, for harmonics.
    pub bands: [[f32; 4]; 2],
}

/// Bindings of `cost.comp`: what is kept of the normals, its sampler, radiance of each pixel.
pub const BINDINGS: [BindingDesc; 3] = [
    BindingDesc::new(0, BindingKind::SampledImage),
    BindingDesc::new(1, BindingKind::Sampler),
    BindingDesc::new(2, BindingKind::StorageBuffer),
];

macro_rules! module {
    ($($name:expr),*) => {
        include_bytes!(concat!("../../../shaders/spirv/normals/cost.", $($name,)* ".spv")).as_slice()
    };
}
/// The modules of Lambert, Blinn-Phong and GGX.
macro_rules! models {
    ($before:literal, $after:literal) => {
        [
            module!($before, "lambert", $after),
            module!($before, "blinn", $after),
            module!($before, "ggx", $after),
        ]
    };
}

static MODULES: [(Method, [&[u8]; 3]); 14] = [
    (Method::Lobes(1), models!("LAYERS1.lobes.", "")),
    (Method::Lobes(2), models!("LAYERS2.lobes.", "")),
    (Method::Lobes(4), models!("LAYERS4.lobes.", "")),
    (Method::Lobes(6), models!("LAYERS6.lobes.", "")),
    (Method::Taps, models!("parts.", "")),
    (Method::Harmonics(3), models!("sh.", ".ORDER3")),
    (Method::Harmonics(4), models!("sh.", ".ORDER4")),
    (Method::Harmonics(5), models!("sh.", ".ORDER5")),
    (Method::Mip, models!("mip.", "")),
    (Method::Length, models!("length.", "")),
    (Method::Toksvig, models!("toksvig.", "")),
    (Method::Roughness, models!("roughness.", "")),
    (Method::Geometric, models!("geometric.", "")),
    (Method::Lean, models!("lean.", "")),
];
/// Of four lobes in [`Storage::Octahedral8`].
static OCTAHEDRAL: [&[u8]; 3] = [
    include_bytes!("../../../shaders/spirv/normals/cost_octahedral.lambert.spv").as_slice(),
    include_bytes!("../../../shaders/spirv/normals/cost_octahedral.blinn.spv").as_slice(),
    include_bytes!("../../../shaders/spirv/normals/cost_octahedral.ggx.spv").as_slice(),
];
static LOOKUPS: [(usize, &[u8]); 2] = [(1, module!("LAYERS1.lookup")), (4, module!("LAYERS4.lookup"))];

/// A kernel that looks a texture up and shades what is there, under one light a pixel.
#[derive(Clone)]
pub struct Shading {
    pipeline: ComputePipeline,
    constants: CostConstants,
}

impl Shading {
    /// That of a method, of how lobes are stored, and of a material.
    ///
    /// # Errors
    /// [`NormalsError::Range`] for a material out of range, [`NormalsError::Method`] for other numbers of octahedral lobes
    /// than four, [`NormalsError::Gpu`].
    pub fn new(
        context: &Context,
        method: Method,
        storage: Storage,
        brdf: Brdf,
    ) -> Result<Self, NormalsError> {
        brdf.check()?;
        let (model, parameter) = match brdf {
            Brdf::Lambert => (0, 0.0),
            Brdf::BlinnPhong { exponent } => (1, exponent),
            Brdf::Ggx { alpha } => (2, alpha),
        };
        let mut bands = [[0.0; 4]; 2];
        if let Method::Harmonics(order) = method {
            let factors = band_factors(order, brdf)?.into_iter().map(|factor| factor as f32);
            bands.as_flattened_mut().iter_mut().zip(factors).for_each(|(band, factor)| *band = factor);
        }
        let found = MODULES.iter().find(|(of, _)| *of == method);
        let modules = match (method, storage) {
            (Method::Lobes(4), Storage::Octahedral8) => Some(&OCTAHEDRAL),
            (Method::Lobes(_) | Method::Taps, Storage::Octahedral8) => None,
            _ => found.map(|(_, modules)| modules),
        };
        let modules = modules.ok_or_else(|| NormalsError::Method { method: method.to_string() })?;
        Self::of(
            context,
            modules[model],
            CostConstants { parameter: parameter as f32, bands, ..Zeroable::zeroed() },
        )
    }

    /// So many lookups and no shading: 1 or 4.
    ///
    /// # Errors
    /// [`NormalsError::Range`] for another number, [`NormalsError::Gpu`].
    pub fn lookups(context: &Context, count: usize) -> Result<Self, NormalsError> {
        let (what, value, range) = ("the number of lookups", count as f64, "1 or 4");
        let found = LOOKUPS.iter().find(|(of, _)| *of == count);
        let (_, module) = found.ok_or(NormalsError::Range { what, value, range })?;
        Self::of(context, module, Zeroable::zeroed())
    }

    fn of(context: &Context, module: &[u8], constants: CostConstants) -> Result<Self, NormalsError> {
        let pipeline = context.create_compute_pipeline(&ComputePipelineDesc {
            name: "normals cost",
            spirv: &words(module),
            bindings: &BINDINGS,
            push_constant_size: size_of::<CostConstants>() as u32,
        })?;
        Ok(Self { pipeline, constants })
    }

    /// Records it over a picture of `size` pixels, whole multiples of 8, one f32 each in `output`; `level` is the mip of the
    /// texture.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for resources of another context.
    pub fn record(
        &self,
        recorder: &mut Recorder<'_>,
        (kept, sampler): (&ImageView, &Sampler),
        output: &Buffer,
        size: [u32; 2],
        level: f32,
    ) -> Result<(), GpuError> {
        let bound =
            [Binding::sampled(0, kept.clone()), Binding::sampler(1, sampler), Binding::storage(2, output)];
        recorder.bind_compute(&self.pipeline, &bound)?;
        recorder.push_constants(&CostConstants { size, level, ..self.constants })?;
        recorder.dispatch([size[0].div_ceil(8), size[1].div_ceil(8), 1])
    }
}

impl Bench<'_> {
    /// What a method keeps of a map as a texture to be sampled: from level 1 on, an array of four halves a texel and layer
    /// for what is averaged, as `settings` say for lobes. None for a map of one texel.
    ///
    /// # Errors
    /// As [`Bench::texture`] and [`Bench::averages`].
    pub fn kept(
        &self,
        map: &NormalMap,
        method: Method,
        settings: &Settings,
    ) -> Result<Option<Image>, NormalsError> {
        if let Method::Lobes(_) | Method::Taps = method {
            let lobes = if let Method::Lobes(lobes) = method { lobes } else { 4 };
            let fit = crate::FitSettings { lobes, ..settings.fit };
            let texture = self.texture(map, &Settings { fit, ..*settings })?;
            return Ok(texture.map(|texture| texture.image));
        }
        let levels = self.averages(map, method)?;
        let Some(finest) = levels.first() else { return Ok(None) };
        let [width, height] = finest.size.map(|size| size as u32);
        let desc = ImageDesc {
            mips: levels.len() as u32,
            layers: finest.vectors as u32,
            usage: ImageUsageFlags::SAMPLED | ImageUsageFlags::TRANSFER_DST,
            ..ImageDesc::new_2d(width, height, Format::R16G16B16A16_SFLOAT)
        };
        let image = self.context.create_image(Label::new("normals bench", "averages"), &desc)?;
        let mut staged = Vec::new();
        for level in &levels {
            let layer = |layer: usize| level.values.iter().skip(layer).step_by(level.vectors);
            let halves: Vec<[f16; 4]> =
                (0..level.vectors).flat_map(layer).map(|vector| vector.map(f16::from_f32)).collect();
            let bytes: Vec<[u16; 4]> = halves.iter().map(|vector| vector.map(f16::to_bits)).collect();
            staged.push(self.staging(&bytes)?);
        }
        self.frame(&mut |recorder| {
            recorder.transition(&image, State::UNDEFINED, Access::TransferDestination)?;
            (0..).zip(&staged).try_for_each(|(base_mip, buffer)| {
                let dimension = ImageViewType::TYPE_2D_ARRAY;
                let desc = ViewDesc { dimension, base_mip, mips: 1, base_layer: 0, layers: desc.layers };
                recorder.copy_buffer_to_image(buffer, &image.view(desc)?)
            })?;
            recorder.transition(&image, Access::TransferDestination, Access::FragmentSampled)
        })?;
        Ok(Some(image))
    }

    fn staging<T: Pod>(&self, values: &[T]) -> Result<Buffer, GpuError> {
        let usage = airglow_gpu::ash::vk::BufferUsageFlags::TRANSFER_SRC;
        let desc = BufferDesc { size: size_of_val(values) as u64, usage };
        let buffer =
            self.context.create_buffer(Label::new("normals bench", "averages"), &desc, Location::Upload)?;
        buffer.write(0, values)?;
        Ok(buffer)
    }
}

/// All mips and layers of a texture, as an array even of one layer.
///
/// # Errors
/// [`NormalsError::Gpu`].
pub fn whole(image: &Image) -> Result<ImageView, NormalsError> {
    let desc = image.desc();
    let dimension = ImageViewType::TYPE_2D_ARRAY;
    Ok(image.view(ViewDesc {
        dimension,
        base_mip: 0,
        mips: desc.mips,
        base_layer: 0,
        layers: desc.layers,
    })?)
}
