//! The lobes that a scene's materials reflect by in fog, and their tables, built on the device.
//!
//! A table holds G_n (Sun, thesis (2008), eq. 3.23) for one exponent and every optical distance; `surface.glsl` reads it.
//! Only the tables that the materials need are built.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use airglow_gpu::ash::vk::{AccessFlags2, BufferUsageFlags, PipelineStageFlags2};
use airglow_gpu::{
    Binding, Buffer, ComputePipeline, Context, GpuError, Imports, Label, Location, Record, Recorder,
};
use airglow_graph::{self as graph, Access, BufferDesc, Graph, Handle, LeftOut, PassKind, State};

use crate::envelope::{Part, Pipelines};
use crate::error::check;
use crate::reference::surface::exponent_of_ggx;
use crate::settings::Preset;
use crate::{FogError, kernels};

/// The largest exponent of a lobe with a table.
pub const MAX_EXPONENT: f64 = 1000.0;

/// How a surface reflects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lobe {
    /// Lambert's: the clamped cosine about the normal.
    Lambert,
    /// Phong's: a power of the cosine about the mirrored view, 1 to [`MAX_EXPONENT`].
    Phong(f64),
    /// Blinn's: a power of the cosine between the normal and the half vector, 0 to 4 [`MAX_EXPONENT`].
    Blinn(f64),
    /// GGX, by alpha: the square of glTF's roughness, 0 to 1.
    Ggx(f64),
}

impl Lobe {
    /// Refuses what is out of range.
    ///
    /// # Errors
    /// [`FogError::Range`].
    pub fn check(self) -> Result<(), FogError> {
        let number =
            |name: &str, value: f64, sound: bool, range| check(|| name.to_owned(), value, sound, range);
        match self {
            Self::Lambert => Ok(()),
            Self::Phong(n) => {
                number("exponent", n, (1.0..=MAX_EXPONENT).contains(&n), "an exponent from 1 to 1000")
            }
            Self::Blinn(n) => {
                number("exponent", n, (0.0..=4.0 * MAX_EXPONENT).contains(&n), "an exponent from 0 to 4000")
            }
            Self::Ggx(alpha) => {
                number("alpha", alpha, (0.0..=1.0).contains(&alpha), "a squared roughness, 0 to 1")
            }
        }
    }

    /// The exponent of the Phong lobe that its glow goes through: for Blinn's a quarter of its own, at least 1, for GGX that of
    /// [`exponent_of_ggx`], at most [`MAX_EXPONENT`].
    #[must_use]
    pub fn exponent(self) -> f64 {
        match self {
            Self::Lambert => 1.0,
            Self::Phong(exponent) => exponent,
            Self::Blinn(exponent) => (0.25 * exponent).max(1.0),
            Self::Ggx(alpha) => exponent_of_ggx(alpha).min(MAX_EXPONENT),
        }
    }
}

/// The tables of a scene's lobes. Clones are the same ones.
#[derive(Clone)]
pub struct LobeTables {
    preset: Preset,
    exponents: Vec<f32>,
    filled: Arc<AtomicBool>,
    device: Option<Device>,
}

/// What exists only where there is a table.
#[derive(Clone)]
struct Device {
    tables: Buffer,
    pipeline: ComputePipeline,
}

/// Any shader may read the tables between frames.
fn read_anywhere() -> State {
    let stage = PipelineStageFlags2::VERTEX_SHADER
        | PipelineStageFlags2::FRAGMENT_SHADER
        | PipelineStageFlags2::COMPUTE_SHADER;
    State { stage, access: AccessFlags2::SHADER_STORAGE_READ, ..State::UNDEFINED }
}

impl LobeTables {
    /// One table for each exponent among `lobes`, and nothing at all for none. They are filled by the first frame that
    /// [`add`](Self::add)s them, or by [`record`](Self::record).
    ///
    /// # Errors
    /// [`FogError::Range`], [`FogError::Gpu`] when the device refuses.
    pub fn new(context: &Context, preset: Preset, lobes: &[Lobe]) -> Result<Self, FogError> {
        Self::with(context, preset, lobes, || Ok(kernels::lobe_table(preset).compute_pipeline(context)?))
    }

    /// The same with pipelines that were made before, on whatever thread: none is made here or while recording.
    ///
    /// # Errors
    /// [`FogError::Envelope`] where the envelope has not got it; else as [`LobeTables::new`].
    pub fn with_pipelines(
        context: &Context,
        preset: Preset,
        lobes: &[Lobe],
        pipelines: &Pipelines,
    ) -> Result<Self, FogError> {
        let find = || {
            pipelines.envelope().check_part(Part::Lobes(preset))?;
            Ok(pipelines.compute(&kernels::lobe_table(preset))?)
        };
        Self::with(context, preset, lobes, find)
    }

