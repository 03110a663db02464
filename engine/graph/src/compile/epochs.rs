//! The life of one subresource as a row of epochs: each write alone, reads in one layout together.
//!
//! A barrier stands between neighbouring epochs and nowhere else, so that reads after reads cost nothing and
//! one barrier serves all reads of what was written.

use super::scope::{NOWHERE, Scope, covers, union};
use crate::access::{State, WRITES, writes};
use crate::pass::Use;
use ash::vk::{AccessFlags2, ImageLayout, PipelineStageFlags2};

/// Where in the plan an epoch begins, and so where the barrier before it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Slot {
    Step(usize),
    End,
}

/// One write, or reads with nothing in between.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Epoch {
    pub begin: Slot,
    /// The last step in it; `None` for the host.
    pub last: Option<usize>,
    pub stage: PipelineStageFlags2,
    pub access: AccessFlags2,
    pub layout: ImageLayout,
    /// The stages and accesses that what came before is not yet visible to.
    pub opens: Scope,
    /// Whether contents from before matter.
    pub keeps: bool,
}

impl Epoch {
    /// One pass's use of an image (or of a buffer, which has no layout).
    pub fn of_use(step: usize, used: &Use) -> Self {
        let (stage, access) = (used.access.stage(), used.access.access());
        Self {
            begin: Slot::Step(step),
            last: Some(step),
            stage,
            access,
            opens: (stage, access),
            layout: if used.is_image { used.access.layout() } else { ImageLayout::UNDEFINED },
            keeps: used.keeps,
        }
    }

    /// The host's use before or after the plan.
    pub fn of_host(state: State) -> Self {
        let State { stage, access, layout, .. } = state;
        Self { begin: Slot::End, last: None, stage, access, layout, opens: (stage, access), keeps: true }
    }

    pub fn writes(&self) -> bool {
        writes(self.access)
    }

    /// What has to be made available after this epoch.
    pub fn written(&self) -> AccessFlags2 {
        self.access & WRITES
    }

    /// The accesses that read what was there before, unless all of it is visible in one of `scopes` already.
    pub fn unseen(&self, scopes: &[Scope]) -> AccessFlags2 {
        let reads = if self.keeps { self.access & !WRITES } else { AccessFlags2::NONE };
        let seen = |scope: &Scope| covers(*scope, (self.stage, reads));
        if scopes.iter().any(seen) { AccessFlags2::NONE } else { reads }
    }

    /// Whether nothing of it is pending: the host has synchronised, or will.
    pub fn is_idle(&self) -> bool {
        self.stage.is_empty() && self.access.is_empty()
    }

    /// Whether every read of `other` reads where this epoch already may, in the same layout.
    pub fn covers(&self, other: &Self) -> bool {
        !self.writes()
            && !other.writes()
            && self.layout == other.layout
            && covers((self.stage, self.access), (other.stage, other.access))
    }

    /// Both read: whoever writes next waits for both.
    pub fn also_waits_for(&mut self, earlier: &Self) {
        self.stage = union((self.stage, AccessFlags2::NONE), (earlier.stage, AccessFlags2::NONE)).0;
    }

    /// Takes another epoch in, if both only read and in one layout.
    fn merge(&mut self, other: &Self) -> bool {
        // Two uses by one step are one epoch whatever they are: validation lets no overlapping write pass.
        let joins = !self.writes() && !other.writes() && self.layout == other.layout;
        if joins {
            (self.stage, self.access) = union((self.stage, self.access), (other.stage, other.access));
            self.opens = union(self.opens, other.opens);
            self.last = other.last.or(self.last);
        }
        joins
    }
}

/// Appends an epoch to a row, merging reads. `found` is what the host left; where it reads, the plan may.
pub(super) fn push(epochs: &mut Vec<Epoch>, mut next: Epoch, found: Option<&Epoch>) {
    let still = |found: &&Epoch| epochs.iter().all(|e| !e.writes() && e.layout == found.layout);
    if found.filter(still).is_some_and(|found| found.covers(&next)) {
        next.opens = NOWHERE;
    }
    if !epochs.last_mut().is_some_and(|last| last.merge(&next)) {
        epochs.push(next);
    }
}
