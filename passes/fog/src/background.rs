//! An environment as it is seen through a medium: its convolution with the point spread function (Sun, thesis (2008),
//! section 3.6.4).

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use airglow_gpu::ash::vk::{self, BufferUsageFlags, ImageLayout};
use airglow_gpu::requirements::FormatNeed;
use airglow_gpu::{
    Binding, Buffer, ColorAttachment, ComputePipeline, Context, GpuError, GraphicsPipeline, Image, ImageView,
    Imports, Label, Load, Location, Record, Recorder, Rendering, Requirements,
};
use airglow_graph::{self as graph, Access, BufferDesc, Graph, Handle, LeftOut, PassKind, State};
use glam::DVec3;

use crate::distant::Distant;
use crate::envelope::{Envelope, Part, Pipelines};
use crate::error::check;
use crate::kernels::{BACKGROUND_BINDINGS, GatherConstants, LevelConstants};
use crate::{FogError, kernels};

/// How many of its radii a part of the map must be away to be taken as one: see the room's README for what it errs.
const AWAY: f32 = 2.0;

/// Convolves environments of one size with the point spread function, for the eye: a map of any size, made once for an
/// environment and a medium. Clones are the same one.
#[derive(Clone)]
pub struct Background {
    size: [u32; 2],
    parts: Buffer,
    reduce: ComputePipeline,
    gather: GraphicsPipeline,
    made: Arc<Mutex<Option<Asked>>>,
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

/// What a map is to be made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// The medium before the environment.
    pub distant: Distant,
    /// What the map holds.
    pub seen: Seen,
    /// A number that the host changes with the environment.
    pub version: u64,
}

impl Background {
    /// What a device must offer for results of `format`.
    #[must_use]
    pub fn requirements(format: vk::Format) -> Requirements {
        let mut requirements = Requirements::engine().with_descriptors(&BACKGROUND_BINDINGS);
        let usage = vk::FormatFeatureFlags::COLOR_ATTACHMENT;
        requirements.formats.push(FormatNeed { format, usage, why: "an environment through the medium" });
        requirements
    }

    /// For environments of `size` texels; the result is of `format`.
    ///
    /// # Errors
    /// [`FogError::Range`] for a side of 0 or above the device's limit, [`FogError::Gpu`] when the device refuses.
    pub fn new(context: &Context, size: [u32; 2], format: vk::Format) -> Result<Self, FogError> {
        let own = Pipelines::prepare(context, Envelope::of_backgrounds(format))?;
        Self::with_pipelines(context, size, format, &own)
    }

    /// The same with pipelines that were made before, on whatever thread: none is made here or while recording.
    ///
    /// # Errors
    /// [`FogError::Envelope`] where the envelope has not got it; else as [`Background::new`].
    pub fn with_pipelines(
        context: &Context,
        size: [u32; 2],
        format: vk::Format,
        pipelines: &Pipelines,
    ) -> Result<Self, FogError> {
        pipelines.envelope().check_part(Part::Background(format))?;
        let most = context.limits().max_image_dimension2_d;
        for side in size {
            let sound = (1..=most).contains(&side);
            check(|| "size".to_owned(), f64::from(side), sound, "a side from 1 to the device's limit")?;
        }
        let count: u64 = (1..=levels(size)).map(|level| parts(size, level)).sum();
        let desc = BufferDesc { size: 32 * count.max(1), usage: BufferUsageFlags::STORAGE_BUFFER };
        let label = Label::new("fog", "fog background parts");
        let reduce = pipelines.compute(&kernels::background_parts())?;
        let gather = pipelines.graphics(&kernels::background(format))?;
        let parts = context.create_buffer(label, &desc, Location::Device)?;
        Ok(Self { size, parts, reduce, gather, made: Arc::default() })
    }

