//! Kernels run one frame at a time, submitted and waited for by a host: what tests and evaluation use.

use std::time::{Duration, Instant};

use airglow_gpu::ash::vk::{BufferUsageFlags, Format, ImageUsageFlags};
use airglow_gpu::{
    Binding, Buffer, ComputePipelineDesc, Context, GpuError, Image, Label, Location, Recorder,
};
use airglow_graph::{Access, BufferDesc, ImageDesc, State};
use bytemuck::Pod;
use glam::DMat4;

use crate::blockers::Blockers;
use crate::exponential::Exponential;
use crate::kernels::{self, Kind, Program, ROW_BINDINGS, RowConstants};
use crate::pixels::{PixelLight, PixelShadow, PixelViews};
use crate::settings::Settings;
use crate::shadow::{Bindings, Shadow};
use crate::table::Tables;
use crate::{CLIP, Counts, ShadowError, Sphere, check_order};

const OWNER: &str = "bench";
/// Rows of one dispatch.
const ROWS: usize = 1 << 16;

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

/// What a kernel makes of rows of coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RowKernel {
    /// An exponential.
    Exponential(Exponential),
    /// The product with the row itself, so many times.
    Product(u32),
    /// The square, so many times.
    Square(u32),
}

/// What a kernel makes of spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SphereKernel {
    /// The pass with the exponential of the settings.
    Pass,
    /// The rival: products of the spheres' visibilities, one after the other.
    Products,
    /// The sum of the logarithms, without exponential.
    Logarithm,
}

/// A frame's results.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// `order^2` values a receiver.
    pub values: Vec<f32>,
    /// What the kernel counted.
    pub counts: Counts,
    /// Wall time of each run, submission and waiting included; the first compiles.
    pub times: Vec<Duration>,
}

/// Receivers of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// Object space.
    pub positions: &'a [[f32; 3]],
    /// With [`Settings::normals`].
    pub normals: Option<&'a [[f32; 3]]>,
    /// In the same space.
    pub spheres: &'a [Sphere],
}

