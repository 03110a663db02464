//! Resources that remember one frame: two of each, which the host swaps from frame to frame.

use crate::access::State;
use crate::declaration::{Half, Resource};
use crate::graph::Graph;
use crate::handle::{Buffer, Handle, Image, Kind};
use crate::resource::{BufferDesc, ImageDesc, Origin, ResourceDesc};
use ash::vk::ImageLayout;

/// The two halves of a resource with history, declared once.
///
/// What a frame writes to `current` the next frame reads as `previous`. Both halves are the host's, found and
/// left in one resting state; [`Plan::histories`](crate::Plan::histories) says which to swap between executions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct History<T: Kind> {
    /// What the frame before wrote; passes only read it. Before the first frame the host fills it.
    pub previous: Handle<T>,
    /// What this frame writes, all of it; it starts without contents.
    pub current: Handle<T>,
}

impl<R> Graph<R> {
    /// A buffer that remembers one frame. `resting` is how it waits between frames: a state that reads, best the
    /// one in which `previous` is read. Usage is completed as for a transient.
    pub fn history_buffer(
        &mut self,
        name: &str,
        desc: BufferDesc,
        resting: impl Into<State>,
    ) -> History<Buffer> {
        let resting = State { layout: ImageLayout::UNDEFINED, ..resting.into() };
        self.history(name, ResourceDesc::Buffer(desc), resting)
    }

    /// An image that remembers one frame. See [`history_buffer`](Self::history_buffer).
    pub fn history_image(
        &mut self,
        name: &str,
        desc: ImageDesc,
        resting: impl Into<State>,
    ) -> History<Image> {
        self.history(name, ResourceDesc::Image(desc), resting.into())
    }

    fn history<T: Kind>(&mut self, name: &str, desc: ResourceDesc, resting: State) -> History<T> {
        let mut half = |half: Half, word: &str, entry: State| {
            let handle =
                self.add(&format!("{name} ({word})"), desc, Origin::Imported { entry, exit: resting });
            if let Some(resource) = self.declaration.resources.last_mut() {
                *resource = Resource { half: Some(half), ..resource.clone() };
            }
            handle
        };
        let previous = half(Half::Previous, "previous", resting);
        // The contents are two frames old: nobody may read them, but their last readers may still run.
        let emptied = State { layout: ImageLayout::UNDEFINED, ..resting };
        History { previous, current: half(Half::Current, "current", emptied) }
    }
}
