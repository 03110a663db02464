//! One table from the use of a resource to pipeline stages, memory access, image layout and usage flags
//! (Vulkan 1.3, chapter "Synchronization and Cache Control", synchronization2 flags).

use ash::vk::{self, AccessFlags2 as A, BufferUsageFlags as B, ImageLayout as L, ImageUsageFlags as I};
use ash::vk::{PipelineStageFlags2 as S, QUEUE_FAMILY_IGNORED};

/// How a pass uses a resource.
///
/// A `…Write` replaces what it covers; a `…ReadWrite` also reads what was there. Host accesses and
/// [`Present`](Self::Present) are for the states of imports and exports, not for passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Access {
    /// Vertex attributes fetched at vertex input.
    VertexBuffer,
    /// Indices fetched by an indexed draw.
    IndexBuffer,
    /// Arguments of indirect draws and dispatches.
    IndirectBuffer,
    /// Uniform buffer in the vertex stage.
    VertexUniform,
    /// Uniform buffer in the fragment stage.
    FragmentUniform,
    /// Uniform buffer in the compute stage.
    ComputeUniform,
    /// Storage buffer or image read in the vertex stage.
    VertexStorageRead,
    /// Storage buffer or image read in the fragment stage.
    FragmentStorageRead,
    /// Storage buffer or image read in the compute stage.
    ComputeStorageRead,
    /// Storage buffer or image written, not read, in the fragment stage.
    FragmentStorageWrite,
    /// Storage buffer or image written, not read, in the compute stage.
    ComputeStorageWrite,
    /// Storage buffer or image read and written in the fragment stage.
    FragmentStorageReadWrite,
    /// Storage buffer or image read and written in the compute stage.
    ComputeStorageReadWrite,
    /// Sampled image in the vertex stage.
    VertexSampled,
    /// Sampled image in the fragment stage.
    FragmentSampled,
    /// Sampled image in the compute stage.
    ComputeSampled,
    /// Depth image sampled in the vertex stage.
    VertexSampledDepth,
    /// Depth image sampled in the fragment stage; may be the pass's own read-only depth attachment.
    FragmentSampledDepth,
    /// Depth image sampled in the compute stage.
    ComputeSampledDepth,
    /// Colour attachment, cleared or fully overwritten.
    ColorAttachmentWrite,
    /// Colour attachment, loaded: blended into, or partly overwritten.
    ColorAttachmentReadWrite,
    /// Depth attachment, cleared and then tested and written.
    DepthAttachmentWrite,
    /// Depth attachment, loaded, tested and written.
    DepthAttachmentReadWrite,
    /// Depth attachment, tested only; its store operation must be `NONE`, because a store is a write.
    DepthAttachmentRead,
    /// Source of a copy, blit or resolve.
    TransferSource,
    /// Destination of a copy, blit, resolve, clear, fill or update.
    TransferDestination,
    /// Read by the host.
    HostRead,
    /// Written by the host.
    HostWrite,
    /// Handed to the presentation engine.
    Present,
}

/// One row of the table.
struct Row {
    stage: S,
    access: A,
    layout: L,
    buffer: B,
    image: I,
}

const SHADER_READ: L = L::SHADER_READ_ONLY_OPTIMAL;
const DEPTH_READ: L = L::DEPTH_STENCIL_READ_ONLY_OPTIMAL;
const DEPTH_WRITE: L = L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
const COLOR: L = L::COLOR_ATTACHMENT_OPTIMAL;
/// The value of a usage column where the use does not exist for that kind of resource.
const NO_BUFFER: B = B::empty();
const NO_IMAGE: I = I::empty();

impl Access {
    /// Every access once, in the order of the table.
    pub const ALL: [Self; 29] = {
        use Access::*;
        [
            VertexBuffer,
            IndexBuffer,
            IndirectBuffer,
            VertexUniform,
            FragmentUniform,
            ComputeUniform,
            VertexStorageRead,
            FragmentStorageRead,
            ComputeStorageRead,
            FragmentStorageWrite,
            ComputeStorageWrite,
            FragmentStorageReadWrite,
            ComputeStorageReadWrite,
            VertexSampled,
            FragmentSampled,
            ComputeSampled,
            VertexSampledDepth,
            FragmentSampledDepth,
            ComputeSampledDepth,
            ColorAttachmentWrite,
            ColorAttachmentReadWrite,
            DepthAttachmentWrite,
            DepthAttachmentReadWrite,
            DepthAttachmentRead,
            TransferSource,
            TransferDestination,
            HostRead,
            HostWrite,
            Present,
        ]
    };

