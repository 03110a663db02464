//! Evaluators of airlight beside the one that ships, all in one kernel and on the same rays: for `airglow report`.
//!
//! Uniform and equi-angular marching (Kulla and Fajardo 2012), the thesis's table of F(u, v) (Sun 2008, eq. 3.16), the
//! closed form by poles, and the pass's taps with other numbers of them. README.md says which ships, and why.

mod froxels;

use std::fmt;

use airglow_gpu::ash::vk::{BufferUsageFlags, Filter as Sampling, Format, ImageUsageFlags};
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Buffer, ComputePipelineDesc, GpuError, ImageView, Imports, Label,
    Location, Record, Sampler, SamplerDesc,
};
use airglow_graph::{Access, BufferDesc, Graph, ImageDesc, PassKind, State};
use bytemuck::{Pod, Zeroable};

use crate::FogError;
use crate::bench::Bench;
use crate::kernels::words;
use crate::reference::table::{Filter, Table};

pub use froxels::Froxels;

/// A way to the airlight of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evaluator {
    /// Reads the rays and writes a sum, as all others do.
    Nothing,
    /// A colour by distance, whatever the lights are.
    DepthFog,
    /// Equal steps along the ray.
    March {
        /// How many.
        steps: u32,
    },
    /// Equal angles at the light.
    Equiangular {
        /// How many.
        steps: u32,
    },
    /// The table of F(u, v).
    Table {
        /// Entries along a side.
        size: u32,
        /// How it is read.
        filter: Filter,
    },
    /// The two reads of such a table, bilinear, and nothing else.
    Entries {
        /// Entries along a side.
        size: u32,
    },
    /// The closed form; 4 or 7 poles.
    Poles {
        /// How many.
        count: u32,
    },
    /// The pass's rule; 1, 2, 4, 6, 8, 12 or 16 taps.
    Taps {
        /// How many.
        count: u32,
    },
}

/// One light seen from one ray: a row of `rival.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Row {
    /// Extinction of red, green and blue, above 0, 1/m.
    pub extinction: [f32; 3],
    /// Length of the ray, metres; above 1e30 without end.
    pub extent: f32,
    /// exp(-extinction times the light's distance).
    pub seen: [f32; 3],
    /// Distance along the ray of the light's foot, metres.
    pub along: f32,
    /// Distance of the light from the ray, metres, above 0.
    pub off: f32,
    /// What the integral is multiplied with: intensity, scattering, phase.
    pub weight: [f32; 3],
}

/// `Settings` of `rival.comp`: which rows a pixel takes, `(pixel + light stride) & mask`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Round {
    /// Pixels.
    pub pixels: u32,
    /// Lights of a pixel.
    pub lights: u32,
    /// From a light's row of a pixel to that of the next light.
    pub stride: u32,
    /// Of the row's number.
    pub mask: u32,
    /// Steps of a march.
    pub steps: u32,
    /// Lights of each row, the next a little farther off the ray than the last: times without the rows' reads.
    pub repeats: u32,
}

/// What evaluators run on.
#[derive(Clone)]
pub struct Track {
    /// [`Row`]s.
    pub rows: Buffer,
    /// A `vec4` a pixel: the airlight of all lights, 1/m times the weights.
    pub airlight: Buffer,
}

/// The thesis's table on the device.
#[derive(Clone)]
struct DeviceTable {
    view: ImageView,
    sampler: Sampler,
}

const OWNER: &str = "fog rivals";

/// The modules by channels: 1 and 3.
macro_rules! module {
    ($before:literal, $after:literal) => {
        [
            include_bytes!(concat!("../../../shaders/spirv/fog/", $before, ".CHANNELS1.", $after, ".spv"))
                .as_slice(),
            include_bytes!(concat!("../../../shaders/spirv/fog/", $before, ".CHANNELS3.", $after, ".spv"))
                .as_slice(),
        ]
    };
}

impl fmt::Display for Evaluator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => write!(f, "reads alone"),
            Self::DepthFog => write!(f, "depth fog"),
            Self::March { steps } => write!(f, "march {steps}"),
            Self::Equiangular { steps } => write!(f, "equi-angular {steps}"),
            Self::Table { size, filter: Filter::Nearest } => write!(f, "table {size} nearest"),
            Self::Table { size, filter: Filter::Bilinear } => write!(f, "table {size}"),
            Self::Entries { size } => write!(f, "two fetches of {size}"),
            Self::Poles { count } => write!(f, "poles {count}"),
            Self::Taps { count } => write!(f, "taps {count}"),
        }
    }
}

