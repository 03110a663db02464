//! Surfaces in fog and the spread of distant pictures, by the functions that host's shaders call.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use airglow_gpu::ash::vk::BufferUsageFlags;
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Buffer, ComputePipeline, ComputePipelineDesc, GpuError, Label,
    Location,
};
use airglow_graph::{Access, BufferDesc};
use bytemuck::{Pod, Zeroable};

use super::Evaluated;
use crate::bench::Bench;
use crate::error::check;
use crate::lobes::{Lobe, LobeTables};
use crate::reference::{spread as reference, surface::lobe_glow};
use crate::{FogError, Preset, kernels};

/// A row of `fog-surface`.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceRow {
    /// Optical distance of the light, above 0.
    pub optical_distance: f64,
    /// Angle of the light from the lobe's axis, radians.
    pub theta: f64,
    /// Exponent of the lobe.
    pub exponent: f64,
    /// How fine a table.
    pub preset: Preset,
}

/// A row of `fog-psf`.
#[derive(Clone, Copy, Debug)]
pub struct SpreadRow {
    /// Optical distance of the light, above 0.
    pub optical_distance: f64,
    /// Angle from the light, radians, above 0.
    pub gamma: f64,
    /// By eq. 3.32 in place of eq. 3.30.
    pub factored: bool,
}

/// `Row` of `surface_rows.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct LobeConstants {
    optical: f32,
    chord: f32,
    exponent: f32,
    table: u32,
}

/// Bindings of `surface_rows.comp`: rows, tables, results.
pub const SURFACE_ROW_BINDINGS: [BindingDesc; 3] = [
    BindingDesc::new(0, BindingKind::StorageBuffer),
    BindingDesc::new(1, BindingKind::StorageBuffer),
    BindingDesc::new(2, BindingKind::StorageBuffer),
];

/// Exponents whose tables exist together.
const TABLES: usize = 64;

fn distance(value: f64) -> Result<(), FogError> {
    let sound = value > 0.0 && value <= 1e30;
    check(|| "t_sp or t_sv".to_owned(), value, sound, "an optical distance above 0")
}

impl SurfaceRow {
    /// Refuses what is out of range.
    ///
    /// # Errors
    /// [`FogError::Range`] with the column.
    pub fn check(&self) -> Result<(), FogError> {
        distance(self.optical_distance)?;
        let theta = self.theta;
        check(|| "theta".to_owned(), theta, (0.0..=PI).contains(&theta), "an angle from 0 to pi")?;
        Lobe::Phong(self.exponent).check()
    }

    fn constants(&self, tables: &LobeTables) -> Option<LobeConstants> {
        let (table, exponent) = tables.find(Lobe::Phong(self.exponent))?;
        let chord = (2.0 * (0.5 * self.theta).sin()) as f32;
        Some(LobeConstants { optical: self.optical_distance as f32, chord, exponent, table })
    }
}

impl SpreadRow {
    /// Refuses what is out of range.
    ///
    /// # Errors
    /// [`FogError::Range`] with the column.
    pub fn check(&self) -> Result<(), FogError> {
        distance(self.optical_distance)?;
        let (gamma, range) = (self.gamma, "an angle above 0, where it diverges, up to pi");
        check(|| "gamma".to_owned(), gamma, gamma > 0.0 && gamma <= PI, range)
    }

    fn reference(&self) -> Result<f64, FogError> {
        let f = if self.factored { reference::factored } else { reference::exact };
        Ok(f(self.optical_distance, self.gamma)?)
    }

    /// Optical distance, sine, versine, kind.
    fn constants(&self) -> [f32; 4] {
        let (sine, cosine) = (0.5 * self.gamma).sin_cos();
        let kind = if self.factored { 1.0 } else { 0.0 };
        [self.optical_distance, 2.0 * sine * cosine.max(0.0), 2.0 * sine * sine, kind]
            .map(|value| value as f32)
    }
}

/// G_n of the rows, out of tables built on the device; a refused row says why, the others still run.
///
/// # Errors
/// [`FogError::Gpu`] when the device refuses.
pub fn surface(bench: &Bench<'_>, rows: &[SurfaceRow]) -> Result<Vec<Result<Evaluated, FogError>>, FogError> {
    let truth = |row: &SurfaceRow| {
        row.check()?;
        Ok(lobe_glow(row.optical_distance, row.theta, row.exponent)?)
    };
    let references: Vec<Result<f64, FogError>> = rows.iter().map(truth).collect();
    let mut values = vec![f64::NAN; rows.len()];
    for preset in [Preset::Default, Preset::Reference] {
        let mut places: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (place, row) in rows.iter().enumerate() {
            if references[place].is_ok() && row.preset == preset {
                places.entry((row.exponent as f32).to_bits()).or_default().push(place);
            }
        }
        let groups: Vec<Vec<usize>> = places.into_values().collect();
        for group in groups.chunks(TABLES) {
            let places = group.concat();
            let rows: Vec<SurfaceRow> = places.iter().map(|&place| rows[place]).collect();
            for (place, value) in places.into_iter().zip(look_up(bench, preset, &rows)?) {
                values[place] = f64::from(value);
            }
        }
    }
    Ok(join(references, values))
}

