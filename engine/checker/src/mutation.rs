//! Ways to break a barrier: what the checker must notice, or name as superfluous.

use crate::trace::{Barrier, Trace};
use ash::vk::{AccessFlags2, ImageLayout, PipelineStageFlags2, QUEUE_FAMILY_IGNORED};

/// One change of one barrier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mutation {
    /// The barrier is gone.
    Drop,
    /// One stage fewer is waited for.
    SourceStage(PipelineStageFlags2),
    /// One stage fewer waits.
    DestinationStage(PipelineStageFlags2),
    /// One write fewer is made available.
    SourceAccess(AccessFlags2),
    /// Writes are made visible to one access fewer.
    DestinationAccess(AccessFlags2),
    /// Another old layout.
    OldLayout(ImageLayout),
    /// Another new layout.
    NewLayout(ImageLayout),
    /// Another giving queue family.
    SourceFamily(u32),
    /// Another taking queue family.
    DestinationFamily(u32),
}

/// A mutation of one barrier of a trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edit {
    /// Index of the moment.
    pub moment: usize,
    /// Index of the barrier in it.
    pub barrier: usize,
    /// The change.
    pub mutation: Mutation,
}

impl Mutation {
    /// The barrier so changed; `None` if it is gone.
    pub fn of(self, barrier: &Barrier) -> Option<Barrier> {
        let mut b = *barrier;
        match self {
            Self::Drop => return None,
            Self::SourceStage(bit) => b.src_stage &= !bit,
            Self::DestinationStage(bit) => b.dst_stage &= !bit,
            Self::SourceAccess(bit) => b.src_access &= !bit,
            Self::DestinationAccess(bit) => b.dst_access &= !bit,
            Self::OldLayout(layout) => b.old_layout = layout,
            Self::NewLayout(layout) => b.new_layout = layout,
            Self::SourceFamily(family) => b.src_queue_family = family,
            Self::DestinationFamily(family) => b.dst_queue_family = family,
        }
        Some(b)
    }

    /// Whether it takes something away, so that the barrier did more than it had to if nobody notices.
    pub fn narrows(self) -> bool {
        use Mutation::*;
        matches!(self, Drop | SourceStage(_) | DestinationStage(_) | SourceAccess(_) | DestinationAccess(_))
    }

    /// Every mutation of one barrier: dropped, each flag taken away, each layout and family another.
    pub fn all(b: &Barrier) -> Vec<Self> {
        let stages = |flags: PipelineStageFlags2| bits(flags.as_raw()).map(PipelineStageFlags2::from_raw);
        let accesses = |flags: AccessFlags2| bits(flags.as_raw()).map(AccessFlags2::from_raw);
        let mut all = vec![Self::Drop];
        all.extend(stages(b.src_stage).map(Self::SourceStage));
        all.extend(stages(b.dst_stage).map(Self::DestinationStage));
        all.extend(accesses(b.src_access).map(Self::SourceAccess));
        all.extend(accesses(b.dst_access).map(Self::DestinationAccess));
        if !b.aspects.is_empty() {
            all.extend(other_layouts(b.old_layout, b.new_layout).map(Self::OldLayout));
            all.extend(other_layouts(b.new_layout, ImageLayout::UNDEFINED).map(Self::NewLayout));
        }
        if b.src_queue_family != QUEUE_FAMILY_IGNORED {
            all.push(Self::SourceFamily(b.src_queue_family.wrapping_add(5)));
            all.push(Self::DestinationFamily(b.dst_queue_family.wrapping_add(5)));
        }
        all
    }
}

impl Trace {
    /// Every mutation of every barrier.
    pub fn edits(&self) -> Vec<Edit> {
        let of_barrier = |(moment, barrier, b)| {
            Mutation::all(b).into_iter().map(move |mutation| Edit { moment, barrier, mutation })
        };
        self.barriers().flat_map(of_barrier).collect()
    }
}

fn bits(flags: u64) -> impl Iterator<Item = u64> {
    (0..64).map(|bit| 1 << bit).filter(move |bit| flags & bit != 0)
}

/// Two wrong layouts. To keep what nobody wants (`UNDEFINED` made the layout it has) is not wrong, hence the
/// choice among layouts that differ from both ends.
fn other_layouts(layout: ImageLayout, other_end: ImageLayout) -> impl Iterator<Item = ImageLayout> {
    let candidates = [ImageLayout::PREINITIALIZED, ImageLayout::PRESENT_SRC_KHR];
    candidates.into_iter().filter(move |candidate| *candidate != layout && *candidate != other_end)
}
