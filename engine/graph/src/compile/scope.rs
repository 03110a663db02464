//! Synchronisation scopes: stages, and accesses in them. `ALL_COMMANDS`, `MEMORY_READ` and `MEMORY_WRITE` stand for
//! every stage, read and write (Vulkan specification, "Synchronization Scopes").

use crate::access::WRITES;
use ash::vk::{AccessFlags2, PipelineStageFlags2};

/// Stages, and accesses in them.
pub(super) type Scope = (PipelineStageFlags2, AccessFlags2);

/// The scope of nothing.
pub(super) const NOWHERE: Scope = (PipelineStageFlags2::NONE, AccessFlags2::NONE);
/// The scope of every access that can be.
pub(super) const EVERYWHERE: Scope =
    (PipelineStageFlags2::from_raw(u64::MAX), AccessFlags2::from_raw(u64::MAX));

/// Whether `outer` holds all of `inner`.
pub(super) fn covers(outer: Scope, inner: Scope) -> bool {
    let stages = outer.0.contains(PipelineStageFlags2::ALL_COMMANDS) || outer.0.contains(inner.0);
    let mut access = outer.1;
    if access.contains(AccessFlags2::MEMORY_READ) {
        access |= AccessFlags2::from_raw(!WRITES.as_raw());
    }
    if access.contains(AccessFlags2::MEMORY_WRITE) {
        access |= WRITES;
    }
    stages && access.contains(inner.1)
}

/// Both scopes, without flags that a wider one beside them covers.
pub(super) fn union(a: Scope, b: Scope) -> Scope {
    let (stage, access) = (a.0 | b.0, a.1 | b.1);
    let all = PipelineStageFlags2::ALL_COMMANDS;
    let stage = if stage.contains(all) { all } else { stage };
    let keep = |access: AccessFlags2, general: AccessFlags2| {
        if access.contains(general) { general } else { access }
    };
    let reads = keep(access & !WRITES, AccessFlags2::MEMORY_READ);
    (stage, reads | keep(access & WRITES, AccessFlags2::MEMORY_WRITE))
}

/// One stage is enough for barriers to chain through.
pub(super) fn one_of(stages: PipelineStageFlags2) -> PipelineStageFlags2 {
    let bits = stages.as_raw();
    PipelineStageFlags2::from_raw(bits & bits.wrapping_neg())
}
