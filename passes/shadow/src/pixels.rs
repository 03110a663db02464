//! The pass per pixel: shadows on what a host has drawn, by images of positions and normals; light comes out.

use std::sync::{Arc, Mutex, PoisonError};

use airglow_gpu::ash::vk::Format;
use airglow_gpu::{
    Binding, Buffer, ComputePipeline, Context, GpuError, ImageView, Kernel, Record, Recorder, Requirements,
};
use airglow_graph::{Access, Graph, Handle, Image, ImageDesc, LeftOut, PassKind};

use crate::ShadowError;
use crate::blockers::Blockers;
use crate::envelope::Pipelines;
use crate::exponential::Exponential;
use crate::kernels::{self, PIXEL_BINDINGS, PixelConstants};
use crate::light::{Disc, Products};
use crate::polynomial;
use crate::settings::Settings;
use crate::shadow::upload;
use crate::table::Tables;

/// Sides of a tile.
const TILE: u32 = 8;

/// What the pass does with a host's images, for a host with a frame graph of its own: names as in [`PixelViews`].
pub const PIXEL_ACCESSES: [(&str, Access); 3] = [
    ("positions", Access::ComputeSampled),
    ("normals", Access::ComputeSampled),
    ("picture", Access::ComputeStorageWrite),
];

/// The images of one recording, all of the size it is given.
#[derive(Clone)]
pub struct PixelViews {
    /// Points of surfaces in the space of the spheres, float; w 0 where there is none, and none is where a number is not
    /// finite.
    pub positions: ImageView,
    /// Normals there, of any length but 0.
    pub normals: ImageView,
    /// Written, [`PixelShadow::FORMAT`]: [`PixelPicture`], linear RGB, and in a the share of the sky that is open.
    pub picture: ImageView,
}

/// Light that falls on a picture, in the space of the spheres.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelLight {
    /// Of the environment, of the pass's order.
    pub products: Products,
    /// A sun-like peak that was taken out of it.
    pub disc: Option<Disc>,
    /// What comes out.
    pub picture: PixelPicture,
}

/// What the picture of the pass says of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelPicture {
    /// What a white diffuse surface reflects of the light that spheres leave; 0 where there is no surface.
    Light,
    /// The share of that in what it would reflect without spheres, for a host that has lit its surfaces otherwise: 1, to
    /// the last bit, where nothing blocks, and where there is no surface.
    Share,
}

/// The light that the pass reads when it is recorded. Clones share it.
#[derive(Clone, Debug)]
pub struct PixelLights(Arc<Mutex<PixelLight>>);

impl PixelLights {
    /// Light to begin with.
    #[must_use]
    pub fn new(light: PixelLight) -> Self {
        Self(Arc::new(Mutex::new(light)))
    }

