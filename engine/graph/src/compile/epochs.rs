//! The life of one subresource as a row of epochs: each write alone, reads in one layout together.
//!
//! A barrier stands between neighbouring epochs and nowhere else, so that reads after reads cost nothing and
//! one barrier serves all reads of what was written.

use crate::access::State;
use crate::access::{WRITES, reads, writes};
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
    /// Whether contents from before matter.
    pub keeps: bool,
}

impl Epoch {
    /// One pass's use of an image (or of a buffer, which has no layout).
    pub fn of_use(step: usize, used: &Use) -> Self {
        Self {
            begin: Slot::Step(step),
            last: Some(step),
            stage: used.access.stage(),
            access: used.access.access(),
            layout: if used.is_image { used.access.layout() } else { ImageLayout::UNDEFINED },
            keeps: used.keeps,
        }
    }

    /// The host's use before or after the plan.
    pub fn of_host(state: State) -> Self {
        let State { stage, access, layout, .. } = state;
        Self { begin: Slot::End, last: None, stage, access, layout, keeps: true }
    }

    pub fn writes(&self) -> bool {
        writes(self.access)
    }

    /// What has to be made available after this epoch.
    pub fn written(&self) -> AccessFlags2 {
        self.access & WRITES
    }

    /// Whether it reads what was there before it.
    pub fn reads_before(&self) -> bool {
        self.keeps && reads(self.access)
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
            && self.stage.contains(other.stage)
            && self.access.contains(other.access)
    }

    /// Takes another epoch in, if both only read and in one layout.
    fn merge(&mut self, other: &Self) -> bool {
        // Two uses by one step are one epoch whatever they are: validation lets no overlapping write pass.
        let joins = !self.writes() && !other.writes() && self.layout == other.layout;
        if joins {
            self.stage |= other.stage;
            self.access |= other.access;
            self.last = other.last.or(self.last);
        }
        joins
    }
}

/// Appends an epoch to a row, merging reads.
pub(super) fn push(epochs: &mut Vec<Epoch>, next: Epoch) {
    if !epochs.last_mut().is_some_and(|last| last.merge(&next)) {
        epochs.push(next);
    }
}
