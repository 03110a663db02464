//! How the baked vectors of a chunk of vertices lie on the device, and how many vertices a chunk has.

use airglow_gpu::ash::vk;
use half::f16;

use crate::settings::{LightKind, Settings, Storage};

/// Vertices that chunks and instances are aligned to: every offset of a binding is then a multiple of 256 bytes,
/// the largest alignment a device may ask for.
pub const VERTEX_ALIGNMENT: u32 = 64;

/// Pixels in a row of the packed rectangle of the fragment method; a multiple of [`VERTEX_ALIGNMENT`], and the
/// constant of the same name in `colour.frag`.
pub const RECTANGLE_WIDTH: u32 = 1024;

/// What vectors are multiplied with before they become half floats, whose steps below 6e-5 no longer shrink with the value: a
/// vertex that sees next to nothing then errs no more than others. Divided out by `TRANSFER_UNIT` of `transfer.glsl`.
const HALF_SCALE: f32 = 1024.0;

/// The largest value of a vector in half floats, all but 64.
pub(crate) const HALF_LIMIT: f32 = 65504.0 / HALF_SCALE;

/// Format of the packed rectangle: what the vertex buffer holds.
pub(crate) const RECTANGLE_FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// How the words of a chunk follow one another; README.md has the measurement. A word is one f32 or two f16.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Layout {
    /// One word of every vertex after another: no padding, and neighbouring invocations read neighbouring words.
    Planes,
    /// One vertex after another, no padding.
    Vertices,
    /// One vertex after another, in blocks of four coefficients padded with zeros.
    VertexBlocks,
    /// One block of four coefficients of every vertex after another, padded with zeros.
    BlockPlanes,
}

impl Layout {
    /// Every layout.
    pub const ALL: [Self; 4] = [Self::Planes, Self::Vertices, Self::VertexBlocks, Self::BlockPlanes];

    /// The layout the pass uses, chosen by measurement. The others are kept as its rivals.
    pub const DEFAULT: Self = Self::BlockPlanes;

    /// Coefficients that lie together: one word, or a block of four.
    fn group(self, storage: Storage) -> usize {
        match (self, storage) {
            (Self::VertexBlocks | Self::BlockPlanes, _) => 4,
            (_, Storage::F32) => 1,
            (_, Storage::F16) => 2,
        }
    }

    /// 32-bit words of one vertex, padding included.
    #[must_use]
    pub fn words(self, order: usize, storage: Storage) -> usize {
        let values = (order * order).next_multiple_of(self.group(storage));
        match storage {
            Storage::F32 => values,
            Storage::F16 => values / 2,
        }
    }

    /// Lays out the vectors of a chunk, vertex-major as baked, for `stride >= vertices` vertices. What is past
    /// the last vertex or coefficient is zero.
    #[must_use]
    pub fn pack(self, order: usize, storage: Storage, stride: usize, vectors: &[f32]) -> Vec<u32> {
        let (count, group) = (order * order, self.group(storage));
        let words = self.words(order, storage);
        let group_words = match storage {
            Storage::F32 => group,
            Storage::F16 => group / 2,
        };
        let mut packed = vec![0; words * stride];
        for (vertex, vector) in vectors.chunks_exact(count).enumerate() {
            for (block, values) in vector.chunks(group).enumerate() {
                let first = match self {
                    Self::Planes | Self::BlockPlanes => (block * stride + vertex) * group_words,
                    Self::Vertices | Self::VertexBlocks => vertex * words + block * group_words,
                };
                for (i, value) in values.iter().enumerate() {
                    match storage {
                        Storage::F32 => packed[first + i] = value.to_bits(),
                        Storage::F16 => {
                            packed[first + i / 2] |=
                                u32::from(f16::from_f32(HALF_SCALE * value).to_bits()) << (16 * (i % 2));
                        }
                    }
                }
            }
        }
        packed
    }
}

impl Settings {
    /// Bytes of a vertex's baked vector on the device.
    #[must_use]
    pub fn vector_bytes(&self) -> u64 {
        4 * Layout::DEFAULT.words(self.order, self.storage) as u64
    }

    /// Bytes that the baked vectors of a mesh take until its first frame is recorded: on the device, and once more while
    /// they are copied there.
    #[must_use]
    pub fn mesh_bytes(&self, vertices: u32) -> u64 {
        2 * u64::from(vertices).next_multiple_of(u64::from(VERTEX_ALIGNMENT)) * self.vector_bytes()
    }

    /// The settings nearest below these whose vectors for a mesh fit `bytes`: half floats before a lower order, which
    /// costs more error. A vector of a lower order is the beginning of one of a higher. None when not even order 1
    /// fits.
    #[must_use]
    pub fn next_that_fits(&self, vertices: u32, bytes: u64) -> Option<Self> {
        let below = (1..=self.order)
            .flat_map(|order| [Storage::F16, Storage::F32].map(|storage| Self { order, storage, ..*self }));
        below
            .filter(|settings| settings.mesh_bytes(vertices) <= bytes)
            .max_by_key(|settings| (settings.order, settings.vector_bytes()))
    }
}

/// A range of a mesh's vertices whose every binding fits the device's storage-buffer range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chunk {
    /// First vertex, a multiple of [`VERTEX_ALIGNMENT`].
    pub first: u32,
    /// Number of vertices.
    pub count: u32,
}

