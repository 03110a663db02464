//! Counts of buffers, for rooms whose kernels do not count themselves: one kernel that looks at records.

use crate::context::Context;
use crate::error::GpuError;
use crate::health::Health;
use crate::memory::{Buffer, BufferSlice};
use crate::pipeline::{BindingDesc, BindingKind, ComputePipeline, ComputePipelineDesc, words};
use crate::recorder::{Binding, Recorder};
use crate::requirements::Requirements;
use crate::resources::{Imports, Record};
use airglow_graph::{Access, Buffer as GraphBuffer, Graph, Handle, PassKind};
use bytemuck::{Pod, Zeroable};

/// Invocations of a workgroup, and records that places in a buffer are counted in: 64 words are 256 bytes, the largest
/// alignment of an offset.
const GROUP: u64 = 64;
/// Workgroups of one dispatch: the least limit of any device.
const GROUPS: u64 = 65_535;

/// Bindings of `health/tally.comp`: the words, the counters.
pub const TALLY_BINDINGS: [BindingDesc; 2] =
    [BindingDesc::new(0, BindingKind::StorageBuffer), BindingDesc::new(1, BindingKind::StorageBuffer)];

/// What of a record counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counted {
    /// 1 for a record with a float that is infinite or NaN.
    NotFinite,
    /// 1 for a record with a float that is not above zero.
    NotPositive,
    /// The words themselves, which are counts.
    Sum,
}

/// The records of a buffer, in words of 4 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Records {
    /// How many there are, from the start of the buffer.
    pub count: u64,
    /// Words from one to the next.
    pub stride: u32,
    /// The first word of each that is looked at.
    pub first: u32,
    /// How many words are looked at.
    pub words: u32,
}

/// A buffer that is looked at for a counter.
#[derive(Clone, Debug)]
pub struct Look<B> {
    /// Index of the counter, in the order that [`Health`] was given names.
    pub counter: u32,
    /// What counts.
    pub counted: Counted,
    /// A storage buffer: a handle of the graph, or a slice.
    pub buffer: B,
    /// What it holds.
    pub records: Records,
}

/// Adds to the counters of a [`Health`] what it finds in buffers. Clones are the same one.
#[derive(Clone)]
pub struct Tally {
    pipeline: ComputePipeline,
    counters: Buffer,
}

/// Push constants of `health/tally.comp`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Constants {
    count: u32,
    stride: u32,
    first: u32,
    looked: u32,
    what: u32,
    counter: u32,
}

impl Records {
    /// Records without anything between them, each looked at whole.
    #[must_use]
    pub const fn whole(count: u64, words: u32) -> Self {
        Self { count, stride: words, first: 0, words }
    }
}

impl Tally {
    /// What a device must offer for it.
    #[must_use]
    pub fn requirements() -> Requirements {
        Requirements::engine().with_descriptors(&TALLY_BINDINGS)
    }

    /// Makes the kernel that adds to the counters of `health`.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`] when the device refuses.
    pub fn new(context: &Context, health: &Health) -> Result<Self, GpuError> {
        let bytes = include_bytes!("../../../shaders/spirv/health/tally.spv");
        let pipeline = context.create_compute_pipeline(&ComputePipelineDesc {
            name: "health tally",
            spirv: &words(bytes),
            bindings: &TALLY_BINDINGS,
            push_constant_size: size_of::<Constants>() as u32,
        })?;
        Ok(Self { pipeline, counters: health.buffer().clone() })
    }

    /// The counters, in use [`Access::ComputeStorageReadWrite`].
    #[must_use]
    pub fn counters(&self) -> &Buffer {
        &self.counters
    }

    /// Adds a pass `name` to a graph that looks at buffers of it.
    pub fn add(
        &self,
        graph: &mut Graph<Record>,
        imports: &mut Imports,
        name: &str,
        looks: Vec<Look<Handle<GraphBuffer>>>,
    ) {
        let access = Access::ComputeStorageReadWrite;
        let counters = graph.import_buffer(name, *self.counters.desc(), access, access);
        imports.buffer(&counters, &self.counters);
        let mut pass = graph.pass(name, PassKind::Compute);
        for look in &looks {
            pass.read(&look.buffer, Access::ComputeStorageRead);
        }
        pass.update(counters, access);
        let tally = self.clone();
        pass.record(Box::new(move |recorder, resources| {
            looks.iter().enumerate().try_for_each(|(index, look)| {
                let buffer: BufferSlice = resources.buffer(&look.buffer)?.into();
                tally.look(recorder, &look.with(buffer), index == 0)
            })
        }));
    }

    /// Records the same without a graph and without barriers: the buffers are readable by compute shaders
    /// ([`Access::ComputeStorageRead`]).
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for a buffer that holds fewer records, and for a counter that is not there.
    pub fn record(&self, recorder: &mut Recorder<'_>, looks: &[Look<BufferSlice>]) -> Result<(), GpuError> {
        looks.iter().enumerate().try_for_each(|(index, look)| self.look(recorder, look, index == 0))
    }

    /// Looks at one buffer, range by range.
    fn look(
        &self,
        recorder: &mut Recorder<'_>,
        look: &Look<BufferSlice>,
        mut is_first: bool,
    ) -> Result<(), GpuError> {
        let Records { count, stride, first, words } = look.records;
        let record_bytes = 4 * u64::from(stride);
        let fits = count.checked_mul(record_bytes).is_some_and(|bytes| bytes <= look.buffer.size());
        let within = first.checked_add(words).is_some_and(|end| end <= stride);
        let there = 4 * (u64::from(look.counter) + 1) <= self.counters.size();
        if !(fits && within && there) {
            let problem = format!("no {:?} for counter {} in its bytes", look.records, look.counter);
            return Err(GpuError::misuse(look.buffer.buffer().name(), problem));
        }
        let range = u64::from(recorder.context().limits().max_storage_buffer_range);
        let most = (range / (GROUP * record_bytes.max(1))).clamp(1, GROUPS) * GROUP;
        let mut done = 0;
        while done < count {
            let here = most.min(count - done);
            let counters = Access::ComputeStorageReadWrite;
            if !std::mem::take(&mut is_first) {
                recorder.memory_barrier(counters, counters)?;
            }
            let offset = look.buffer.offset() + done * record_bytes;
            let bound = [
                Binding::storage(0, look.buffer.buffer().slice(offset, here * record_bytes)?),
                Binding::storage(1, &self.counters),
            ];
            recorder.bind_compute(&self.pipeline, &bound)?;
            recorder.push_constants(&Constants {
                count: here as u32,
                stride,
                first,
                looked: words,
                what: look.counted as u32,
                counter: look.counter,
            })?;
            recorder.dispatch([here.div_ceil(GROUP) as u32, 1, 1])?;
            done += here;
        }
        Ok(())
    }
}

impl<B> Look<B> {
    /// The same look at another buffer.
    pub fn with<C>(&self, buffer: C) -> Look<C> {
        Look { counter: self.counter, counted: self.counted, buffer, records: self.records }
    }
}
