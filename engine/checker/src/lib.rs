//! A second opinion on render graph plans, by brute force: every barrier of a plan is replayed over every
//! subresource, twice in a row, and every pair of accesses is looked at.
//!
//! It reads the plan's public data only and shares no code with what compiled it, so that one mistake in the
//! compiler is not made here again. An access is remembered with the stages known to come after it and, if it
//! wrote, with where its write is visible; a barrier extends both for what lies in its first scope, directly or
//! through an earlier barrier (Vulkan 1.3, "Synchronization and Cache Control": scopes, dependency chains,
//! availability and visibility, layout transitions, queue family ownership transfer).
//!
//! ```
//! use airglow_graph::{Access, BufferDesc, Graph, Limits, PassKind};
//!
//! let mut graph = Graph::new();
//! let mut pass = graph.pass("fill", PassKind::Compute);
//! let buffer = pass.create_buffer("buffer", BufferDesc::new(64), Access::ComputeStorageWrite);
//! pass.record(());
//! graph.export(buffer, Access::VertexBuffer);
//! let plan = graph.compile(&Limits::default())?;
//! let report = airglow_checker::check(&plan)?;
//! assert_eq!((report.barriers, report.redundant.len()), (2, 0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod event;
mod mutation;
mod replay;
mod report;
mod sharing;
mod structure;
mod trace;
mod uses;
mod violation;

pub use mutation::{Edit, Mutation};
pub use report::{Report, Superfluous};
pub use sharing::check_sharing;
pub use trace::{Barrier, Moment, Role, Trace};
pub use violation::{Kind, Violation};

use airglow_graph::Plan;

/// Replays a plan.
///
/// # Errors
/// The first thing wrong, by resource, mip and layer, then time.
pub fn check<R>(plan: &Plan<R>) -> Result<Report, Violation> {
    Trace::of(plan).check()
}
