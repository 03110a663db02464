//! Kernels run one frame at a time, submitted and waited for by a host: what tests and evaluation use.

use std::path::Path;

use airglow_gpu::ash::vk::{BufferUsageFlags, ImageViewType};
use airglow_gpu::{
    Buffer, ComputePipeline, Context, GpuError, Label, Location, Readback, Recorder, ViewDesc,
};
use airglow_graph::{Access, BufferDesc, ImageDesc};
use bytemuck::Pod;

use crate::NormalsError;
use crate::brdf::{Brdf, Directions};
use crate::build::{Build, LobeTexture};
use crate::cache::{self, Miss, PackedChain};
use crate::kernels::{self, RowConstants};
use crate::map::NormalMap;
use crate::mixture::{MAX_LOBES, WeightedLobe};
use crate::normals::Normals;
use crate::settings::Settings;
use crate::stage::{Resource, Stage, Work, dispatch};

/// Rows of one dispatch: at most 52 MiB, below the least storage-buffer range of any device.
const ROWS: usize = 1 << 18;
const OWNER: &str = "normals bench";

/// Records what it is given into one frame of the bench's context, submits it and waits until it is done.
pub type Run<'a> =
    dyn Fn(&mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>) -> Result<(), GpuError> + 'a;

/// A host for single frames. This crate never submits or waits; the caller does, in `run`.
#[derive(Clone, Copy)]
pub struct Bench<'a> {
    /// The context frames are recorded for.
    pub context: &'a Context,
    /// Submits one frame and waits.
    pub run: &'a Run<'a>,
}

/// A row of `normals`: a mixture under a light.
#[derive(Clone, Debug)]
pub struct Row {
    /// At most [`MAX_LOBES`] lobes; more are left out.
    pub lobes: Vec<WeightedLobe>,
    /// The material.
    pub brdf: Brdf,
    /// Light and view.
    pub directions: Directions,
}

/// Where a chain came from.
#[derive(Debug)]
pub enum Source {
    /// The file held it.
    Cache,
    /// It was built and stored, because the file could not be used.
    Built(Miss),
}

/// The lobes of a level, `lobes` a texel, row by row, as the device left them: moment and weight.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelLobes {
    /// Columns and rows.
    pub size: [usize; 2],
    /// As many as were asked for, of each texel.
    pub lobes: Vec<[f32; 4]>,
}

impl Row {
    fn constants(&self) -> RowConstants {
        let mut lobes = [[0.0; 4]; MAX_LOBES];
        for (packed, lobe) in lobes.iter_mut().zip(&self.lobes) {
            *packed = lobe.packed();
        }
        let [light, half_vector] = kernels::material(self.brdf, self.directions);
        RowConstants { light, half_vector, lobes }
    }
}