/// The point spread function of the rows; a refused row says why, the others still run.
///
/// # Errors
/// [`FogError::Gpu`] when the device refuses.
pub fn spread(bench: &Bench<'_>, rows: &[SpreadRow]) -> Result<Vec<Result<Evaluated, FogError>>, FogError> {
    let truth = |row: &SpreadRow| row.check().and_then(|()| row.reference());
    let references: Vec<Result<f64, FogError>> = rows.iter().map(truth).collect();
    let accepted: Vec<[f32; 4]> = rows
        .iter()
        .zip(&references)
        .map(|(row, reference)| if reference.is_ok() { row.constants() } else { [1.0; 4] })
        .collect();
    if accepted.is_empty() {
        return Ok(Vec::new());
    }
    let pipeline = bench.pipeline("fog spread rows", &kernels::spread_rows(), &SURFACE_ROW_BINDINGS[..2])?;
    let input = bench.upload(&accepted)?;
    let values = bench.values(&pipeline, &[&input], [accepted.len(), 1], None)?;
    Ok(join(references, values.into_iter().map(f64::from).collect()))
}

fn join(references: Vec<Result<f64, FogError>>, values: Vec<f64>) -> Vec<Result<Evaluated, FogError>> {
    let pairs = references.into_iter().zip(values);
    pairs.map(|(reference, value)| Ok(Evaluated { value, reference: reference? })).collect()
}

fn look_up(bench: &Bench<'_>, preset: Preset, rows: &[SurfaceRow]) -> Result<Vec<f32>, FogError> {
    let lobes: Vec<Lobe> = rows.iter().map(|row| Lobe::Phong(row.exponent)).collect();
    let tables = LobeTables::new(bench.context, preset, &lobes)?;
    let constants: Vec<LobeConstants> = rows.iter().filter_map(|row| row.constants(&tables)).collect();
    let Some(buffer) = tables.buffer() else { return Ok(Vec::new()) };
    let pipeline =
        bench.pipeline("fog surface rows", &kernels::surface_rows(preset), &SURFACE_ROW_BINDINGS)?;
    let input = bench.upload(&constants)?;
    bench.values(&pipeline, &[&input, buffer], [constants.len(), 1], Some(&tables))
}

impl Bench<'_> {
    pub(super) fn pipeline(
        &self,
        name: &str,
        spirv: &[u32],
        bindings: &[BindingDesc],
    ) -> Result<ComputePipeline, GpuError> {
        self.context.create_compute_pipeline(&ComputePipelineDesc {
            name,
            spirv,
            bindings,
            push_constant_size: 4,
        })
    }

    pub(super) fn upload<T: Pod>(&self, rows: &[T]) -> Result<Buffer, GpuError> {
        let desc = BufferDesc { size: size_of_val(rows) as u64, usage: BufferUsageFlags::STORAGE_BUFFER };
        let buffer = self.context.create_buffer(Label::new("bench", "fog rows"), &desc, Location::Upload)?;
        buffer.write(0, rows)?;
        Ok(buffer)
    }

    /// Runs a kernel over rows of some f32 each, whose results follow `inputs` in its bindings; `tables` are filled before.
    pub(super) fn values(
        &self,
        pipeline: &ComputePipeline,
        inputs: &[&Buffer],
        [count, each]: [usize; 2],
        tables: Option<&LobeTables>,
    ) -> Result<Vec<f32>, FogError> {
        let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::TRANSFER_SRC;
        let desc = BufferDesc { size: 4 * (count * each) as u64, usage };
        let output =
            self.context.create_buffer(Label::new("bench", "fog results"), &desc, Location::Device)?;
        let mut copy = None;
        (self.run)(&mut |recorder| {
            if let Some(tables) = tables {
                tables.record(recorder)?;
                recorder.memory_barrier(Access::ComputeStorageWrite, Access::ComputeStorageRead)?;
            }
            let bound: Vec<Binding> = (0..)
                .zip(inputs.iter().copied().chain([&output]))
                .map(|(binding, buffer)| Binding::storage(binding, buffer))
                .collect();
            recorder.bind_compute(pipeline, &bound)?;
            recorder.push_constants(&(count as u32))?;
            recorder.dispatch([(count as u32).div_ceil(64), 1, 1])?;
            recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
            copy = Some(recorder.read_back_buffer(&output)?);
            Ok(())
        })?;
        let copy = copy.ok_or_else(|| GpuError::misuse("the bench", "its host did not record the frame"))?;
        Ok(copy.read::<f32>()?)
    }
}