    /// The table: a use, and what it is in Vulkan's terms.
    #[rustfmt::skip]
    fn row(self) -> Row {
        let row = |stage, access, layout, buffer, image| Row { stage, access, layout, buffer, image };
        let depth_tests = S::EARLY_FRAGMENT_TESTS | S::LATE_FRAGMENT_TESTS;
        let storage = A::SHADER_STORAGE_READ | A::SHADER_STORAGE_WRITE;
        let color = A::COLOR_ATTACHMENT_READ | A::COLOR_ATTACHMENT_WRITE;
        let depth = A::DEPTH_STENCIL_ATTACHMENT_READ | A::DEPTH_STENCIL_ATTACHMENT_WRITE;
        match self {
            Self::VertexBuffer => row(S::VERTEX_ATTRIBUTE_INPUT, A::VERTEX_ATTRIBUTE_READ, L::UNDEFINED, B::VERTEX_BUFFER, NO_IMAGE),
            Self::IndexBuffer => row(S::INDEX_INPUT, A::INDEX_READ, L::UNDEFINED, B::INDEX_BUFFER, NO_IMAGE),
            Self::IndirectBuffer => row(S::DRAW_INDIRECT, A::INDIRECT_COMMAND_READ, L::UNDEFINED, B::INDIRECT_BUFFER, NO_IMAGE),
            Self::VertexUniform => row(S::VERTEX_SHADER, A::UNIFORM_READ, L::UNDEFINED, B::UNIFORM_BUFFER, NO_IMAGE),
            Self::FragmentUniform => row(S::FRAGMENT_SHADER, A::UNIFORM_READ, L::UNDEFINED, B::UNIFORM_BUFFER, NO_IMAGE),
            Self::ComputeUniform => row(S::COMPUTE_SHADER, A::UNIFORM_READ, L::UNDEFINED, B::UNIFORM_BUFFER, NO_IMAGE),
            Self::VertexStorageRead => row(S::VERTEX_SHADER, A::SHADER_STORAGE_READ, L::GENERAL, B::STORAGE_BUFFER, I::STORAGE),
            Self::FragmentStorageRead => row(S::FRAGMENT_SHADER, A::SHADER_STORAGE_READ, L::GENERAL, B::STORAGE_BUFFER, I::STORAGE),
            Self::ComputeStorageRead => row(S::COMPUTE_SHADER, A::SHADER_STORAGE_READ, L::GENERAL, B::STORAGE_BUFFER, I::STORAGE),
            Self::FragmentStorageWrite => row(S::FRAGMENT_SHADER, A::SHADER_STORAGE_WRITE, L::GENERAL, B::STORAGE_BUFFER, I::STORAGE),
            Self::ComputeStorageWrite => row(S::COMPUTE_SHADER, A::SHADER_STORAGE_WRITE, L::GENERAL, B::STORAGE_BUFFER, I::STORAGE),
            Self::FragmentStorageReadWrite => row(S::FRAGMENT_SHADER, storage, L::GENERAL, B::STORAGE_BUFFER, I::STORAGE),
            Self::ComputeStorageReadWrite => row(S::COMPUTE_SHADER, storage, L::GENERAL, B::STORAGE_BUFFER, I::STORAGE),
            Self::VertexSampled => row(S::VERTEX_SHADER, A::SHADER_SAMPLED_READ, SHADER_READ, NO_BUFFER, I::SAMPLED),
            Self::FragmentSampled => row(S::FRAGMENT_SHADER, A::SHADER_SAMPLED_READ, SHADER_READ, NO_BUFFER, I::SAMPLED),
            Self::ComputeSampled => row(S::COMPUTE_SHADER, A::SHADER_SAMPLED_READ, SHADER_READ, NO_BUFFER, I::SAMPLED),
            Self::VertexSampledDepth => row(S::VERTEX_SHADER, A::SHADER_SAMPLED_READ, DEPTH_READ, NO_BUFFER, I::SAMPLED),
            Self::FragmentSampledDepth => row(S::FRAGMENT_SHADER, A::SHADER_SAMPLED_READ, DEPTH_READ, NO_BUFFER, I::SAMPLED),
            Self::ComputeSampledDepth => row(S::COMPUTE_SHADER, A::SHADER_SAMPLED_READ, DEPTH_READ, NO_BUFFER, I::SAMPLED),
            Self::ColorAttachmentWrite => row(S::COLOR_ATTACHMENT_OUTPUT, A::COLOR_ATTACHMENT_WRITE, COLOR, NO_BUFFER, I::COLOR_ATTACHMENT),
            Self::ColorAttachmentReadWrite => row(S::COLOR_ATTACHMENT_OUTPUT, color, COLOR, NO_BUFFER, I::COLOR_ATTACHMENT),
            Self::DepthAttachmentWrite => row(depth_tests, depth, DEPTH_WRITE, NO_BUFFER, I::DEPTH_STENCIL_ATTACHMENT),
            Self::DepthAttachmentReadWrite => row(depth_tests, depth, DEPTH_WRITE, NO_BUFFER, I::DEPTH_STENCIL_ATTACHMENT),
            Self::DepthAttachmentRead => row(depth_tests, A::DEPTH_STENCIL_ATTACHMENT_READ, DEPTH_READ, NO_BUFFER, I::DEPTH_STENCIL_ATTACHMENT),
            Self::TransferSource => row(S::ALL_TRANSFER, A::TRANSFER_READ, L::TRANSFER_SRC_OPTIMAL, B::TRANSFER_SRC, I::TRANSFER_SRC),
            Self::TransferDestination => row(S::ALL_TRANSFER, A::TRANSFER_WRITE, L::TRANSFER_DST_OPTIMAL, B::TRANSFER_DST, I::TRANSFER_DST),
            Self::HostRead => row(S::HOST, A::HOST_READ, L::GENERAL, NO_BUFFER, NO_IMAGE),
            Self::HostWrite => row(S::HOST, A::HOST_WRITE, L::GENERAL, NO_BUFFER, NO_IMAGE),
            Self::Present => row(S::NONE, A::NONE, L::PRESENT_SRC_KHR, NO_BUFFER, NO_IMAGE),
        }
    }