impl Bench<'_> {
    /// The radiance of each row, by the functions of `lobe.glsl`.
    ///
    /// # Errors
    /// [`NormalsError::Range`] for a material out of range, [`NormalsError::Gpu`].
    pub fn radiance(&self, rows: &[Row]) -> Result<Vec<f32>, NormalsError> {
        rows.iter().try_for_each(|row| row.brdf.check())?;
        let pipeline = self.kernel("normals rows", &kernels::rows(), size_of::<u32>())?;
        let constants: Vec<RowConstants> = rows.iter().map(Row::constants).collect();
        self.rows(&pipeline, &constants)
    }

    /// A number for each row, by a kernel that takes their count.
    pub(crate) fn rows<T: Pod>(
        &self,
        pipeline: &ComputePipeline,
        rows: &[T],
    ) -> Result<Vec<f32>, NormalsError> {
        let mut radiance = Vec::with_capacity(rows.len());
        for rows in rows.chunks(ROWS) {
            let input = self.upload("rows", rows)?;
            let output = self.scratch("radiance", 4 * rows.len())?;
            let count = rows.len();
            self.frame(&mut |recorder| {
                dispatch(recorder, pipeline, [&input, &output], &(count as u32), count)
            })?;
            radiance.extend(self.read::<f32>(&output)?);
        }
        Ok(radiance)
    }

    /// The lobes of a map's levels in f32, finest level first, in the order of their neighbours'.
    ///
    /// # Errors
    /// As [`Normals::new`] and [`Normals::build`].
    pub fn build(&self, map: &NormalMap, settings: &Settings) -> Result<Vec<LevelLobes>, NormalsError> {
        self.levels(map, settings, |_| true)
    }

    /// The same as they are fitted, each texel by itself, before they are put in order.
    ///
    /// # Errors
    /// As [`Bench::build`].
    pub fn fitted(&self, map: &NormalMap, settings: &Settings) -> Result<Vec<LevelLobes>, NormalsError> {
        self.levels(map, settings, |stage| matches!(stage.work, Work::Fit { .. }))
    }

    /// The lobes of a map's levels after those steps of its build.
    fn levels(
        &self,
        map: &NormalMap,
        settings: &Settings,
        wanted: impl Fn(&Stage) -> bool,
    ) -> Result<Vec<LevelLobes>, NormalsError> {
        let mut build = Normals::new(self.context, *settings)?.build(self.context, map)?;
        self.steps(&mut build, wanted)?;
        let mut built = Vec::with_capacity(build.levels().len());
        for level in build.levels() {
            let Some(buffer) = build.buffer(Resource::Lobes(level.level)) else { continue };
            built.push(LevelLobes { size: level.size, lobes: self.read(buffer)? });
        }
        Ok(built)
    }

    /// The texture of a map, done. None for a map of one texel.
    ///
    /// # Errors
    /// As [`Bench::build`].
    pub fn texture(&self, map: &NormalMap, settings: &Settings) -> Result<Option<LobeTexture>, NormalsError> {
        let mut build = Normals::new(self.context, *settings)?.build(self.context, map)?;
        self.steps(&mut build, |_| true)?;
        Ok(build.texture().cloned())
    }

    /// The texture of a map and its chain, from the file at `path` if that holds this very chain, or built and stored there;
    /// either way the same bits. None for a map of one texel.
    ///
    /// # Errors
    /// As [`Bench::build`], and [`NormalsError::Store`] where the file cannot be written.
    pub fn cached(
        &self,
        path: &Path,
        map: &NormalMap,
        settings: &Settings,
    ) -> Result<(Option<LobeTexture>, Source), NormalsError> {
        let normals = Normals::new(self.context, *settings)?;
        let (mut build, source) = match cache::load(path, map, settings) {
            Ok(chain) => (normals.upload(self.context, map, &chain)?, Source::Cache),
            Err(miss) => (normals.build(self.context, map)?, Source::Built(miss)),
        };
        self.steps(&mut build, |_| true)?;
        if matches!(source, Source::Built(_)) {
            let mut copies = Vec::new();
            self.frame(&mut |recorder| {
                recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
                copies = build.read_back(recorder)?;
                Ok(())
            })?;
            let levels = copies.iter().map(Readback::read).collect::<Result<_, _>>()?;
            cache::store(path, map, settings, &PackedChain { levels })?;
        }
        Ok((build.texture().cloned(), source))
    }

    /// The bytes of each mip of a texture, layer by layer.
    ///
    /// # Errors
    /// [`NormalsError::Gpu`].
    pub fn bytes(&self, texture: &LobeTexture) -> Result<Vec<Vec<u8>>, NormalsError> {
        let image = &texture.image;
        let ImageDesc { mips, layers, .. } = *image.desc();
        let mut copies = Vec::new();
        self.frame(&mut |recorder| {
            recorder.transition(image, Access::FragmentSampled, Access::TransferSource)?;
            for base_mip in 0..mips {
                let dimension = ImageViewType::TYPE_2D_ARRAY;
                let desc = ViewDesc { dimension, base_mip, mips: 1, base_layer: 0, layers };
                copies.push(recorder.read_back_image(&image.view(desc)?)?);
            }
            recorder.transition(image, Access::TransferSource, Access::FragmentSampled)
        })?;
        Ok(copies.iter().map(Readback::read).collect::<Result<_, _>>()?)
    }

    /// Takes those steps of a build, each in a frame of its own.
    fn steps(&self, build: &mut Build, wanted: impl Fn(&Stage) -> bool) -> Result<(), NormalsError> {
        let mut steps = build.take(usize::MAX).iter().filter(|stage| wanted(stage));
        steps.try_for_each(|stage| self.frame(&mut |recorder| stage.record_with_barriers(recorder)))
    }

    /// One frame, whose host must have recorded it.
    pub(crate) fn frame(
        &self,
        record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>,
    ) -> Result<(), NormalsError> {
        let mut recorded = false;
        (self.run)(&mut |recorder| {
            recorded = true;
            record(recorder)
        })?;
        if recorded {
            return Ok(());
        }
        Err(GpuError::misuse("the bench", "its host did not record the frame").into())
    }

    /// What a buffer holds.
    pub(crate) fn read<T: Pod>(&self, buffer: &Buffer) -> Result<Vec<T>, NormalsError> {
        let mut copy = None;
        self.frame(&mut |recorder| {
            recorder.memory_barrier(Access::ComputeStorageReadWrite, Access::TransferSource)?;
            copy = Some(recorder.read_back_buffer(buffer)?);
            Ok(())
        })?;
        Ok(copy.as_ref().map(Readback::read).transpose()?.unwrap_or_default())
    }

    pub(crate) fn upload<T: Pod>(&self, name: &str, values: &[T]) -> Result<Buffer, GpuError> {
        let desc = BufferDesc { size: size_of_val(values) as u64, usage: BufferUsageFlags::STORAGE_BUFFER };
        let buffer = self.context.create_buffer(Label::new(OWNER, name), &desc, Location::Upload)?;
        buffer.write(0, values)?;
        Ok(buffer)
    }

    pub(crate) fn scratch(&self, name: &str, bytes: usize) -> Result<Buffer, GpuError> {
        let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::TRANSFER_SRC;
        let desc = BufferDesc { size: bytes as u64, usage };
        self.context.create_buffer(Label::new(OWNER, name), &desc, Location::Device)
    }
}
