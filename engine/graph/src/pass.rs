//! Passes as declared: their kind and what they use.

use crate::access::Access;
use crate::handle::{ImageRange, ResourceId};

/// What a pass records, and so which uses it can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
pub enum PassKind {
    /// Draws.
    Graphics,
    /// Dispatches; no attachments.
    Compute,
    /// Copies, fills and clears only.
    Transfer,
}

/// One use of one resource by a pass.
#[derive(Clone, Copy, Debug, Hash)]
pub(crate) struct Use {
    pub resource: ResourceId,
    /// The version used; for a write, the version written over.
    pub version: u32,
    /// The version a write makes.
    pub output: Option<u32>,
    pub range: ImageRange,
    pub access: Access,
    /// Whether the contents of `version` matter.
    pub keeps: bool,
    pub is_image: bool,
}

/// A pass as declared.
#[derive(Clone, Debug, Hash)]
pub(crate) struct Pass {
    pub name: String,
    pub kind: PassKind,
    pub uses: Vec<Use>,
    pub side_effect: bool,
    pub async_suitable: bool,
}

impl Pass {
    pub(crate) fn new(name: String, kind: PassKind) -> Self {
        Self { name, kind, uses: Vec::new(), side_effect: false, async_suitable: false }
    }
}
