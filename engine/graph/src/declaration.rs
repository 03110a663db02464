//! What a graph has been told: plain data that the compile phases work on.

use crate::access::State;
use crate::extent::RelativeExtent;
use crate::handle::{ImageRange, ResourceId};
use crate::pass::Pass;
use crate::resource::{Origin, ResourceDesc};

/// Something a frame does without, for `plan` to print.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct LeftOut {
    /// What was left out: a pass, a table, an input.
    pub what: String,
    /// Why.
    pub why: String,
    /// Device memory this saved, in bytes.
    pub bytes: u64,
    /// Time this saved per frame, in seconds, where it has been measured.
    pub time: Option<f64>,
    /// What would bring it back.
    pub would_return: String,
}

/// The pipelines that a room holds ready, for `plan` to print.
#[derive(Clone, Debug, PartialEq, Eq, Hash, serde::Serialize)]
pub struct RoomPipelines {
    /// The room.
    pub room: String,
    /// Permutations prepared for it, used in this frame or not.
    pub prepared: usize,
}

/// Which half of a history a resource is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Half {
    Previous,
    Current,
}

/// A resource as declared.
#[derive(Clone, Debug, Hash)]
pub(crate) struct Resource {
    pub name: String,
    pub desc: ResourceDesc,
    pub origin: Origin,
    /// Which half of a history it is, if one.
    pub half: Option<Half>,
    /// What width and height follow, if anything.
    pub relative: Option<RelativeExtent>,
    /// Version `i + 1` at index `i`; version 0 is what the resource held before.
    pub versions: Vec<Version>,
}

/// One write in the life of a resource.
#[derive(Clone, Copy, Debug, Hash)]
pub(crate) struct Version {
    /// The version it was written over.
    pub parent: u32,
    /// The pass that wrote it, by index of declaration.
    pub writer: usize,
}

/// A version that outlives the plan.
#[derive(Clone, Copy, Debug, Hash)]
pub(crate) struct Export {
    pub resource: ResourceId,
    pub version: u32,
    pub range: ImageRange,
    pub state: State,
    pub is_image: bool,
}

/// Everything declared, without the payloads: what the compile phases work on.
#[derive(Clone, Debug, Default, Hash)]
pub(crate) struct Declaration {
    pub resources: Vec<Resource>,
    pub passes: Vec<Pass>,
    pub exports: Vec<Export>,
    pub left_out: Vec<LeftOut>,
    pub pipelines: Vec<RoomPipelines>,
}