    /// The pipeline stages of this use.
    pub fn stage(self) -> vk::PipelineStageFlags2 {
        self.row().stage
    }

    /// The memory accesses of this use.
    pub fn access(self) -> vk::AccessFlags2 {
        self.row().access
    }

    /// The layout an image is in during this use; without meaning for a buffer.
    pub fn layout(self) -> vk::ImageLayout {
        self.row().layout
    }

    /// The usage a buffer needs for this; empty if a pass cannot use a buffer so.
    pub fn buffer_usage(self) -> vk::BufferUsageFlags {
        self.row().buffer
    }

    /// The usage an image needs for this; empty if a pass cannot use an image so.
    pub fn image_usage(self) -> vk::ImageUsageFlags {
        self.row().image
    }

    /// Whether the use writes.
    pub fn writes(self) -> bool {
        writes(self.access())
    }

    /// Whether the use depends on what the resource held: every pure read, and every `…ReadWrite`.
    /// (A cleared depth attachment reads only what the same pass wrote.)
    pub fn keeps_contents(self) -> bool {
        self != Self::DepthAttachmentWrite && reads(self.access())
    }
}

/// Every access flag that writes.
pub(crate) const WRITES: A = A::from_raw(
    A::SHADER_STORAGE_WRITE.as_raw()
        | A::SHADER_WRITE.as_raw()
        | A::COLOR_ATTACHMENT_WRITE.as_raw()
        | A::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw()
        | A::TRANSFER_WRITE.as_raw()
        | A::HOST_WRITE.as_raw()
        | A::MEMORY_WRITE.as_raw()
        | A::TRANSFORM_FEEDBACK_WRITE_EXT.as_raw()
        | A::TRANSFORM_FEEDBACK_COUNTER_WRITE_EXT.as_raw()
        | A::ACCELERATION_STRUCTURE_WRITE_KHR.as_raw(),
);

pub(crate) fn writes(access: A) -> bool {
    access.intersects(WRITES)
}

pub(crate) fn reads(access: A) -> bool {
    access.as_raw() & !WRITES.as_raw() != 0
}

/// What a resource was last used for when the plan begins, or what the host does with it next.
///
/// Stage `NONE` means that nothing is pending: on entry the contents are already visible to every access
/// (after a semaphore or fence wait, say); on exit the host synchronises by other means, with what follows and
/// with the next execution of the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct State {
    /// Stages of the last use before, or of the next use after, the plan.
    pub stage: vk::PipelineStageFlags2,
    /// Accesses of that use. Any write among them makes it a write.
    pub access: vk::AccessFlags2,
    /// Image layout; `UNDEFINED` on entry means contents that nobody may read. Without meaning for a buffer.
    pub layout: vk::ImageLayout,
    /// The owning queue family (or `EXTERNAL`, `FOREIGN_EXT`); `QUEUE_FAMILY_IGNORED` means the family the
    /// plan runs on, or a resource shared concurrently.
    pub queue_family: u32,
}

impl State {
    /// No contents, nothing pending: a resource just created.
    pub const UNDEFINED: Self =
        Self { stage: S::NONE, access: A::NONE, layout: L::UNDEFINED, queue_family: QUEUE_FAMILY_IGNORED };

    /// Nothing pending, image in `layout`.
    pub const fn idle(layout: vk::ImageLayout) -> Self {
        Self { layout, ..Self::UNDEFINED }
    }

    /// The state in which one use leaves a resource, or wants to find it.
    pub fn of(access: Access) -> Self {
        let row = access.row();
        Self { stage: row.stage, access: row.access, layout: row.layout, queue_family: QUEUE_FAMILY_IGNORED }
    }

    /// The same state, owned by another queue family: on entry the plan acquires, on exit it releases.
    pub const fn on_queue_family(self, queue_family: u32) -> Self {
        Self { queue_family, ..self }
    }
}

impl From<Access> for State {
    fn from(access: Access) -> Self {
        Self::of(access)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_agrees_with_itself() {
        for access in Access::ALL {
            let name = format!("{access:?}");
            let writes = name.contains("Write") || access == Access::TransferDestination;
            assert_eq!(access.writes(), writes, "{name}");
            let keeps = name.contains("ReadWrite") || (!writes && access != Access::Present);
            assert_eq!(access.keeps_contents(), keeps, "{name}");
            let for_image = !access.image_usage().is_empty();
            assert!(!for_image || access.layout() != L::UNDEFINED, "{name} of an image needs a layout");
        }
        let mut each: Vec<Access> = Access::ALL.to_vec();
        each.dedup();
        assert_eq!(each.len(), Access::ALL.len());
    }
}
