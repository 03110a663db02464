//! Binds and dispatches: what each stage records, and the road without a graph.

use std::collections::BTreeMap;

use airglow_gpu::{Binding, BufferSlice, ColorAttachment, GpuError, ImageView, Load, Recorder, Rendering};
use airglow_graph::Access;

use crate::kernels::WORKGROUP;
use crate::pack::RECTANGLE_WIDTH;
use crate::rotation::RotateConstants;
use crate::shown::Shown;
use crate::stage::{Bound, ChunkWork, Need, Prepared, Resource, Stage, Use, Work};

/// The resources of a frame: the host's, and the scratch a host without a graph makes.
#[derive(Clone, Default)]
pub struct Bindings {
    /// Buffers, from their first byte on.
    pub buffers: BTreeMap<Resource, BufferSlice>,
    /// Images, as views of their first mip.
    pub images: BTreeMap<Resource, ImageView>,
}

impl Bindings {
    pub(crate) fn buffer(&self, resource: Resource) -> Result<&BufferSlice, GpuError> {
        self.buffers.get(&resource).ok_or_else(|| missing(resource))
    }
}

/// Where a stage finds its resources; nothing is copied to look one up.
#[derive(Clone, Copy)]
struct Found<'a> {
    given: &'a Bindings,
    /// Those of a frame recorded without a graph, sorted; where they are this room's own they come first.
    needs: &'a [(Resource, Need)],
}

impl Found<'_> {
    fn buffer(&self, resource: Resource) -> Result<BufferSlice, GpuError> {
        let need = self.needs.binary_search_by_key(&resource, |(name, _)| *name);
        if let Ok(Some((_, Need::Ours { buffer, .. }))) = need.map(|place| self.needs.get(place)) {
            return Ok(buffer.into());
        }
        self.given.buffer(resource).cloned()
    }

    fn image(&self, resource: Resource) -> Result<&ImageView, GpuError> {
        self.given.images.get(&resource).ok_or_else(|| missing(resource))
    }

    /// `size` bytes from `offset` of a resource.
    fn slice(&self, resource: Resource, offset: u64, size: u64) -> Result<BufferSlice, GpuError> {
        let whole = self.buffer(resource)?;
        if offset.checked_add(size).is_none_or(|end| end > whole.size()) {
            let problem = format!("{size} bytes from byte {offset} are needed, it has {}", whole.size());
            return Err(GpuError::misuse(resource.to_string(), problem));
        }
        whole.buffer().slice(whole.offset() + offset, size)
    }
}

fn missing(resource: Resource) -> GpuError {
    GpuError::misuse(resource.to_string(), "not bound: add it to the bindings")
}

impl Prepared {
    /// What the frame uses, for the barriers of a host's own frame graph: each resource with the accesses of all
    /// stages, in order.
    #[must_use]
    pub fn accesses(&self) -> Vec<(Resource, Vec<Access>)> {
        let mut accesses: BTreeMap<Resource, Vec<Access>> = BTreeMap::new();
        for used in self.stages.iter().flat_map(|stage| &stage.uses) {
            accesses.entry(used.resource).or_default().push(used.access);
        }
        accesses.into_iter().collect()
    }

    /// Records all stages with barriers between them and none around them: before, the host makes its inputs
    /// visible to the first access of [`accesses`](Self::accesses) and brings images into its layout; afterwards it
    /// waits for the last. The packed rectangle is the exception: its layouts are changed here, from undefined.
    /// Recorded again, it allocates nothing on the heap.
    ///
    /// Command-buffer state changed: as [`Recorder`] says.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for a resource that is not bound or too small.
    pub fn record(&self, recorder: &mut Recorder<'_>, bindings: &Bindings) -> Result<(), GpuError> {
        let found = Found { given: bindings, needs: &self.needs };
        for stage in &self.stages {
            for (used, before) in stage.uses.iter().zip(&stage.before) {
                synchronise(recorder, found, *used, *before)?;
            }
            recorder.labelled(stage.name, |recorder| stage.record_once(recorder, found))?;
        }
        Ok(())
    }
}

