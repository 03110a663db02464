//! A render graph as plain data: declare by use, compile to a plan of order, barriers and reasons; makes no
//! Vulkan call.
#![forbid(unsafe_code)]

mod access;
mod compile;
mod error;
mod graph;
mod handle;
mod pass;
mod plan;
mod resource;

pub use access::{Access, State};
pub use error::GraphError;
pub use graph::{Graph, LeftOut, Limits};
pub use handle::{Buffer, Handle, Image, ImageRange, Kind, ResourceId};
pub use pass::{PassBuilder, PassKind};
pub use plan::{
    Barriers, BufferBarrier, Cause, CullReason, Culled, ImageBarrier, Lifetime, Plan, PlanAccess,
    PlanResource, Step,
};
pub use resource::{BufferDesc, ImageDesc, Origin, ResourceDesc};