/// What bounds the size of a chunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChunkLimits {
    /// Bytes of one storage-buffer binding (`maxStorageBufferRange`; 128 MiB is the least a device offers).
    pub storage_range: u64,
    /// Workgroups of one dispatch (`maxComputeWorkGroupCount[0]`).
    pub workgroups: u32,
}

/// Most vertices of a chunk: a multiple of `alignment`, or `None` when not even that many fit the limits.
#[must_use]
pub fn chunk_vertices(settings: &Settings, limits: &ChunkLimits, alignment: u32) -> Option<u32> {
    let coefficients = settings.coefficients() as u64;
    let light = if settings.light == LightKind::Vertex { 12 * coefficients } else { 0 };
    let visibility = if settings.visibility { 4 * coefficients } else { 0 };
    let bytes = settings.vector_bytes().max(settings.output_bytes()).max(light).max(visibility);
    let by_range = limits.storage_range / bytes;
    let by_dispatch = u64::from(limits.workgroups) * u64::from(crate::kernels::WORKGROUP);
    let most = u32::try_from(by_range.min(by_dispatch)).unwrap_or(u32::MAX) / alignment * alignment;
    (most > 0).then_some(most)
}

/// The chunks of a mesh.
#[must_use]
pub fn chunks(vertices: u32, most: u32) -> Vec<Chunk> {
    let firsts = (0..vertices).step_by(most.max(1) as usize);
    firsts.map(|first| Chunk { first, count: most.min(vertices - first) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The index of a coefficient in the packed words, written out as the shader has it.
    fn shader_value(
        layout: Layout,
        storage: Storage,
        packed: &[u32],
        stride: usize,
        vertex: usize,
        i: usize,
    ) -> f32 {
        let words = layout.words(3, storage);
        let word = match (layout, storage) {
            (Layout::Planes, Storage::F32) => i * stride + vertex,
            (Layout::Planes, Storage::F16) => i / 2 * stride + vertex,
            (Layout::Vertices | Layout::VertexBlocks, Storage::F32) => vertex * words + i,
            (Layout::Vertices | Layout::VertexBlocks, Storage::F16) => vertex * words + i / 2,
            (Layout::BlockPlanes, Storage::F32) => 4 * (i / 4 * stride + vertex) + i % 4,
            (Layout::BlockPlanes, Storage::F16) => 2 * (i / 4 * stride + vertex) + i % 4 / 2,
        };
        match storage {
            Storage::F32 => f32::from_bits(packed[word]),
            Storage::F16 => f16::from_bits((packed[word] >> (16 * (i % 2))) as u16).to_f32() / HALF_SCALE,
        }
    }

    #[test]
    fn every_layout_holds_every_coefficient() {
        let vectors: Vec<f32> = (0..5 * 9).map(|i| i as f32).collect();
        for layout in Layout::ALL {
            for storage in [Storage::F32, Storage::F16] {
                let packed = layout.pack(3, storage, 8, &vectors);
                assert_eq!(packed.len(), 8 * layout.words(3, storage));
                for (at, expected) in vectors.iter().enumerate() {
                    let actual = shader_value(layout, storage, &packed, 8, at / 9, at % 9);
                    assert_eq!(
                        actual,
                        *expected,
                        "{layout:?} {storage:?} vertex {} index {}",
                        at / 9,
                        at % 9
                    );
                }
            }
        }
    }

    #[test]
    fn chunks_cover_the_mesh_within_the_limits() {
        let settings = Settings { order: 6, light: LightKind::Vertex, ..Settings::default() };
        let limits = ChunkLimits { storage_range: 128 << 20, workgroups: 65_535 };
        let most = chunk_vertices(&settings, &limits, VERTEX_ALIGNMENT).unwrap();
        assert_eq!(most, 310_656, "432 bytes of light a vertex");
        let chunks = chunks(2_000_000, most);
        assert_eq!(chunks.iter().map(|chunk| chunk.count).sum::<u32>(), 2_000_000);
        for pair in chunks.windows(2) {
            assert_eq!(pair[0].first + pair[0].count, pair[1].first);
            assert_eq!(pair[1].first % VERTEX_ALIGNMENT, 0);
        }
        let tiny = ChunkLimits { storage_range: 1 << 10, ..limits };
        assert_eq!(chunk_vertices(&settings, &tiny, VERTEX_ALIGNMENT), None);
    }

    #[test]
    fn the_nearest_settings_below_that_fit_are_next() {
        let settings = Settings::default();
        // 100 vertices take the place of 128: order 4 holds 16 values of 4 bytes a vertex, twice.
        assert_eq!(settings.mesh_bytes(100), 2 * 128 * 64);
        let next = |bytes| settings.next_that_fits(100, bytes).map(|next| (next.order, next.storage));
        assert_eq!(next(2 * 128 * 64), Some((4, Storage::F32)));
        assert_eq!(next(2 * 128 * 64 - 1), Some((4, Storage::F16)));
        // Nine values of order 3 are padded to twelve of 2 bytes, those of order 2 are four of 4.
        assert_eq!(next(2 * 128 * 32 - 1), Some((3, Storage::F16)));
        assert_eq!(next(2 * 128 * 24 - 1), Some((2, Storage::F32)));
        assert_eq!(next(2 * 128 * 8 - 1), None);
    }
}