/// The barrier between two uses of a resource within the frame.
fn synchronise(
    recorder: &mut Recorder<'_>,
    found: Found<'_>,
    used: Use,
    before: Option<Access>,
) -> Result<(), GpuError> {
    if used.resource == Resource::Rectangle {
        let image = found.image(Resource::Rectangle)?.image();
        return match before {
            Some(before) => recorder.transition(image, before, used.access),
            None => recorder.transition(image, airglow_graph::State::UNDEFINED, used.access),
        };
    }
    match before {
        Some(before) if before.writes() || used.access.writes() => {
            recorder.memory_barrier(before, used.access)
        }
        _ => Ok(()),
    }
}

impl Stage {
    /// Records this stage alone, without barriers.
    ///
    /// # Errors
    /// As [`Prepared::record`].
    pub fn record(&self, recorder: &mut Recorder<'_>, bindings: &Bindings) -> Result<(), GpuError> {
        self.record_once(recorder, Found { given: bindings, needs: &[] })
    }

    fn record_once(&self, recorder: &mut Recorder<'_>, found: Found<'_>) -> Result<(), GpuError> {
        if self.shown.as_ref().is_some_and(|shown| !self.work.is_asked_for(shown)) {
            return Ok(());
        }
        let Some(once) = &self.once else { return self.record_work(recorder, found) };
        if once.projected.holds(once.revision) {
            return Ok(());
        }
        self.record_work(recorder, found)?;
        if once.last {
            once.projected.set(once.revision);
        }
        Ok(())
    }

    fn record_work(&self, recorder: &mut Recorder<'_>, found: Found<'_>) -> Result<(), GpuError> {
        match &self.work {
            Work::Uploads(uploads) => uploads.iter().try_for_each(|upload| upload.record(recorder)),
            Work::Rows { pipeline, size, counted } => {
                let [environment, columns, sums] = [
                    Binding::sampled(0, found.image(Resource::Environment)?.clone()),
                    Binding::storage(1, found.buffer(Resource::ColumnTable)?),
                    Binding::storage(2, found.buffer(Resource::RowSums)?),
                ];
                if *counted {
                    let counters = Binding::storage(3, found.buffer(Resource::Health)?);
                    recorder.bind_compute(pipeline, &[environment, columns, sums, counters])?;
                } else {
                    recorder.bind_compute(pipeline, &[environment, columns, sums])?;
                }
                recorder.push_constants(size)?;
                recorder.dispatch([size.second, 1, 1])
            }
            Work::Bands { pipeline, size, coefficients } => {
                let bound = [
                    Binding::storage(0, found.buffer(Resource::RowTable)?),
                    Binding::storage(1, found.buffer(Resource::RowSums)?),
                    Binding::storage(2, found.buffer(Resource::MapCoefficients)?),
                ];
                recorder.bind_compute(pipeline, &bound)?;
                recorder.push_constants(size)?;
                recorder.dispatch([*coefficients, 1, 1])
            }
            Work::Rotate { pipeline, source, target, rotations, strides } => {
                let (turns, count, constants) = rotations.with(|turns, frame| {
                    let constants = RotateConstants::new(*strides, frame.factor, &frame.filter);
                    Ok::<_, GpuError>((recorder.upload(turns)?, turns.len(), constants))
                })?;
                let bound = [
                    Binding::storage(0, found.buffer(*source)?),
                    Binding::storage(1, &turns),
                    Binding::storage(2, found.buffer(*target)?),
                ];
                recorder.bind_compute(pipeline, &bound)?;
                recorder.push_constants(&constants)?;
                recorder.dispatch([count as u32, 1, 1])
            }
            Work::Matrices { pipeline, elements, instances, strides } => {
                let bound = [
                    Binding::storage(0, found.buffer(Resource::Tensor)?),
                    Binding::storage(1, found.buffer(Resource::Lights)?),
                    Binding::storage(2, found.buffer(Resource::Matrices)?),
                ];
                recorder.bind_compute(pipeline, &bound)?;
                recorder.push_constants(strides)?;
                recorder.dispatch([elements.div_ceil(WORKGROUP), *instances, 1])
            }
            Work::Vertices(chunks, shown) => shown_chunks(chunks, shown).try_for_each(|chunk| {
                with_bindings(&chunk.bound, found, |bound| recorder.bind_compute(&chunk.pipeline, bound))?;
                recorder.push_constants(&chunk.constants)?;
                recorder.dispatch([chunk.groups, 1, 1])
            }),
            Work::Rectangle(chunks, shown) => draw_rectangle(recorder, chunks, shown, found),
            Work::Copy { size } => {
                let results = found.slice(Resource::Results, 0, *size)?;
                recorder.copy_image_to_buffer(found.image(Resource::Rectangle)?, results)
            }
        }
    }
}