impl Bench<'_> {
    /// Runs a kernel over rows of `order^2` coefficients, `repeats` times; returns the results and each run's wall time.
    ///
    /// # Errors
    /// [`ShadowError::Order`], [`ShadowError::Length`] unless the rows are whole, [`ShadowError::Gpu`].
    pub fn rows(
        &self,
        order: usize,
        kernel: RowKernel,
        rows: &[f32],
        repeats: usize,
    ) -> Result<(Vec<f32>, Vec<Duration>), ShadowError> {
        check_order(order)?;
        let width = order * order;
        if !rows.len().is_multiple_of(width) {
            let expected = rows.len().next_multiple_of(width);
            return Err(ShadowError::Length {
                what: "coefficients of whole rows",
                expected,
                actual: rows.len(),
            });
        }
        let (program, repeat) = match kernel {
            RowKernel::Exponential(method) => {
                method.check()?;
                (Program::of(method), 1)
            }
            RowKernel::Product(repeat) => (Program::without_constants(Kind::Product), repeat),
            RowKernel::Square(repeat) => (Program::without_constants(Kind::Square), repeat),
        };
        let spirv = kernels::rows(program.kind, order).ok_or(ShadowError::Order { order })?;
        let table = match program.table(&Tables::new(order, CLIP)?) {
            Some((values, end)) => Some((self.upload("table", &values)?, end)),
            None => None,
        };
        let bindings = if table.is_some() { &ROW_BINDINGS[..] } else { &ROW_BINDINGS[..2] };
        let push_constant_size = size_of::<RowConstants>() as u32;
        let desc = ComputePipelineDesc { name: "shadow rows", spirv: &spirv, bindings, push_constant_size };
        let pipeline = self.context.create_compute_pipeline(&desc)?;
        let (mut results, mut times) = (Vec::with_capacity(rows.len()), Vec::new());
        for rows in rows.chunks(ROWS * width) {
            let count = (rows.len() / width) as u32;
            let (input, output) = (self.upload("rows", rows)?, self.scratch("results", 4 * rows.len())?);
            let constants = RowConstants {
                count,
                degree: program.degree,
                norm: program.norm,
                whole: program.whole,
                repeat,
                end: table.as_ref().map_or(1.0, |(_, end)| *end),
            };
            for _ in 0..repeats.max(1) {
                let begin = Instant::now();
                (self.run)(&mut |recorder| {
                    let [a, b] = [Binding::storage(0, &input), Binding::storage(1, &output)];
                    match &table {
                        Some((table, _)) => {
                            recorder.bind_compute(&pipeline, &[a, b, Binding::storage(2, table)])?;
                        }
                        None => recorder.bind_compute(&pipeline, &[a, b])?,
                    }
                    recorder.push_constants(&constants)?;
                    recorder.dispatch([count.div_ceil(64), 1, 1])
                })?;
                times.push(begin.elapsed());
            }
            results.extend(self.read::<f32>(&output)?);
        }
        Ok((results, times))
    }

    /// Runs the pass over a scene, `repeats` times.
    ///
    /// # Errors
    /// As [`Shadow::new`], [`Shadow::receivers`] and [`Blockers::set`].
    pub fn spheres(
        &self,
        settings: Settings,
        kernel: SphereKernel,
        scene: &Scene<'_>,
        repeats: usize,
    ) -> Result<Frame, ShadowError> {
        self.frame(&self.shadow(settings, kernel)?, scene, repeats)
    }

    /// The pass with a kernel, for [`Self::frame`].
    ///
    /// # Errors
    /// As [`Shadow::new`].
    pub fn shadow(&self, settings: Settings, kernel: SphereKernel) -> Result<Shadow, ShadowError> {
        match kernel {
            SphereKernel::Pass => Shadow::new(self.context, settings),
            SphereKernel::Products => Shadow::products(self.context, settings),
            SphereKernel::Logarithm => Shadow::logarithm(self.context, settings),
        }
    }

    /// Runs a pass over a scene, `repeats` times.
    ///
    /// # Errors
    /// As [`Shadow::receivers`] and [`Blockers::set`].
    pub fn frame(&self, shadow: &Shadow, scene: &Scene<'_>, repeats: usize) -> Result<Frame, ShadowError> {
        let blockers = Blockers::default();
        blockers.set(scene.spheres, DMat4::IDENTITY)?;
        self.blocked(shadow, scene.positions, scene.normals, &blockers, repeats)
    }

    /// Runs a pass over receivers with blockers as they are, `repeats` times.
    ///
    /// # Errors
    /// As [`Shadow::receivers`].
    pub fn blocked(
        &self,
        shadow: &Shadow,
        positions: &[[f32; 3]],
        normals: Option<&[[f32; 3]]>,
        blockers: &Blockers,
        repeats: usize,
    ) -> Result<Frame, ShadowError> {
        let receivers = shadow.receivers(self.context, "receivers", positions)?;
        let bytes = receivers.visibility_bytes(shadow.settings().order);
        let visibility = self.scratch("visibility", bytes as usize)?;
        let records = self.scratch("records", receivers.record_bytes() as usize)?;
        let bindings = Bindings {
            positions: (&self.upload("positions", positions)?).into(),
            normals: normals.map(|n| self.upload("normals", n)).transpose()?.as_ref().map(Into::into),
            visibility: (&visibility).into(),
            records: (&records).into(),
        };
        let mut times = Vec::new();
        for _ in 0..repeats.max(1) {
            let begin = Instant::now();
            (self.run)(&mut |recorder| shadow.record(recorder, &receivers, blockers, &bindings))?;
            times.push(begin.elapsed());
        }
        let counts = Counts::of(&self.read::<[u32; 2]>(&records)?);
        Ok(Frame { values: self.read(&visibility)?, counts, times })
    }

    /// Runs the pass per pixel once over a picture of `size` whose positions and normals are given row by row, as
    /// [`PixelViews`] says.
    ///
    /// # Errors
    /// [`ShadowError::Gpu`], for texels that do not fill the picture, too.
    pub fn pixels(
        &self,
        shadow: &PixelShadow,
        size: [u32; 2],
        surfaces: [&[[f32; 4]]; 2],
        blockers: &Blockers,
        light: &PixelLight,
    ) -> Result<Vec<[f32; 4]>, ShadowError> {
        let [positions, normals] = surfaces.map(|texels| self.image(size, texels));
        let (positions, normals) = (positions?, normals?);
        let usage = ImageUsageFlags::STORAGE | ImageUsageFlags::TRANSFER_SRC;
        let desc = ImageDesc { usage, ..ImageDesc::new_2d(size[0], size[1], PixelShadow::FORMAT) };
        let picture = self.context.create_image(Label::new(OWNER, "picture"), &desc)?;
        let views = PixelViews {
            positions: positions.full_view()?,
            normals: normals.full_view()?,
            picture: picture.full_view()?,
        };
        let mut copy = None;
        (self.run)(&mut |recorder| {
            recorder.transition(&picture, State::UNDEFINED, Access::ComputeStorageWrite)?;
            shadow.record(recorder, size, blockers, light, &views)?;
            recorder.transition(&picture, Access::ComputeStorageWrite, Access::TransferSource)?;
            copy = Some(recorder.read_back_image(&views.picture)?);
            Ok(())
        })?;
        Ok(copy.ok_or_else(not_recorded)?.texels()?)
    }

    /// An image of these texels, ready to be sampled.
    ///
    /// # Errors
    /// [`GpuError`], for texels that do not fill it, too.
    pub fn image(&self, [width, height]: [u32; 2], texels: &[[f32; 4]]) -> Result<Image, GpuError> {
        let usage = ImageUsageFlags::TRANSFER_DST | ImageUsageFlags::SAMPLED;
        let desc = ImageDesc { usage, ..ImageDesc::new_2d(width, height, Format::R32G32B32A32_SFLOAT) };
        let image = self.context.create_image(Label::new(OWNER, "surfaces"), &desc)?;
        let desc = BufferDesc {
            size: 16 * u64::from(width) * u64::from(height),
            usage: Access::TransferSource.buffer_usage(),
        };
        let staging = self.context.create_buffer(Label::new(OWNER, "texels"), &desc, Location::Upload)?;
        staging.write(0, texels)?;
        (self.run)(&mut |recorder| {
            recorder.transition(&image, State::UNDEFINED, Access::TransferDestination)?;
            recorder.copy_buffer_to_image(&staging, &image.full_view()?)?;
            recorder.transition(&image, Access::TransferDestination, Access::ComputeSampled)
        })?;
        Ok(image)
    }

    fn upload<T: Pod>(&self, name: &str, values: &[T]) -> Result<Buffer, GpuError> {
        let desc = BufferDesc { size: size_of_val(values) as u64, usage: BufferUsageFlags::STORAGE_BUFFER };
        let buffer = self.context.create_buffer(Label::new(OWNER, name), &desc, Location::Upload)?;
        buffer.write(0, values)?;
        Ok(buffer)
    }

    fn scratch(&self, name: &str, bytes: usize) -> Result<Buffer, GpuError> {
        let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::TRANSFER_SRC;
        let desc = BufferDesc { size: bytes as u64, usage };
        self.context.create_buffer(Label::new(OWNER, name), &desc, Location::Device)
    }

    /// Reads what an earlier frame wrote.
    fn read<T: Pod>(&self, buffer: &Buffer) -> Result<Vec<T>, GpuError> {
        let mut copy = None;
        (self.run)(&mut |recorder| {
            recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
            copy = Some(recorder.read_back_buffer(buffer)?);
            Ok(())
        })?;
        copy.ok_or_else(not_recorded)?.read()
    }
}

fn not_recorded() -> GpuError {
    GpuError::misuse("the bench", "its host did not record the frame")
}