impl Evaluator {
    /// Its module for a grey medium and for one of three channels; little-endian words as bytes.
    ///
    /// # Errors
    /// [`FogError::Range`] for a number of poles or taps that no module has.
    pub fn spirv(&self) -> Result<[&'static [u8]; 2], FogError> {
        let none = |what: &str, count: u32, range| {
            Err(FogError::Range { field: what.to_owned(), value: f64::from(count), range })
        };
        Ok(match *self {
            Self::Nothing => module!("rival", "nothing"),
            Self::DepthFog => module!("rival", "depth_fog"),
            Self::March { .. } => module!("rival", "march"),
            Self::Equiangular { .. } => module!("rival", "equiangular"),
            Self::Table { .. } => module!("rival", "table"),
            Self::Entries { .. } => module!("rival", "entries"),
            Self::Poles { count: 4 } => module!("rival_poles", "POLES4"),
            Self::Poles { count: 7 } => module!("rival_poles", "POLES7"),
            Self::Poles { count } => return none("poles", count, "4 or 7"),
            Self::Taps { count: 1 } => module!("rival_taps", "TAPS1"),
            Self::Taps { count: 2 } => module!("rival_taps", "TAPS2"),
            Self::Taps { count: 4 } => module!("rival_taps", "TAPS4"),
            Self::Taps { count: 6 } => module!("rival_taps", "TAPS6"),
            Self::Taps { count: 8 } => module!("rival_taps", "TAPS8"),
            Self::Taps { count: 12 } => module!("rival_taps", "TAPS12"),
            Self::Taps { count: 16 } => module!("rival_taps", "TAPS16"),
            Self::Taps { count } => return none("taps", count, "1, 2, 4, 6, 8, 12 or 16"),
        })
    }

    /// Its bindings: rows, airlight; the table and its sampler.
    #[must_use]
    pub fn bindings(&self) -> Vec<BindingDesc> {
        let kinds = [BindingKind::StorageBuffer, BindingKind::StorageBuffer].into_iter().chain(
            self.table().map(|_| [BindingKind::SampledImage, BindingKind::Sampler]).into_iter().flatten(),
        );
        (0..).zip(kinds).map(|(binding, kind)| BindingDesc::new(binding, kind)).collect()
    }

    /// Bytes that it holds beside the rays.
    #[must_use]
    pub fn memory(&self) -> u64 {
        self.table().map_or(0, |(size, _)| 4 * u64::from(size) * u64::from(size))
    }

    /// Steps of a march, else 0.
    #[must_use]
    pub fn steps(&self) -> u32 {
        match *self {
            Self::March { steps } | Self::Equiangular { steps } => steps,
            _ => 0,
        }
    }

    fn table(&self) -> Option<(u32, Filter)> {
        match *self {
            Self::Table { size, filter } => Some((size, filter)),
            Self::Entries { size } => Some((size, Filter::Bilinear)),
            _ => None,
        }
    }
}