impl Work {
    /// Whether there is anything to do in a frame.
    fn is_asked_for(&self, shown: &Shown) -> bool {
        match self {
            Self::Matrices { .. } => shown.is_lit() && shown.takes_matrices(),
            _ => shown.is_lit(),
        }
    }
}

/// Those of the instances that are shown, with the kernel for their visibility.
fn shown_chunks<'a, P>(
    chunks: &'a [ChunkWork<P>],
    shown: &'a Shown,
) -> impl Iterator<Item = &'a ChunkWork<P>> {
    chunks.iter().filter(|chunk| shown.takes(chunk.instance, chunk.shadowed))
}

/// Hands what a chunk binds to `bind`, on the stack: no kernel over vertices binds more than five.
fn with_bindings(
    bound: &[Bound],
    found: Found<'_>,
    bind: impl FnOnce(&[Binding]) -> Result<(), GpuError>,
) -> Result<(), GpuError> {
    let one = |bound: &Bound| {
        let slice = found.slice(bound.resource, bound.offset, bound.size)?;
        Ok::<_, GpuError>(match bound.uniform {
            true => Binding::uniform(bound.binding, slice),
            false => Binding::storage(bound.binding, slice),
        })
    };
    match bound {
        [a, b] => bind(&[one(a)?, one(b)?]),
        [a, b, c] => bind(&[one(a)?, one(b)?, one(c)?]),
        [a, b, c, d] => bind(&[one(a)?, one(b)?, one(c)?, one(d)?]),
        [a, b, c, d, e] => bind(&[one(a)?, one(b)?, one(c)?, one(d)?, one(e)?]),
        _ => Err(GpuError::misuse("relight", format!("a kernel with {} bindings", bound.len()))),
    }
}

/// Each chunk fills the rows of the rectangle that are its own.
fn draw_rectangle(
    recorder: &mut Recorder<'_>,
    chunks: &[ChunkWork<airglow_gpu::GraphicsPipeline>],
    shown: &Shown,
    found: Found<'_>,
) -> Result<(), GpuError> {
    let view = found.image(Resource::Rectangle)?;
    let colors = [ColorAttachment { view, load: Load::Discard }];
    recorder.begin_rendering(&Rendering { colors: &colors, depth: None })?;
    for chunk in shown_chunks(chunks, shown) {
        with_bindings(&chunk.bound, found, |bound| recorder.bind_graphics(&chunk.pipeline, bound))?;
        recorder.push_constants(&chunk.constants)?;
        let rows = chunk.constants.vertex_count.div_ceil(RECTANGLE_WIDTH);
        recorder.set_scissor([0, chunk.constants.first_row], [RECTANGLE_WIDTH, rows])?;
        recorder.draw(0..3, 0..1)?;
    }
    recorder.end_rendering()
}
