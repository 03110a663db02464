//! What each use needs, worked out from its parts (stage, then kind of memory access) and not from the graph's
//! table, so that a wrong row there is found here.

use airglow_graph::Access;
use ash::vk::{AccessFlags2 as A, ImageLayout as L, PipelineStageFlags2 as S};

/// Stages, accesses and, of an image, the layout that a pass's use needs; `None` for what no pass can do.
pub(crate) fn needs(access: Access) -> Option<(S, A, L)> {
    Some((stage(access)?, flags(access), layout(access)))
}

fn stage(access: Access) -> Option<S> {
    use Access::*;
    Some(match access {
        VertexBuffer => S::VERTEX_ATTRIBUTE_INPUT,
        IndexBuffer => S::INDEX_INPUT,
        IndirectBuffer => S::DRAW_INDIRECT,
        VertexUniform | VertexStorageRead | VertexSampled | VertexSampledDepth => S::VERTEX_SHADER,
        FragmentUniform
        | FragmentStorageRead
        | FragmentStorageWrite
        | FragmentStorageReadWrite
        | FragmentSampled
        | FragmentSampledDepth => S::FRAGMENT_SHADER,
        ComputeUniform
        | ComputeStorageRead
        | ComputeStorageWrite
        | ComputeStorageReadWrite
        | ComputeSampled
        | ComputeSampledDepth => S::COMPUTE_SHADER,
        ColorAttachmentWrite | ColorAttachmentReadWrite => S::COLOR_ATTACHMENT_OUTPUT,
        DepthAttachmentWrite | DepthAttachmentReadWrite | DepthAttachmentRead => {
            S::EARLY_FRAGMENT_TESTS | S::LATE_FRAGMENT_TESTS
        }
        TransferSource | TransferDestination => S::ALL_TRANSFER,
        HostRead | HostWrite | Present => return None,
    })
}

fn flags(access: Access) -> A {
    use Access::*;
    match access {
        VertexBuffer => A::VERTEX_ATTRIBUTE_READ,
        IndexBuffer => A::INDEX_READ,
        IndirectBuffer => A::INDIRECT_COMMAND_READ,
        VertexUniform | FragmentUniform | ComputeUniform => A::UNIFORM_READ,
        VertexStorageRead | FragmentStorageRead | ComputeStorageRead => A::SHADER_STORAGE_READ,
        FragmentStorageWrite | ComputeStorageWrite => A::SHADER_STORAGE_WRITE,
        FragmentStorageReadWrite | ComputeStorageReadWrite => {
            A::SHADER_STORAGE_READ | A::SHADER_STORAGE_WRITE
        }
        VertexSampled | FragmentSampled | ComputeSampled => A::SHADER_SAMPLED_READ,
        VertexSampledDepth | FragmentSampledDepth | ComputeSampledDepth => A::SHADER_SAMPLED_READ,
        ColorAttachmentWrite => A::COLOR_ATTACHMENT_WRITE,
        ColorAttachmentReadWrite => A::COLOR_ATTACHMENT_READ | A::COLOR_ATTACHMENT_WRITE,
        // Even a cleared depth attachment is read back by the tests of its own pass.
        DepthAttachmentWrite | DepthAttachmentReadWrite => {
            A::DEPTH_STENCIL_ATTACHMENT_READ | A::DEPTH_STENCIL_ATTACHMENT_WRITE
        }
        DepthAttachmentRead => A::DEPTH_STENCIL_ATTACHMENT_READ,
        TransferSource => A::TRANSFER_READ,
        TransferDestination => A::TRANSFER_WRITE,
        HostRead => A::HOST_READ,
        HostWrite => A::HOST_WRITE,
        Present => A::NONE,
    }
}

fn layout(access: Access) -> L {
    use Access::*;
    match access {
        VertexSampled | FragmentSampled | ComputeSampled => L::SHADER_READ_ONLY_OPTIMAL,
        VertexSampledDepth | FragmentSampledDepth | ComputeSampledDepth | DepthAttachmentRead => {
            L::DEPTH_STENCIL_READ_ONLY_OPTIMAL
        }
        ColorAttachmentWrite | ColorAttachmentReadWrite => L::COLOR_ATTACHMENT_OPTIMAL,
        DepthAttachmentWrite | DepthAttachmentReadWrite => L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        TransferSource => L::TRANSFER_SRC_OPTIMAL,
        TransferDestination => L::TRANSFER_DST_OPTIMAL,
        Present => L::PRESENT_SRC_KHR,
        _ => L::GENERAL,
    }
}