    fn with(
        context: &Context,
        preset: Preset,
        lobes: &[Lobe],
        pipeline: impl Fn() -> Result<ComputePipeline, FogError>,
    ) -> Result<Self, FogError> {
        lobes.iter().try_for_each(|lobe| lobe.check())?;
        let mut exponents: Vec<f32> = lobes.iter().map(|lobe| lobe.exponent() as f32).collect();
        exponents.sort_by(f32::total_cmp);
        exponents.dedup();
        let device = match exponents.len() {
            0 => None,
            count => Some(Device::new(context, preset, count as u64, pipeline()?)?),
        };
        Ok(Self { preset, exponents, filled: Arc::new(AtomicBool::new(false)), device })
    }

    /// Entries along each side of a table, the `FOG_LOBE_SIZE` of `surface.glsl`.
    #[must_use]
    pub fn size(&self) -> u32 {
        size(self.preset)
    }

    /// The table and the exponent that `surface.glsl` is to be given for a lobe; `None` for one that was not among those
    /// of [`new`](Self::new).
    #[must_use]
    pub fn find(&self, lobe: Lobe) -> Option<(u32, f32)> {
        let exponent = lobe.exponent() as f32;
        let table = self.exponents.binary_search_by(|found| found.total_cmp(&exponent)).ok()?;
        Some((table as u32, exponent))
    }

    /// The tables, `size² f32` each, one after another by exponent; `None` where there is no lobe.
    #[must_use]
    pub fn buffer(&self) -> Option<&Buffer> {
        self.device.as_ref().map(|device| &device.tables)
    }

    /// Adds the tables to a graph, and the pass `fog lobe tables` that fills them in the first frame. What no material
    /// needs is on record as left out. To be read as storage by any shader.
    pub fn add(&self, graph: &mut Graph<Record>, imports: &mut Imports) -> Option<Handle<graph::Buffer>> {
        let table = 4 * u64::from(size(self.preset)).pow(2);
        let mut leave_out = |what: &str, why: &str, bytes, would_return: &str| {
            let (what, why, would_return) = (what.to_owned(), why.to_owned(), would_return.to_owned());
            graph.leave_out(LeftOut { what, why, bytes, time: None, would_return });
        };
        let Some(device) = &self.device else {
            leave_out(
                "fog lobe tables",
                "no material reflects light in fog",
                table,
                "a material with a lobe",
            );
            return None;
        };
        if self.exponents == [1.0] {
            let why = "no material has a specular lobe";
            leave_out("fog specular tables", why, table, "a material with one");
        }
        let filled = self.filled.load(Ordering::Acquire);
        if filled {
            let why = "the tables were filled before";
            leave_out("fog lobe tables, filling", why, 0, "other materials");
        }
        let state = read_anywhere();
        let mut tables = graph.import_buffer("fog lobe tables", *device.tables.desc(), state, state);
        imports.buffer(&tables, &device.tables);
        if !filled {
            let mut pass = graph.pass("fog lobe tables", PassKind::Compute);
            tables = pass.write(tables, Access::ComputeStorageWrite);
            let ours = self.clone();
            pass.record(Box::new(move |recorder, _| ours.record(recorder)));
        }
        Some(tables)
    }

    /// Fills the tables, once: a second recording does nothing. Without a graph the host makes a barrier from
    /// [`Access::ComputeStorageWrite`] to what reads them.
    ///
    /// # Errors
    /// [`GpuError`] where the recorder's memory is at its end.
    pub fn record(&self, recorder: &mut Recorder<'_>) -> Result<(), GpuError> {
        let Some(device) = &self.device else { return Ok(()) };
        if self.filled.load(Ordering::Acquire) {
            return Ok(());
        }
        let exponents = recorder.upload(&self.exponents)?;
        let bound = [Binding::storage(0, &exponents), Binding::storage(1, &device.tables)];
        recorder.bind_compute(&device.pipeline, &bound)?;
        let groups = size(self.preset).pow(2).div_ceil(64);
        recorder.dispatch([groups, self.exponents.len() as u32, 1])?;
        self.filled.store(true, Ordering::Release);
        Ok(())
    }
}

impl Device {
    fn new(
        context: &Context,
        preset: Preset,
        count: u64,
        pipeline: ComputePipeline,
    ) -> Result<Self, FogError> {
        let bytes = 4 * count * u64::from(size(preset)).pow(2);
        let desc = BufferDesc { size: bytes, usage: BufferUsageFlags::STORAGE_BUFFER };
        let label = Label::new("fog", "fog lobe tables");
        let tables = context.create_buffer(label, &desc, Location::Device)?;
        Ok(Self { tables, pipeline })
    }
}

/// Entries along each side of a table: 16 KiB or 256 KiB a table.
fn size(preset: Preset) -> u32 {
    match preset {
        Preset::Default => 64,
        Preset::Reference => 256,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lobes_out_of_range_are_refused_by_name() {
        for (lobe, name) in [
            (Lobe::Phong(0.5), "exponent"),
            (Lobe::Phong(f64::NAN), "exponent"),
            (Lobe::Blinn(5000.0), "exponent"),
            (Lobe::Ggx(-0.1), "alpha"),
        ] {
            let message = lobe.check().unwrap_err().to_string();
            assert!(message.contains(name), "{message}");
        }
        assert!(Lobe::Ggx(0.0).check().is_ok() && Lobe::Blinn(0.0).exponent() == 1.0);
    }
}
