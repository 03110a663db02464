//! Adds the pass to a graph. No Vulkan call is made here, so that it is tested without a device.

use airglow_gpu::Record;
use airglow_graph::{Access, Buffer, BufferDesc, Graph, Handle, LeftOut, PassKind};

use crate::record::COLOUR_BYTES;
use crate::{Bindings, Settings, __Room__};

/// What the pass does with its resources, in the order of [`Bindings`]: for a host with a frame graph of its own.
pub const ACCESSES: [(&str, Access); 2] =
    [("colours", Access::ComputeStorageRead), ("exposed", Access::ComputeStorageWrite)];

/// Declares the pass over `count` colours; `payload` makes what it carries from the handles of [`ACCESSES`].
///
/// Returns the exposed colours; with 0 stops or no colours the pass is left out, and `colours` is returned.
pub fn declare<R>(
    graph: &mut Graph<R>,
    settings: &Settings,
    colours: Handle<Buffer>,
    count: u32,
    payload: impl FnOnce(Handle<Buffer>, Handle<Buffer>) -> R,
) -> Handle<Buffer> {
    let size = COLOUR_BYTES * u64::from(count);
    let left_out = |why: &str, would_return: &str| LeftOut {
        what: "__room__".to_owned(),
        why: why.to_owned(),
        bytes: size,
        time: None,
        would_return: would_return.to_owned(),
    };
    if count == 0 {
        return graph.forward(colours, left_out("there are no colours", "a colour"));
    }
    if settings.stops == 0.0 {
        return graph.forward(colours, left_out("0 stops change nothing", "another exposure"));
    }
    let [(_, reads), (name, writes)] = ACCESSES;
    let mut pass = graph.pass("__room__", PassKind::Compute);
    pass.read(&colours, reads);
    let exposed = pass.create_buffer(&format!("__room__ {name}"), BufferDesc::new(size), writes);
    pass.record(payload(colours, exposed));
    exposed
}

impl __Room__ {
    /// Adds the pass over the first `count` colours of a buffer to a graph; see [`declare()`].
    pub fn add(&self, graph: &mut Graph<Record>, colours: Handle<Buffer>, count: u32) -> Handle<Buffer> {
        let pass = self.clone();
        declare(graph, self.settings(), colours, count, |colours, exposed| {
            Box::new(move |recorder, resources| {
                let colours = resources.buffer(&colours)?.into();
                let exposed = resources.buffer(&exposed)?.into();
                pass.record(recorder, &Bindings { colours, exposed }, count)
            })
        })
    }
}
