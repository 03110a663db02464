//! Pipeline statistics: what the device itself counted of a pass.

use crate::error::GpuError;
use crate::feature::Feature;
use crate::offer::Missing;
use crate::shared::Shared;
use ash::vk::{self, QueryPipelineStatisticFlags as Flags};

/// What is counted, in the order in which Vulkan writes the counts: by bit.
pub(super) const COUNTED: Flags = Flags::from_raw(
    Flags::INPUT_ASSEMBLY_VERTICES.as_raw()
        | Flags::INPUT_ASSEMBLY_PRIMITIVES.as_raw()
        | Flags::VERTEX_SHADER_INVOCATIONS.as_raw()
        | Flags::CLIPPING_INVOCATIONS.as_raw()
        | Flags::CLIPPING_PRIMITIVES.as_raw()
        | Flags::FRAGMENT_SHADER_INVOCATIONS.as_raw()
        | Flags::COMPUTE_SHADER_INVOCATIONS.as_raw(),
);
const COUNTS: usize = COUNTED.as_raw().count_ones() as usize;

/// The counts of one pass and whether they are there, as a query returns them.
pub(super) type Raw = [u64; COUNTS + 1];

/// What the device counted of one pass. Vulkan lets a device round: helper invocations, culled primitives and vertices
/// that were kept for reuse may count or not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PassStatistics {
    /// Vertices read.
    pub input_vertices: u64,
    /// Primitives put together.
    pub input_primitives: u64,
    /// Invocations of vertex shaders.
    pub vertex_invocations: u64,
    /// Primitives that reached clipping.
    pub clipping_invocations: u64,
    /// Primitives that left clipping.
    pub clipping_primitives: u64,
    /// Invocations of fragment shaders.
    pub fragment_invocations: u64,
    /// Invocations of compute shaders.
    pub compute_invocations: u64,
}

impl PassStatistics {
    pub(super) fn of([iv, ip, vertex, ci, cp, fragment, compute, _]: Raw) -> Self {
        Self {
            input_vertices: iv,
            input_primitives: ip,
            vertex_invocations: vertex,
            clipping_invocations: ci,
            clipping_primitives: cp,
            fragment_invocations: fragment,
            compute_invocations: compute,
        }
    }

    /// Every count with its name, in one order everywhere: text, JSON, CSV.
    pub fn named(&self) -> [(&'static str, u64); COUNTS] {
        [
            ("input_vertices", self.input_vertices),
            ("input_primitives", self.input_primitives),
            ("vertex_invocations", self.vertex_invocations),
            ("clipping_invocations", self.clipping_invocations),
            ("clipping_primitives", self.clipping_primitives),
            ("fragment_invocations", self.fragment_invocations),
            ("compute_invocations", self.compute_invocations),
        ]
    }
}

/// A pool of `passes` statistics, on a device where the feature is enabled.
pub(super) fn pool(shared: &Shared, passes: u32) -> Result<vk::QueryPool, GpuError> {
    let feature = Feature::PipelineStatisticsQuery;
    if !shared.facts.features.contains(feature) {
        return Err(GpuError::Missing(vec![Missing::Feature { feature, buys: "pipeline statistics" }]));
    }
    let info = vk::QueryPoolCreateInfo::default()
        .query_type(vk::QueryType::PIPELINE_STATISTICS)
        .pipeline_statistics(COUNTED)
        .query_count(passes.max(1));
    // SAFETY: a live device with the feature, and a complete description.
    unsafe { shared.device().create_query_pool(&info, None) }.map_err(GpuError::vulkan("vkCreateQueryPool"))
}