    /// Bytes that it holds on the device.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.parts.size()
    }

    /// Adds `map`, the one image of the host's that this background is kept in, to a graph, to be sampled by fragment
    /// shaders; and, where it does not hold what is asked yet, the passes `fog background parts` and `fog background`
    /// that make it of the equirectangular `environment`. They are on record as left out else: a frame that has made it
    /// is declared anew after.
    ///
    /// # Errors
    /// [`FogError::Range`].
    pub fn add(
        &self,
        graph: &mut Graph<Record>,
        imports: &mut Imports,
        environment: Handle<graph::Image>,
        map: &Image,
        asked: Asked,
    ) -> Result<Handle<graph::Image>, FogError> {
        asked.distant.check()?;
        let sampled = State::from(Access::FragmentSampled);
        let kept = *self.lock() == Some(asked);
        let entry = if kept { sampled } else { State { layout: ImageLayout::UNDEFINED, ..sampled } };
        let target = graph.import_image("fog background", *map.desc(), entry, sampled);
        imports.image(&target, map);
        if kept {
            graph.leave_out(LeftOut {
                what: "fog background".to_owned(),
                why: "neither the environment nor the medium before it has changed".to_owned(),
                bytes: 0,
                time: None,
                would_return: "another environment or medium".to_owned(),
            });
            return Ok(target);
        }
        let read = Access::FragmentStorageRead;
        let parts = graph.import_buffer("fog background parts", *self.parts.desc(), read, read);
        imports.buffer(&parts, &self.parts);
        let mut pass = graph.pass("fog background parts", PassKind::Compute);
        pass.read(&environment, Access::ComputeSampled);
        let parts = pass.write(parts, Access::ComputeStorageWrite);
        let ours = self.clone();
        pass.record(Box::new(move |recorder, resources| {
            ours.reduce(recorder, &ours.bound(&resources.view(&environment)?))
        }));
        let mut pass = graph.pass("fog background", PassKind::Graphics);
        pass.read(&environment, Access::FragmentSampled).read(&parts, read);
        let target = pass.write(target, Access::ColorAttachmentWrite);
        let ours = self.clone();
        pass.record(Box::new(move |recorder, resources| {
            let bound = ours.bound(&resources.view(&environment)?);
            ours.gather(recorder, &bound, &resources.view(&target)?, &asked.distant, asked.seen)?;
            *ours.lock() = Some(asked);
            Ok(())
        }));
        Ok(target)
    }

    /// Records, without a graph, the convolution of an equirectangular `environment` into `target`, of any size. The
    /// environment is to be readable by compute shaders ([`Access::ComputeSampled`]), the target ready as a colour
    /// attachment; afterwards the environment is in use by fragment shaders, in the same layout. Barriers between its own
    /// steps, and after those of an earlier recording, are made here.
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
        let bound = self.bound(environment);
        recorder.memory_barrier(Access::FragmentStorageRead, Access::ComputeStorageWrite)?;
        self.reduce(recorder, &bound)?;
        recorder.memory_barrier(Access::ComputeStorageWrite, Access::FragmentStorageRead)?;
        // What the host made visible to compute shaders.
        recorder.memory_barrier(Access::ComputeSampled, Access::FragmentSampled)?;
        self.gather(recorder, &bound, target, distant, seen).map_err(FogError::Gpu)
    }

    fn bound(&self, environment: &ImageView) -> [Binding; 2] {
        [Binding::sampled(0, environment.clone()), Binding::storage(1, &self.parts)]
    }

    fn lock(&self) -> MutexGuard<'_, Option<Asked>> {
        self.made.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The pyramid, level by level.
    fn reduce(&self, recorder: &mut Recorder<'_>, bound: &[Binding]) -> Result<(), GpuError> {
        let (mut first, mut below) = (0, 0);
        for level in 1..=levels(self.size) {
            if level > 1 {
                recorder.memory_barrier(Access::ComputeStorageWrite, Access::ComputeStorageRead)?;
            }
            recorder.bind_compute(&self.reduce, bound)?;
            recorder.push_constants(&LevelConstants { size: self.size, level, first, below })?;
            let [width, height] = self.size.map(|side| side.div_ceil(1 << level).div_ceil(8));
            recorder.dispatch([width, height, 1])?;
            below = first;
            first += parts(self.size, level) as u32;
        }
        Ok(())
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
