//! What a host may have counted of a frame, readable frames later.

use airglow_gpu::{Counted, Look, Records};

use crate::shadow::Receivers;

/// Counters of [`Receivers::looks`], to be made by [`Health::new`](airglow_gpu::Health::new): receivers whose position, and
/// those whose normal, is not finite; receivers whose visibility is not; those whose result was none that a visibility can
/// have and was clamped.
pub const HEALTH: [&str; 3] =
    ["shadow inputs not finite", "shadow visibility not finite", "shadow visibility clamped"];

impl Receivers {
    /// What a [`Tally`](airglow_gpu::Tally) of [`HEALTH`] looks at after the pass: the host's buffers, or handles of a
    /// graph, with visibility and records as the pass wrote them for `order` bands. A host that makes no tally pays
    /// nothing.
    pub fn looks<B>(
        &self,
        order: usize,
        positions: B,
        normals: Option<B>,
        visibility: B,
        records: B,
    ) -> Vec<Look<B>> {
        let receivers = |words| Records::whole(self.count().into(), words);
        let not_finite = |counter, buffer, words| Look {
            counter,
            counted: Counted::NotFinite,
            buffer,
            records: receivers(words),
        };
        let mut looks = vec![not_finite(0, positions, 3)];
        looks.extend(normals.map(|normals| not_finite(0, normals, 3)));
        looks.push(not_finite(1, visibility, (order * order) as u32));
        let clusters = Records { count: self.clusters().into(), stride: 2, first: 1, words: 1 };
        looks.push(Look { counter: 2, counted: Counted::Sum, buffer: records, records: clusters });
        looks
    }
}
