//! A render graph as plain data: declare by use, compile to a plan of order, barriers and reasons; makes no
//! Vulkan call.
//!
//! A pass says what it uses; the graph finds the order and the barriers (synchronization2), leaves out what
//! reaches nothing, and refuses hazards with a message that names both passes, the resource and the mend.
//!
//! ```
//! use airglow_graph::{Access, BufferDesc, Graph, ImageDesc, Limits, PassKind};
//! use ash::vk;
//!
//! let mut graph = Graph::new();
//! let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
//! let transfer = BufferDesc { size: 64_000, usage };
//! let transfer = graph.import_buffer("transfer", transfer, Access::ComputeStorageRead, Access::ComputeStorageRead);
//! let hdr = ImageDesc::new_2d(640, 480, vk::Format::R16G16B16A16_SFLOAT);
//! let hdr = graph.create_image("hdr", hdr);
//!
//! let mut relight = graph.pass("relight", PassKind::Compute);
//! relight.read(&transfer, Access::ComputeStorageRead);
//! let colours = relight.create_buffer("colours", BufferDesc::new(16_000), Access::ComputeStorageWrite);
//! relight.record("what the recorder needs");
//!
//! let mut draw = graph.pass("draw", PassKind::Graphics);
//! draw.read(&colours, Access::VertexBuffer);
//! let hdr = draw.write(hdr, Access::ColorAttachmentWrite);
//! draw.record("the same for the draw");
//!
//! graph.export(hdr, Access::FragmentSampled);
//! let plan = graph.compile(&Limits::default())?;
//! assert_eq!(plan.steps()[1].barriers.buffers[0].dst_stage, vk::PipelineStageFlags2::VERTEX_ATTRIBUTE_INPUT);
//! println!("{}", plan.text());
//! # Ok::<(), airglow_graph::GraphError>(())
//! ```
#![forbid(unsafe_code)]

mod access;
mod builder;
mod compile;
mod declaration;
mod error;
mod extent;
mod graph;
mod handle;
mod history;
mod options;
mod pass;
mod plan;
mod resource;
mod topology;

pub use access::{Access, State};
pub use builder::PassBuilder;
pub use declaration::{LeftOut, RoomPipelines};
pub use error::GraphError;
pub use extent::{ExtentBase, RelativeExtent};
pub use graph::Graph;
pub use handle::{Buffer, Handle, Image, ImageRange, Kind, ResourceId};
pub use history::History;
pub use options::{Limits, Options};
pub use pass::PassKind;
pub use plan::{
    Barriers, BufferBarrier, Cause, CullReason, Culled, Handover, ImageBarrier, Lifetime, Placement, Plan,
    PlanAccess, PlanBytes, PlanDifference, PlanExport, PlanHistory, PlanResource, Resized, Sharing, Step,
};
pub use resource::{BufferDesc, ImageDesc, Origin, ResourceDesc};
pub use topology::Topology;
