//! Resources that remember one frame: two of each, which the host swaps from frame to frame.

use crate::access::State;
use crate::graph::{Graph, Resource};
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

/// Which half of a history a resource is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Half {
    Previous,
    Current,
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

/// The halves change places from frame to frame: each needs the usage of both.
pub(crate) fn share_usage(resources: &mut [Resource]) {
    for i in 1..resources.len() {
        let (before, rest) = resources.split_at_mut(i);
        let (Some(previous), Some(current)) = (before.last_mut(), rest.first_mut()) else { continue };
        if current.half != Some(Half::Current) {
            continue;
        }
        match (&mut previous.desc, &mut current.desc) {
            (ResourceDesc::Buffer(previous), ResourceDesc::Buffer(current)) => {
                previous.usage |= current.usage;
                current.usage = previous.usage;
            }
            (ResourceDesc::Image(previous), ResourceDesc::Image(current)) => {
                previous.usage |= current.usage;
                current.usage = previous.usage;
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Access, Limits, PassKind};
    use ash::vk::BufferUsageFlags;

    #[test]
    fn halves_that_change_places_have_one_usage() {
        let mut graph = Graph::<()>::new();
        let history = graph.history_buffer("history", BufferDesc::new(16), Access::ComputeStorageRead);
        let mut pass = graph.pass("pass", PassKind::Transfer);
        pass.read(&history.previous, Access::TransferSource);
        pass.write(history.current, Access::TransferDestination);
        pass.record(());
        let plan = graph.compile(&Limits::default()).unwrap();
        for resource in plan.resources() {
            let ResourceDesc::Buffer(desc) = resource.desc else { panic!("a buffer") };
            assert_eq!(desc.usage, BufferUsageFlags::TRANSFER_SRC | BufferUsageFlags::TRANSFER_DST);
        }
    }
}