impl Bench<'_> {
    /// The rows, and a place for the airlight of `pixels` pixels.
    ///
    /// # Errors
    /// [`FogError::Gpu`].
    pub fn track(&self, rows: &[Row], pixels: u32) -> Result<Track, FogError> {
        let make = |name, size, usage, location| {
            let desc = BufferDesc { size, usage };
            self.context.create_buffer(Label::new(OWNER, name), &desc, location)
        };
        let (storage, from, to) = (
            BufferUsageFlags::STORAGE_BUFFER,
            BufferUsageFlags::TRANSFER_SRC,
            BufferUsageFlags::TRANSFER_DST,
        );
        let bytes = size_of_val(rows) as u64;
        let staging = make("rays, staged", bytes, from, Location::Upload)?;
        staging.write(0, rows)?;
        let rows = make("rays", bytes, storage | to, Location::Device)?;
        (self.run)(&mut |recorder| {
            recorder.copy_buffer(&staging, &rows)?;
            recorder.memory_barrier(Access::TransferDestination, Access::ComputeStorageRead)
        })?;
        Ok(Track {
            rows,
            airlight: make("airlight", 16 * u64::from(pixels), storage | from, Location::Device)?,
        })
    }

    /// Adds the pass of an evaluator to a graph. With `coloured` three channels of extinction, else the first alone.
    ///
    /// # Errors
    /// [`FogError`] for an evaluator that is none, and when the device refuses.
    pub fn add_rival(
        &self,
        graph: &mut Graph<Record>,
        imports: &mut Imports,
        track: &Track,
        (evaluator, coloured): (Evaluator, bool),
        round: Round,
    ) -> Result<(), FogError> {
        let round = Round { steps: evaluator.steps(), ..round };
        let pipeline = self.context.create_compute_pipeline(&ComputePipelineDesc {
            name: &evaluator.to_string(),
            spirv: &words(evaluator.spirv()?[usize::from(coloured)]),
            bindings: &evaluator.bindings(),
            push_constant_size: size_of::<Round>() as u32,
        })?;
        let table = evaluator.table().map(|(size, filter)| self.table(size, filter)).transpose()?;
        let (read, write) = (Access::ComputeStorageRead, Access::ComputeStorageWrite);
        let rows = graph.import_buffer("rays", *track.rows.desc(), read, read);
        let airlight = graph.import_buffer("airlight", *track.airlight.desc(), write, write);
        imports.buffer(&rows, &track.rows).buffer(&airlight, &track.airlight);
        let mut pass = graph.pass(&evaluator.to_string(), PassKind::Compute);
        pass.side_effect().read(&rows, read);
        let airlight = pass.write(airlight, write);
        pass.record(Box::new(move |recorder, resources| {
            let (rows, airlight) = (resources.buffer(&rows)?, resources.buffer(&airlight)?);
            let mut bindings = vec![Binding::storage(0, rows), Binding::storage(1, airlight)];
            if let Some(table) = &table {
                bindings.push(Binding::sampled(2, table.view.clone()));
                bindings.push(Binding::sampler(3, &table.sampler));
            }
            recorder.bind_compute(&pipeline, &bindings)?;
            recorder.push_constants(&round)?;
            recorder.dispatch([round.pixels.div_ceil(64), 1, 1])
        }));
        Ok(())
    }

    /// What the evaluator that ran last left: the first pixels' airlight.
    ///
    /// # Errors
    /// [`FogError::Gpu`].
    pub fn airlight_of(&self, track: &Track, pixels: u32) -> Result<Vec<[f32; 3]>, FogError> {
        let mut copy = None;
        (self.run)(&mut |recorder| {
            recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
            copy = Some(recorder.read_back_buffer(track.airlight.slice(0, 16 * u64::from(pixels))?)?);
            Ok(())
        })?;
        let copy = copy.ok_or_else(|| GpuError::misuse("the bench", "its host did not record the frame"))?;
        Ok(copy.read::<[f32; 4]>()?.into_iter().map(|[r, g, b, _]| [r, g, b]).collect())
    }

    fn table(&self, size: u32, filter: Filter) -> Result<DeviceTable, FogError> {
        let entries = Table::new(size as usize, 0)?;
        let desc = ImageDesc {
            usage: ImageUsageFlags::SAMPLED | ImageUsageFlags::TRANSFER_DST,
            ..ImageDesc::new_2d(size, size, Format::R32_SFLOAT)
        };
        let image = self.context.create_image(Label::new(OWNER, "table of F"), &desc)?;
        let bytes = BufferDesc { size: entries.bytes() as u64, usage: BufferUsageFlags::TRANSFER_SRC };
        let label = Label::new(OWNER, "table of F, staged");
        let staging = self.context.create_buffer(label, &bytes, Location::Upload)?;
        staging.write(0, entries.values())?;
        let view = image.full_view()?;
        (self.run)(&mut |recorder| {
            recorder.transition(&image, State::UNDEFINED, Access::TransferDestination)?;
            recorder.copy_buffer_to_image(&staging, &view)?;
            recorder.transition(&image, Access::TransferDestination, Access::ComputeSampled)
        })?;
        let filter = if filter == Filter::Nearest { Sampling::NEAREST } else { Sampling::LINEAR };
        let sampler =
            self.context.create_sampler(&SamplerDesc { filter, ..SamplerDesc::linear("table of F") })?;
        Ok(DeviceTable { view, sampler })
    }
}
