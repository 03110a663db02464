//! Distant light through a medium: the environment as it is seen (Sun, thesis (2008), section 3.6.4), and by bands as it
//! lights (section 3.6.5). The fog takes it for a sphere of small lights that are all at one distance.

use airglow_gpu::ash::vk::{self, BufferUsageFlags};
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Blend, Buffer, ColorAttachment, ComputePipeline, ComputePipelineDesc,
    Context, GpuError, GraphicsPipeline, GraphicsPipelineDesc, ImageView, Label, Load, Location, Recorder,
    Rendering,
};
use airglow_graph::{Access, BufferDesc};
use airglow_math::MathError;
use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::error::check;
use crate::medium::Medium;
use crate::reference::spread;
use crate::{FogError, kernels};

/// Bindings of the kernels of the background: the environment, the pyramid of its parts.
pub const BACKGROUND_BINDINGS: [BindingDesc; 2] =
    [BindingDesc::new(0, BindingKind::SampledImage), BindingDesc::new(1, BindingKind::StorageBuffer)];

/// How many of its radii a part of the map must be away to be taken as one: see the room's README for what it errs.
const AWAY: f32 = 2.0;

/// The medium between a scene and its environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distant {
    /// Optical distance of the environment, red, green and blue, from 0 on.
    pub optical_distance: [f64; 3],
    /// Scattering albedo, 0 to 1.
    pub albedo: [f64; 3],
}

impl Distant {
    /// An environment `metres` away in a homogeneous medium.
    ///
    /// # Errors
    /// [`FogError::Range`]; [`FogError::Kernel`] for a medium that thins with height.
    pub fn new(medium: &Medium, metres: f64) -> Result<Self, FogError> {
        medium.check()?;
        check(|| "metres".to_owned(), metres, (0.0..=1e30).contains(&metres), "a distance from 0 on")?;
        if medium.thinning.is_some() {
            let (what, mend) = ("thins with height", "give a homogeneous one for distant light");
            return Err(FogError::Kernel { what, mend });
        }
        let optical_distance = medium.extinction.map(|extinction| extinction * metres);
        Ok(Self { optical_distance, albedo: medium.albedo })
    }

    /// What each band of an environment's spherical harmonics is multiplied with, for `order` bands: the attenuation plus
    /// the point spread function's own factor (eq. 3.35 to 3.37). A zonal filter for relighting, which then costs no more
    /// than in clear air.
    ///
    /// # Errors
    /// [`FogError::Range`], [`FogError::Math`] for an order out of range.
    pub fn band_factors(&self, order: usize) -> Result<Vec<[f64; 3]>, FogError> {
        self.check()?;
        let mut factors = vec![[0.0; 3]; order];
        for channel in 0..3 {
            let (optical, albedo) = (self.optical_distance[channel], self.albedo[channel]);
            let same = (0..channel).find(|&other| self.optical_distance[other] == optical);
            let spread = match same {
                Some(other) if self.albedo[other] == albedo => {
                    factors.iter_mut().for_each(|band| band[channel] = band[other]);
                    continue;
                }
                _ => spread_factors(order, optical)?,
            };
            for (band, spread) in factors.iter_mut().zip(spread) {
                band[channel] = (-optical).exp() + albedo * spread;
            }
        }
        Ok(factors)
    }

    /// The effective BRDF of a tabulated one (eq. 3.34): what answers the light of a lamp, straight, as `table` answers
    /// its glow. `table` holds, for each outgoing direction, the order² coefficients of the BRDF over incident directions
    /// of one channel; the result is in its layout.
    ///
    /// # Errors
    /// [`FogError::Range`], [`FogError::Math`] for an order out of range or a table that is no whole number of
    /// directions.
    pub fn effective_brdf(&self, channel: usize, order: usize, table: &[f64]) -> Result<Vec<f64>, FogError> {
        self.check()?;
        let number = channel as f64;
        check(|| "channel".to_owned(), number, channel < 3, "0, 1 or 2")?;
        let factors = spread_factors(order, self.optical_distance[channel])?;
        let mut effective = Vec::with_capacity(table.len());
        for coefficients in table.chunks(order * order) {
            effective.extend(spread::effective_brdf(&factors, coefficients)?);
        }
        effective.iter_mut().for_each(|value| *value *= self.albedo[channel]);
        Ok(effective)
    }

    /// Refuses what is out of range.
    ///
    /// # Errors
    /// [`FogError::Range`] with the field.
    pub fn check(&self) -> Result<(), FogError> {
        for value in self.optical_distance {
            check(
                || "optical_distance".to_owned(),
                value,
                (0.0..=1e36).contains(&value),
                "a number from 0 on",
            )?;
        }
        for value in self.albedo {
            check(|| "albedo".to_owned(), value, (0.0..=1.0).contains(&value), "a number from 0 to 1")?;
        }
        Ok(())
    }
}

/// Factors of the point spread function alone; none is left of either where the light has no path or never arrives.
fn spread_factors(order: usize, optical_distance: f64) -> Result<Vec<f64>, MathError> {
    if optical_distance == 0.0 || optical_distance > 700.0 {
        return spread::band_factors(order, |_| Ok(0.0));
    }
    spread::band_factors(order, |gamma| spread::exact(optical_distance, gamma))
}

/// Convolves environments of one size with the point spread function, for the eye: a map of their size, made once for
/// an environment and a medium.
#[derive(Clone)]
pub struct Background {
    size: [u32; 2],
    parts: Buffer,
    reduce: ComputePipeline,
    gather: GraphicsPipeline,
}

