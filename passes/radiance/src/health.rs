//! What a host may have counted of a frame, readable frames later.

use std::mem::offset_of;

use airglow_gpu::{BufferSlice, Counted, Look, Records};

use crate::gpu::RefineState;
use crate::receiver::Receiver;
use crate::stage::{Bindings, Prepared};

/// Counters of [`Prepared::looks`] and [`Lit::looks`](crate::Lit::looks), to be made by
/// [`Health::new`](airglow_gpu::Health::new): vertices whose light is not finite; receivers whose limit of samples kept
/// nodes from being split.
pub const HEALTH: [&str; 2] = ["radiance vertices not finite", "radiance limits hit"];

impl Prepared {
    /// What a [`Tally`](airglow_gpu::Tally) of [`HEALTH`] looks at after the frame, on the road without a graph: the
    /// barriers between are the host's. Nothing where the pass is left out. A host that makes no tally pays nothing.
    #[must_use]
    pub fn looks(&self, bindings: &Bindings) -> Vec<Look<BufferSlice>> {
        let Some(scene) = &self.scene else { return Vec::new() };
        let light = |part: u32| bindings.get(&part).cloned();
        looks(&scene.receiver, light, Some((&scene.receiver.samples.state).into()))
    }
}

/// Where the light of each part is, and the state of refinement.
pub(crate) fn looks<B>(
    receiver: &Receiver,
    light: impl Fn(u32) -> Option<B>,
    state: Option<B>,
) -> Vec<Look<B>> {
    let vertex = receiver.settings.light_bytes();
    let of_part = |(part, bytes): (u32, &u64)| {
        let records = Records::whole(bytes / vertex, (vertex / 4) as u32);
        Some(Look { counter: 0, counted: Counted::NotFinite, buffer: light(part)?, records })
    };
    let limited = Records {
        count: 1,
        stride: (size_of::<RefineState>() / 4) as u32,
        first: (offset_of!(RefineState, limited) / 4) as u32,
        words: 1,
    };
    let state = state.map(|buffer| Look { counter: 1, counted: Counted::Sum, buffer, records: limited });
    (0..).zip(&receiver.light_bytes).filter_map(of_part).chain(state).collect()
}
