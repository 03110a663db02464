//! Meshes: their baked vectors on the device, added, replaced and dropped between frames without waiting.

use airglow_gpu::Context;

use crate::RelightError;
use crate::pack::{Chunk, HALF_LIMIT, Layout, VERTEX_ALIGNMENT, chunks};
use crate::resident::Resident;
use crate::settings::{Settings, Storage};
use crate::tables::count_wrong;

/// A mesh of a [`Relight`](crate::Relight). Replacing a mesh gives a new id; the old one is refused from then on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MeshId {
    pub(crate) index: u32,
    generation: u32,
}

/// A mesh: chunks of vertices, and the vectors baked for them.
pub(crate) struct Mesh {
    pub vertices: u32,
    pub chunks: Vec<Chunk>,
    /// The packed chunks one after another; none for a mesh without a bake.
    pub vectors: Option<Resident>,
}

impl Mesh {
    /// Checks and packs `vectors`, vertex-major, `order^2` values a vertex.
    pub(crate) fn new(
        context: &Context,
        settings: &Settings,
        chunk_vertices: u32,
        name: &str,
        vertices: u32,
        vectors: Option<&[f32]>,
    ) -> Result<Self, RelightError> {
        if vertices == 0 {
            let (name, allowed) = (name.to_owned(), "at least one vertex".to_owned());
            return Err(RelightError::Size { name, what: "a vertex count", actual: 0, allowed });
        }
        let chunks = chunks(vertices, chunk_vertices);
        let vectors = match vectors {
            Some(values) => {
                check(settings, name, vertices, values)?;
                check_budget(context, settings, name, vertices)?;
                Some(Resident::new(context, name, &pack(settings, &chunks, values))?)
            }
            None => None,
        };
        Ok(Self { vertices, chunks, vectors })
    }

    /// Whether vectors were baked for it.
    pub(crate) fn has_vectors(&self) -> bool {
        self.vectors.is_some()
    }

    /// Byte offset of a chunk's packed vectors and their size.
    pub(crate) fn vector_range(&self, settings: &Settings, chunk: &Chunk) -> (u64, u64) {
        let stride = u64::from(stride(chunk));
        (u64::from(chunk.first) * settings.vector_bytes(), stride * settings.vector_bytes())
    }
}

/// Vertices that the planes of a chunk are apart: its count, rounded up so that the next chunk is aligned.
pub(crate) fn stride(chunk: &Chunk) -> u32 {
    chunk.count.next_multiple_of(VERTEX_ALIGNMENT)
}

fn pack(settings: &Settings, chunks: &[Chunk], values: &[f32]) -> Vec<u32> {
    let count = settings.coefficients();
    let mut words = Vec::new();
    for chunk in chunks {
        let range = chunk.first as usize * count..(chunk.first + chunk.count) as usize * count;
        let stride = stride(chunk) as usize;
        words.extend(Layout::DEFAULT.pack(settings.order, settings.storage, stride, &values[range]));
    }
    words
}

/// Refuses a mesh that the budget has no room for, and says which settings have.
fn check_budget(
    context: &Context,
    settings: &Settings,
    name: &str,
    vertices: u32,
) -> Result<(), RelightError> {
    let size = settings.mesh_bytes(vertices);
    match context.memory_left() {
        Some(left) if size > left => {
            let mend = match settings.next_that_fits(vertices, left) {
                Some(next) => format!("order {} with {:?} would fit", next.order, next.storage),
                None => "no setting fits; raise the budget or drop meshes".to_owned(),
            };
            Err(RelightError::Budget { name: name.to_owned(), size, left, mend })
        }
        _ => Ok(()),
    }
}

fn check(settings: &Settings, name: &str, vertices: u32, values: &[f32]) -> Result<(), RelightError> {
    let expected = vertices as usize * settings.coefficients();
    if values.len() != expected {
        let (name, actual) = (name.to_owned(), values.len());
        return Err(RelightError::Length { name, what: "the vectors", expected, actual });
    }
    let refuse = |problem, (count, first)| {
        Err(RelightError::Values { name: name.to_owned(), what: "vector values", problem, count, first })
    };
    if let Some(found) = count_wrong(values, |value| !value.is_finite()) {
        return refuse("NaN or infinite", found);
    }
    let past_half = |value: f32| settings.storage == Storage::F16 && value.abs() > HALF_LIMIT;
    if let Some(found) = count_wrong(values, past_half) {
        return refuse("past 63.96, the range of vectors in half floats", found);
    }
    Ok(())
}

/// The meshes by id.
#[derive(Default)]
pub(crate) struct Meshes {
    slots: Vec<Slot>,
}

#[derive(Default)]
struct Slot {
    generation: u32,
    mesh: Option<Mesh>,
}

impl Meshes {
    pub(crate) fn add(&mut self, mesh: Mesh) -> MeshId {
        let free = self.slots.iter().position(|slot| slot.mesh.is_none());
        let index = free.unwrap_or_else(|| {
            self.slots.push(Slot::default());
            self.slots.len() - 1
        });
        let slot = &mut self.slots[index];
        slot.generation += 1;
        slot.mesh = Some(mesh);
        MeshId { index: index as u32, generation: slot.generation }
    }

    pub(crate) fn get(&self, id: MeshId) -> Result<&Mesh, RelightError> {
        let slot = self.slots.get(id.index as usize).filter(|slot| slot.generation == id.generation);
        slot.and_then(|slot| slot.mesh.as_ref()).ok_or(RelightError::UnknownMesh { index: id.index })
    }

    /// Lets go of a mesh; its memory goes back when no frame can use it any more.
    pub(crate) fn remove(&mut self, id: MeshId) -> Result<(), RelightError> {
        self.get(id)?;
        self.slots[id.index as usize].mesh = None;
        Ok(())
    }
}