    /// Sets the light from the next recording on.
    pub fn set(&self, light: PixelLight) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = light;
    }

    fn get(&self) -> PixelLight {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// The pass per pixel, ready for a device, by the default exponential; receivers have normals always. Clones share it.
#[derive(Clone)]
pub struct PixelShadow {
    settings: Settings,
    pipeline: ComputePipeline,
    pipeline_count: usize,
    factors: Buffer,
    table: Buffer,
}

/// The kernel over pixels of settings in order.
fn kernel(settings: &Settings) -> Result<Kernel, ShadowError> {
    settings.check()?;
    let kernel = kernels::pixels(settings.order).filter(|_| settings.exponential == Exponential::Adaptive);
    kernel.ok_or_else(|| {
        let (method, known) = (format!("{:?}", settings.exponential), "the default, per pixel");
        ShadowError::Method { method, known }
    })
}

impl PixelShadow {
    /// Format of the picture.
    pub const FORMAT: Format = Format::R16G16B16A16_SFLOAT;

    /// What the device must offer.
    #[must_use]
    pub fn requirements() -> Requirements {
        Requirements::engine().with_descriptors(&PIXEL_BINDINGS)
    }

    /// Makes tables and pipeline. Of the settings, [`Settings::normals`] is taken to be on.
    ///
    /// # Errors
    /// As [`Settings::check`]; [`ShadowError::Method`] for another exponential than the default; [`ShadowError::Gpu`].
    pub fn new(context: &Context, settings: Settings) -> Result<Self, ShadowError> {
        Self::with_pipeline(context, settings, kernel(&settings)?.compute_pipeline(context)?, 1)
    }

    /// The same with pipelines that were made before, on whatever thread: none is made here or while recording.
    ///
    /// # Errors
    /// [`ShadowError::Envelope`] for settings outside the envelope they were prepared for; else as [`PixelShadow::new`].
    pub fn with_pipelines(
        context: &Context,
        settings: Settings,
        pipelines: &Pipelines,
    ) -> Result<Self, ShadowError> {
        let kernel = kernel(&settings)?;
        pipelines.envelope().check_pixels(&settings)?;
        Self::with_pipeline(context, settings, pipelines.compute(&kernel)?, pipelines.count())
    }

    /// With the pipeline of [`kernel`], one of so many that are ready.
    fn with_pipeline(
        context: &Context,
        settings: Settings,
        pipeline: ComputePipeline,
        pipeline_count: usize,
    ) -> Result<Self, ShadowError> {
        let factors = upload(context, "factors", &Tables::new(settings.order, settings.clip)?.logarithm)?;
        let table = upload(context, "exponential", &polynomial::table())?;
        Ok(Self { settings, pipeline, pipeline_count, factors, table })
    }

    /// Records the pass: no barrier before or after. The host has made the images ready for [`PIXEL_ACCESSES`].
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for views that do not fit, light of another order, and spheres of more than one range.
    pub fn record(
        &self,
        recorder: &mut Recorder<'_>,
        size: [u32; 2],
        blockers: &Blockers,
        light: &PixelLight,
        views: &PixelViews,
    ) -> Result<(), GpuError> {
        let ranges = blockers.ranges();
        let [range] = ranges.as_slice() else {
            return Err(GpuError::misuse("the spheres of pixels", "more than one uniform range holds"));
        };
        if light.products.order() != self.settings.order {
            return Err(GpuError::misuse("the light of pixels", "not of the order of the pass"));
        }
        let (spheres, nodes) = (recorder.upload(&range.spheres)?, recorder.upload(&range.nodes)?);
        let products = recorder.upload(&light.products.table())?;
        let bound = [
            Binding::sampled(0, views.positions.clone()),
            Binding::sampled(1, views.normals.clone()),
            Binding::uniform(2, &spheres),
            Binding::uniform(3, &self.factors),
            Binding::storage_image(4, views.picture.clone()),
            Binding::uniform(7, &self.table),
            Binding::uniform(8, &nodes),
            Binding::uniform(9, &products),
        ];
        recorder.bind_compute(&self.pipeline, &bound)?;
        recorder.push_constants(&self.constants(size, range.len() as u32, light))?;
        let [width, height] = size.map(|side| side.div_ceil(TILE));
        recorder.dispatch([width, height, 1])
    }

    fn constants(&self, size: [u32; 2], count: u32, light: &PixelLight) -> PixelConstants {
        let disc = light.disc;
        let wide = |[x, y, z]: [f64; 3]| [x as f32, y as f32, z as f32, 0.0];
        PixelConstants {
            size,
            count,
            flags: u32::from(self.settings.clamp) | u32::from(light.picture == PixelPicture::Share) << 1,
            reach: self.settings.reach as f32,
            cut: self.settings.cut as f32,
            window: self.settings.window as f32,
            disc_radius: disc.map_or(0.0, |disc| disc.angular_radius as f32),
            disc: disc.map_or([0.0; 4], |disc| wide(disc.direction.to_array())),
            irradiance: disc.map_or([0.0; 4], |disc| wide(disc.irradiance)),
        }
    }

    /// Adds the pass `shadow pixels` to a graph; the picture it makes. The plan may be recorded again in later frames;
    /// [`Blockers::set`] moves the spheres in between, and [`PixelLights::set`] the light. Where there are no spheres now it
    /// is left out, with the reason.
    pub fn add(
        &self,
        graph: &mut Graph<Record>,
        size: [u32; 2],
        blockers: &Blockers,
        light: &PixelLights,
        [positions, normals]: [Handle<Image>; 2],
    ) -> Option<Handle<Image>> {
        if blockers.is_empty() {
            graph.leave_out(LeftOut {
                what: "shadow pixels".to_owned(),
                why: "nothing that moves blocks".to_owned(),
                bytes: 8 * u64::from(size[0]) * u64::from(size[1]),
                time: None,
                would_return: "a sphere with a radius".to_owned(),
            });
            return None;
        }
        graph.pipelines("shadow", self.pipeline_count);
        let [(_, reads), _, (_, writes)] = PIXEL_ACCESSES;
        let mut pass = graph.pass("shadow pixels", PassKind::Compute);
        pass.read(&positions, reads).read(&normals, reads);
        let picture =
            pass.create_image("shadow picture", ImageDesc::new_2d(size[0], size[1], Self::FORMAT), writes);
        let (shadow, blockers, light) = (self.clone(), blockers.clone(), light.clone());
        pass.record(Box::new(move |recorder, resources| {
            let views = PixelViews {
                positions: resources.view(&positions)?,
                normals: resources.view(&normals)?,
                picture: resources.view(&picture)?,
            };
            shadow.record(recorder, size, &blockers, &light.get(), &views)
        }));
        Some(picture)
    }
}