/// Push constants of `background_parts.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct LevelConstants {
    size: [u32; 2],
    level: u32,
    first: u32,
    below: u32,
}

/// Push constants of `background.frag`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct GatherConstants {
    optical: [f32; 4],
    albedo: [f32; 4],
    size: [u32; 2],
    target: [u32; 2],
    levels: u32,
    straight: f32,
    padding: [u32; 2],
}

/// What of an environment in fog a map holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seen {
    /// All that is seen: what arrives straight, and the glow.
    Whole,
    /// The glow alone, smooth but for its peaks: for a host that has a smaller map of it, and adds exp(-T) of the
    /// environment itself at full resolution.
    Glow,
}

impl Background {
    /// For maps of `size` texels; the result is of `format`.
    ///
    /// # Errors
    /// [`FogError::Range`] for a side of 0 or above the device's limit, [`FogError::Gpu`] when the device refuses.
    pub fn new(context: &Context, size: [u32; 2], format: vk::Format) -> Result<Self, FogError> {
        let most = context.limits().max_image_dimension2_d;
        for side in size {
            let sound = (1..=most).contains(&side);
            check(|| "size".to_owned(), f64::from(side), sound, "a side from 1 to the device's limit")?;
        }
        let count: u64 = (1..=levels(size)).map(|level| parts(size, level)).sum();
        let desc = BufferDesc { size: 32 * count.max(1), usage: BufferUsageFlags::STORAGE_BUFFER };
        let label = Label::new("fog", "fog background parts");
        let reduce = context.create_compute_pipeline(&ComputePipelineDesc {
            name: "fog background parts",
            spirv: &kernels::background_parts(),
            bindings: &BACKGROUND_BINDINGS,
            push_constant_size: size_of::<LevelConstants>() as u32,
        })?;
        let gather = context.create_graphics_pipeline(&GraphicsPipelineDesc {
            name: "fog background",
            vertex: &kernels::rectangle(),
            fragment: Some(&kernels::background()),
            bindings: &BACKGROUND_BINDINGS,
            push_constant_size: size_of::<GatherConstants>() as u32,
            vertex_buffers: &[],
            topology: vk::PrimitiveTopology::TRIANGLE_LIST,
            cull: vk::CullModeFlags::NONE,
            front_face: vk::FrontFace::COUNTER_CLOCKWISE,
            depth: None,
            colors: &[format],
            blend: Blend::None,
        })?;
        Ok(Self { size, parts: context.create_buffer(label, &desc, Location::Device)?, reduce, gather })
    }

    /// Records the convolution of an equirectangular `environment` into `target`, of any size. The environment is to be
    /// readable by compute and fragment shaders ([`Access::ComputeSampled`], [`Access::FragmentSampled`]), the target
    /// ready as a colour attachment; barriers between its own steps are made here.
    ///
    /// # Errors
    /// [`FogError::Range`], [`FogError::Gpu`] for views that do not fit.
    pub fn record(
        &self,
        recorder: &mut Recorder<'_>,
        environment: &ImageView,
        target: &ImageView,
        distant: &Distant,
        seen: Seen,
    ) -> Result<(), FogError> {
        distant.check()?;
        let bound = [Binding::sampled(0, environment.clone()), Binding::storage(1, &self.parts)];
        let (mut first, mut below) = (0, 0);
        for level in 1..=levels(self.size) {
            recorder.bind_compute(&self.reduce, &bound)?;
            recorder.push_constants(&LevelConstants { size: self.size, level, first, below })?;
            let [width, height] = self.size.map(|side| side.div_ceil(1 << level).div_ceil(8));
            recorder.dispatch([width, height, 1])?;
            recorder.memory_barrier(Access::ComputeStorageWrite, Access::ComputeStorageRead)?;
            below = first;
            first += parts(self.size, level) as u32;
        }
        recorder.memory_barrier(Access::ComputeStorageWrite, Access::FragmentStorageRead)?;
        self.gather(recorder, &bound, target, distant, seen).map_err(FogError::Gpu)
    }

    fn gather(
        &self,
        recorder: &mut Recorder<'_>,
        bound: &[Binding],
        target: &ImageView,
        distant: &Distant,
        seen: Seen,
    ) -> Result<(), GpuError> {
        let [red, green, blue] = distant.optical_distance;
        let grey = f32::from(u8::from(red == green && green == blue));
        // Nothing is left of light from farther.
        let vector = |v: [f64; 3], w| DVec3::from(v).min(DVec3::splat(1e4)).as_vec3().extend(w).to_array();
        let extent = target.extent();
        let constants = GatherConstants {
            optical: vector(distant.optical_distance, AWAY),
            albedo: vector(distant.albedo, grey),
            size: self.size,
            target: extent,
            levels: levels(self.size),
            straight: f32::from(u8::from(seen == Seen::Whole)),
            padding: [0; 2],
        };
        let colors = [ColorAttachment { view: target, load: Load::Discard }];
        recorder.begin_rendering(&Rendering { colors: &colors, depth: None })?;
        recorder.bind_graphics(&self.gather, bound)?;
        recorder.push_constants(&constants)?;
        recorder.draw(0..3, 0..1)?;
        recorder.end_rendering()
    }
}

/// The last level of the pyramid, of at most two rows.
fn levels([_, height]: [u32; 2]) -> u32 {
    height.div_ceil(2).next_power_of_two().ilog2()
}

/// Parts of a level.
fn parts(size: [u32; 2], level: u32) -> u64 {
    size.map(|side| u64::from(side.div_ceil(1 << level))).into_iter().product()
}
