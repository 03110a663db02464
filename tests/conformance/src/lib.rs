//! The conformance kit: plays a host around a room on a device that is given, with images and buffers of its own, and
//! commands of its own before and after. The room is recorded by both roads.
//!
//! It asserts bits, layouts, command-buffer state, and that nothing stays alive, by panics that say what is wrong. What
//! validation says is for whoever made the device to hear.
#![expect(clippy::panic, reason = "a kit of tests fails the test it is called from")]

mod host;
pub mod plan;
mod roads;
pub mod shim;

use crate::shim::{ACTIONS, Call, STATE};
use airglow_gpu::ash::vk;
use airglow_gpu::{Buffer, Context, Image, Imports, Options, Record, Recorder, Requirements};
use airglow_graph as graph;
use airglow_graph::{Access, BufferDesc, Graph, Handle, ImageDesc, State};
use host::Host;
use std::error::Error;

pub use host::HostDevice;

/// What a room says when it refuses.
pub type Refusal = Box<dyn Error>;

/// What a host's resource is, and what it holds before the room.
#[derive(Clone, Debug)]
pub enum Content {
    /// An image and its texels, tightly packed.
    Image(ImageDesc, Vec<u8>),
    /// A buffer and its first bytes.
    Buffer(BufferDesc, Vec<u8>),
}

/// A resource of the host that a room uses.
#[derive(Clone, Debug)]
pub struct HostResource {
    /// Its name.
    pub name: &'static str,
    /// What it is.
    pub content: Content,
    /// The state in which the host hands it over.
    pub entry: State,
    /// The state in which the host wants it back.
    pub exit: State,
}

/// A host's resource in a graph.
#[derive(Clone, Copy)]
pub enum Named {
    /// A buffer.
    Buffer(Handle<graph::Buffer>),
    /// An image.
    Image(Handle<graph::Image>),
}

/// A host's resource on the device.
#[derive(Clone)]
pub enum Given {
    /// A buffer.
    Buffer(Buffer),
    /// An image.
    Image(Image),
}

/// A room as its host sees it. Lists of resources are all in the order of [`Room::resources`].
pub trait Room {
    /// What it needs of the device.
    fn requirements(&self) -> Requirements;

    /// The host's resources that it uses.
    fn resources(&self) -> Vec<HostResource>;

    /// Adds it to a graph; resources of its own go to `imports`.
    ///
    /// # Errors
    /// Whatever the room refuses.
    fn add(
        &mut self,
        context: &Context,
        graph: &mut Graph<Record>,
        imports: &mut Imports,
        host: &[Named],
    ) -> Result<(), Refusal>;

    /// Prepares the road without a graph: for each resource the first and the last access, none for what it leaves
    /// alone.
    ///
    /// # Errors
    /// Whatever the room refuses.
    fn accesses(&mut self, context: &Context) -> Result<Vec<Option<(Access, Access)>>, Refusal>;

    /// Records what [`Room::accesses`] prepared, with barriers between its own steps alone.
    ///
    /// # Errors
    /// Whatever the room refuses.
    fn record(&mut self, recorder: &mut Recorder<'_>, host: &[Given]) -> Result<(), Refusal>;
}

/// How a room is recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Road {
    /// By the plan of our graph.
    Graph,
    /// By `accesses` and `record`, within the host's own frame graph.
    Record,
}

/// Bytes that the host's buffers hold after the room, in order; images are skipped.
pub type Outputs = Vec<Vec<u8>>;

/// Runs a room made by `make` on the host's device by both roads, asserts what a host relies on, and returns the bytes of
/// its buffers. The device is idle afterwards.
///
/// # Safety
/// `host` states a live device truly; no one else uses its queue meanwhile.
///
/// # Panics
/// If the room refuses, the roads differ, layouts or state are not as promised, or something stays alive.
pub unsafe fn conform_on<R: Room>(
    host: &HostDevice<'_>,
    requirements: &Requirements,
    options: &Options,
    make: impl Fn(&Context, &HostDevice<'_>) -> R,
) -> Outputs {
    let requirements = Requirements::engine().and(requirements);
    let [by_graph, by_record] = [Road::Graph, Road::Record].map(|road| {
        // SAFETY: the caller's promise is ours.
        let (outputs, calls) = unsafe { Host::new(host) }.run(&make, &requirements, options, road);
        assert_state(&calls, road);
        outputs
    });
    assert_eq!(by_graph.len(), by_record.len());
    for (index, (by_graph, by_record)) in by_graph.iter().zip(&by_record).enumerate() {
        let differs = by_graph.iter().zip(by_record).position(|(a, b)| a != b);
        assert_eq!(differs, None, "buffer {index}: the roads differ from that byte on");
        assert_eq!(by_graph.len(), by_record.len());
    }
    by_graph
}

/// Only documented commands, each scope closed again.
fn assert_state(calls: &[Call], road: Road) {
    assert!(!calls.is_empty(), "{road:?}: nothing was recorded");
    for call in calls {
        let known = STATE.contains(&call.name) || ACTIONS.contains(&call.name);
        assert!(known, "{road:?}: {} is in neither list", call.name);
        if call.name == "vkCmdBindDescriptorSets" {
            assert_eq!(call.numbers[1..], [0, 1], "{road:?}: set 0 alone");
        }
    }
    for [begin, end] in [
        ["vkCmdBeginRendering", "vkCmdEndRendering"],
        ["vkCmdBeginDebugUtilsLabelEXT", "vkCmdEndDebugUtilsLabelEXT"],
    ] {
        let count = |name| calls.iter().filter(|call| call.name == name).count();
        assert_eq!(count(begin), count(end), "{road:?}: {begin} without {end}");
    }
}

/// The layout that the commands leave `image` in, or `entry` if no barrier names it.
fn layout_after(calls: &[Call], image: vk::Image, entry: vk::ImageLayout) -> vk::ImageLayout {
    let barriers = calls.iter().flat_map(|call| &call.images).filter(|barrier| barrier.image == image);
    barriers.fold(entry, |before, barrier| {
        let matches = barrier.old_layout == before || barrier.old_layout == vk::ImageLayout::UNDEFINED;
        assert!(matches, "a barrier expects {:?}, the image is in {before:?}", barrier.old_layout);
        barrier.new_layout
    })
}
