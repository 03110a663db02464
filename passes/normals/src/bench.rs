//! Kernels run one frame at a time, submitted and waited for by a host: what tests and evaluation use.

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{
    Binding, Buffer, ComputePipeline, ComputePipelineDesc, Context, GpuError, Label, Location, Recorder,
};
use airglow_graph::{Access, BufferDesc};
use bytemuck::Pod;

use crate::NormalsError;
use crate::brdf::{Brdf, Directions};
use crate::chain::{self, MOST_ITERATIONS};
use crate::fit::FitSettings;
use crate::kernels::{self, BINDINGS, FitConstants, RowConstants};
use crate::map::NormalMap;
use crate::mixture::{MAX_LOBES, WeightedLobe};

/// Invocations of a workgroup of both kernels.
const GROUP: usize = 64;
/// Rows of one dispatch: 32 MiB, below the least storage-buffer range of any device.
const ROWS: usize = 1 << 18;
const OWNER: &str = "normals";

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
        let (kind, parameter) = match self.brdf {
            Brdf::Lambert => (0.0, 0.0),
            Brdf::BlinnPhong { exponent } => (1.0, exponent),
            Brdf::Ggx { alpha } => (2.0, alpha),
        };
        let mut lobes = [[0.0; 4]; MAX_LOBES];
        for (packed, lobe) in lobes.iter_mut().zip(&self.lobes) {
            *packed = lobe.packed();
        }
        RowConstants {
            light: self.directions.light.extend(kind).as_vec4().to_array(),
            half_vector: self.directions.half.extend(parameter).as_vec4().to_array(),
            lobes,
        }
    }
}

impl Bench<'_> {
    /// The radiance of each row, by the functions of `lobe.glsl`.
    ///
    /// # Errors
    /// [`NormalsError::Range`] for a material out of range, [`NormalsError::Gpu`].
    pub fn radiance(&self, rows: &[Row]) -> Result<Vec<f32>, NormalsError> {
        rows.iter().try_for_each(|row| row.brdf.check())?;
        let pipeline = self.pipeline("normals rows", &kernels::rows(), size_of::<u32>())?;
        let mut radiance = Vec::with_capacity(rows.len());
        for rows in rows.chunks(ROWS) {
            let constants: Vec<RowConstants> = rows.iter().map(Row::constants).collect();
            let input = self.upload("rows", &constants)?;
            let output = self.scratch("radiance", 4 * rows.len())?;
            radiance.extend(self.dispatch::<_, f32>(
                &pipeline,
                &input,
                &output,
                rows.len(),
                &(rows.len() as u32),
            )?);
        }
        Ok(radiance)
    }

    /// The chain of a map, finest level first, without the map itself.
    ///
    /// # Errors
    /// [`NormalsError::Range`] for settings without kernel, [`NormalsError::Budget`], [`NormalsError::Gpu`].
    pub fn build(
        &self,
        map: &NormalMap,
        fit: &FitSettings,
        budget: u64,
    ) -> Result<Vec<LevelLobes>, NormalsError> {
        if fit.iterations > MOST_ITERATIONS {
            let (what, value) = ("the number of iterations", fit.iterations as f64);
            return Err(NormalsError::Range { what, value, range: "0 to 32 on a device" });
        }
        let levels = chain::levels(map, fit, budget)?;
        let pipeline = self.pipeline("normals fit", &kernels::fit(fit.lobes)?, size_of::<FitConstants>())?;
        let normals: Vec<[f32; 4]> =
            map.normals().iter().map(|n| n.extend(1.0).as_vec4().to_array()).collect();
        let mut sources = vec![self.upload("normals", &normals)?];
        let mut built = Vec::with_capacity(levels.len());
        for level in levels {
            let texels = level.size[0] * level.size[1];
            let output = self.scratch("lobes", texels * fit.lobes * size_of::<[f32; 4]>())?;
            let constants = FitConstants {
                fine: map.size(level.source).map(|size| size as u32),
                size: level.size.map(|size| size as u32),
                per_texel: if level.source == 0 { 1 } else { fit.lobes as u32 },
                iterations: fit.iterations as u32,
                sharpest: fit.sharpest as f32,
                unused: 0,
            };
            let lobes = self.dispatch(&pipeline, &sources[level.source], &output, texels, &constants)?;
            built.push(LevelLobes { size: level.size, lobes });
            sources.push(output);
        }
        Ok(built)
    }

    fn pipeline(&self, name: &str, spirv: &[u32], constants: usize) -> Result<ComputePipeline, GpuError> {
        let push_constant_size = constants as u32;
        self.context.create_compute_pipeline(&ComputePipelineDesc {
            name,
            spirv,
            bindings: &BINDINGS,
            push_constant_size,
        })
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

    /// Runs one dispatch of `count` invocations and reads what it wrote.
    fn dispatch<C: Pod, T: Pod>(
        &self,
        pipeline: &ComputePipeline,
        input: &Buffer,
        output: &Buffer,
        count: usize,
        constants: &C,
    ) -> Result<Vec<T>, GpuError> {
        let mut copy = None;
        (self.run)(&mut |recorder| {
            recorder.bind_compute(pipeline, &[Binding::storage(0, input), Binding::storage(1, output)])?;
            recorder.push_constants(constants)?;
            recorder.dispatch([count.div_ceil(GROUP) as u32, 1, 1])?;
            recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
            copy = Some(recorder.read_back_buffer(output)?);
            Ok(())
        })?;
        copy.ok_or_else(|| GpuError::misuse("the bench", "its host did not record the frame"))?.read()
    }
}
