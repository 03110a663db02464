//! The rivals on the device, for evaluation and reports: their chains, and the radiance of what these hold.

use airglow_gpu::{ComputePipeline, ComputePipelineDesc, GpuError};

use crate::NormalsError;
use crate::bench::Bench;
use crate::brdf::{Brdf, Directions};
use crate::harmonics::band_factors;
use crate::kernels::{self, AverageConstants, BINDINGS, MOST_VECTORS, RivalConstants};
use crate::map::NormalMap;
use crate::method::Method;
use crate::stage::dispatch;
use airglow_math::sh::zonal::clamped_cosine;

/// Texels of one dispatch.
const BAND: usize = 1 << 20;

/// What a chain keeps of a level: vectors of a texel, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Averages {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Vectors of a texel.
    pub vectors: usize,
    /// All of them.
    pub values: Vec<[f32; 4]>,
}

/// A texel under a light, as a rival keeps it.
#[derive(Clone, Debug)]
pub struct RivalRow {
    /// At most 7 vectors, as [`Averages`] has them.
    pub kept: Vec<[f32; 4]>,
    /// The material.
    pub brdf: Brdf,
    /// Light and view.
    pub directions: Directions,
}

impl Averages {
    /// The vectors of a texel within.
    #[must_use]
    pub fn texel(&self, x: usize, y: usize) -> &[[f32; 4]] {
        &self.values[(y * self.size[0] + x) * self.vectors..][..self.vectors]
    }
}

impl Bench<'_> {
    /// What a rival keeps of the levels of a map, finest first, without the map itself. [`Method::Geometric`] has the
    /// squared change of the normal to the next texels as its fourth component, as derivatives in a shader would.
    ///
    /// # Errors
    /// [`NormalsError::Method`] for lobes, [`NormalsError::Gpu`].
    pub fn averages(&self, map: &NormalMap, method: Method) -> Result<Vec<Averages>, NormalsError> {
        let (spirv, vectors) = kernels::average(method)?;
        let pipeline = self.kernel("normals average", &spirv, size_of::<AverageConstants>())?;
        let normals: Vec<[f32; 4]> =
            map.normals().iter().map(|n| n.extend(1.0).as_vec4().to_array()).collect();
        let mut fine = self.upload("normals", &normals)?;
        let mut levels = Vec::new();
        for level in 1..map.levels() {
            let size = map.size(level);
            let texels = size[0] * size[1];
            let output = self.scratch("averages", texels * vectors * size_of::<[f32; 4]>())?;
            for first in (0..texels).step_by(BAND) {
                let constants = AverageConstants {
                    fine_size: map.size(level - 1).map(|size| size as u32),
                    size: size.map(|size| size as u32),
                    first: first as u32,
                    single: u32::from(level == 1),
                };
                let count = (texels - first).min(BAND);
                self.step(&pipeline, [&fine, &output], &constants, count)?;
            }
            let mut averages = Averages { size, vectors, values: self.read(&output)? };
            if method == Method::Geometric {
                note_changes(&mut averages);
            }
            levels.push(averages);
            fine = output;
        }
        Ok(levels)
    }

    /// The radiance of each row by a rival's functions.
    ///
    /// # Errors
    /// [`NormalsError::Method`] for lobes, [`NormalsError::Range`] for a material out of range, [`NormalsError::Gpu`].
    pub fn rival(&self, method: Method, rows: &[RivalRow]) -> Result<Vec<f32>, NormalsError> {
        let pipeline = self.kernel("normals rivals", &kernels::rival(method)?, size_of::<u32>())?;
        let constants =
            rows.iter().map(|row| row.constants(method)).collect::<Result<Vec<_>, NormalsError>>()?;
        self.rows(&pipeline, &constants)
    }

    pub(crate) fn kernel(
        &self,
        name: &str,
        spirv: &[u32],
        constants: usize,
    ) -> Result<ComputePipeline, GpuError> {
        let push_constant_size = constants as u32;
        self.context.create_compute_pipeline(&ComputePipelineDesc {
            name,
            spirv,
            bindings: &BINDINGS,
            push_constant_size,
        })
    }

    fn step<C: bytemuck::Pod>(
        &self,
        pipeline: &ComputePipeline,
        buffers: [&airglow_gpu::Buffer; 2],
        constants: &C,
        count: usize,
    ) -> Result<(), NormalsError> {
        let access = airglow_graph::Access::ComputeStorageReadWrite;
        self.frame(&mut |recorder| {
            recorder.memory_barrier(access, access)?;
            dispatch(recorder, pipeline, buffers, constants, count)
        })
    }
}

impl RivalRow {
    fn constants(&self, method: Method) -> Result<RivalConstants, NormalsError> {
        self.brdf.check()?;
        let mut factors = [[0.0; 4]; 4];
        if let Method::Harmonics(order) = method {
            for (i, factor) in clamped_cosine(order)?.into_iter().enumerate() {
                factors[i / 4][i % 4] = factor as f32;
            }
            for (i, factor) in band_factors(order, self.brdf)?.into_iter().enumerate() {
                factors[2 + i / 4][i % 4] = factor as f32;
            }
        }
        let mut kept = [[0.0; 4]; MOST_VECTORS];
        kept.iter_mut().zip(&self.kept).for_each(|(place, value)| *place = *value);
        let [light, half_vector] = kernels::material(self.brdf, self.directions);
        Ok(RivalConstants { light, half_vector, factors, kept })
    }
}

/// The squared change of the normal to the texels right of and below each, as the fourth component.
fn note_changes(averages: &mut Averages) {
    let [width, height] = averages.size;
    let normals: Vec<glam::Vec3> = averages
        .values
        .iter()
        .map(|value| glam::Vec4::from_array(*value).truncate().try_normalize().unwrap_or(glam::Vec3::Z))
        .collect();
    let normal = |x: usize, y: usize| normals[y.min(height - 1) * width + x.min(width - 1)];
    for (at, value) in averages.values.iter_mut().enumerate() {
        let (x, y) = (at % width, at / width);
        let own = normal(x, y);
        value[3] = (normal(x + 1, y) - own).length_squared() + (normal(x, y + 1) - own).length_squared();
    }
}
