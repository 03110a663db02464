//! The conformance kit: plays a host around a room on a device that is given, with images and buffers of its own, and
//! commands of its own before and after. The room is recorded by both roads.
//!
//! It checks bits, layouts, command-buffer state, and that nothing stays alive, and returns what is wrong as an error. What
//! validation says is for whoever made the device to hear.

mod changes;
mod declared;
mod device;
mod elsewhere;
mod faults;
mod host;
mod orders;
pub mod plan;
mod prepared;
mod roads;
pub mod shim;
mod staged;

use crate::shim::{ACTIONS, Call, STATE};
use airglow_gpu::ash::vk;
use airglow_gpu::{Buffer, Context, Image, Options, Recorder, Requirements};
use airglow_graph::{Access, BufferDesc, ImageDesc, State};
use host::Host;
use std::error::Error;

pub use changes::{Make, change_on};
pub use declared::{Declared, Named, copy_mips};
pub use device::HostDevice;
pub use elsewhere::Elsewhere;
pub use faults::fail_on;
pub use orders::shuffle_on;
pub use prepared::{MakePrepared, prepare_on};
pub use staged::stage_on;

/// What a room says when it refuses, or the kit of what it found.
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

impl HostResource {
    /// An image with its texels, tightly packed.
    pub fn image(name: &'static str, desc: ImageDesc, texels: Vec<u8>, [entry, exit]: [Access; 2]) -> Self {
        let desc = ImageDesc { usage: desc.usage | vk::ImageUsageFlags::TRANSFER_DST, ..desc };
        let content = Content::Image(desc, texels);
        Self { name, content, entry: entry.into(), exit: exit.into() }
    }

    /// A buffer with its contents.
    pub fn buffer(
        name: &'static str,
        bytes: Vec<u8>,
        usage: vk::BufferUsageFlags,
        [entry, exit]: [Access; 2],
    ) -> Self {
        let copied = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
        let desc = BufferDesc { size: bytes.len() as u64, usage: usage | copied };
        Self { name, content: Content::Buffer(desc, bytes), entry: entry.into(), exit: exit.into() }
    }

    /// A buffer of `size` bytes, each 0xff, which the kit hands back.
    pub fn results(name: &'static str, size: u64, usage: vk::BufferUsageFlags, ends: [Access; 2]) -> Self {
        Self::buffer(name, vec![0xff; size as usize], usage, ends)
    }
}

/// A host's resource on the device.
#[derive(Clone)]
pub enum Given {
    /// A buffer.
    Buffer(Buffer),
    /// An image.
    Image(Image),
}

impl Given {
    /// The buffer that it is.
    ///
    /// # Errors
    /// It is an image.
    pub fn buffer(&self) -> Result<&Buffer, Refusal> {
        match self {
            Self::Buffer(buffer) => Ok(buffer),
            Self::Image(image) => Err(format!("{} is no buffer", image.name()).into()),
        }
    }

    /// The image that it is.
    ///
    /// # Errors
    /// It is a buffer.
    pub fn image(&self) -> Result<&Image, Refusal> {
        match self {
            Self::Image(image) => Ok(image),
            Self::Buffer(buffer) => Err(format!("{} is no image", buffer.name()).into()),
        }
    }
}

/// A room as its host sees it. Lists of resources are all in the order of [`Room::resources`].
pub trait Room {
    /// What it needs of the device.
    fn requirements(&self) -> Requirements;

    /// The host's resources that it uses.
    fn resources(&self) -> Vec<HostResource>;

    /// Adds it to a graph.
    ///
    /// # Errors
    /// Whatever the room refuses.
    fn add(&mut self, to: &mut Declared<'_>) -> Result<(), Refusal>;

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

/// Bytes that the host's buffers hold after the room, and its images that can be copied from, in order.
pub type Outputs = Vec<Vec<u8>>;

/// Runs a room made by `make` on the host's device by both roads, checks what a host relies on, and returns the
/// [`Outputs`]. The device is idle afterwards; after an error, objects of it may be left.
///
/// # Safety
/// `host` states a live device truly; no one else uses its queue meanwhile.
///
/// # Errors
/// What the room or the device refuses, how the roads differ, layouts or state that are not as promised, what stays alive.
pub unsafe fn conform_on<R: Room>(
    host: &HostDevice<'_>,
    requirements: &Requirements,
    options: &Options,
    make: impl Fn(&Context, &HostDevice<'_>) -> Result<R, Refusal>,
) -> Result<Outputs, Refusal> {
    let requirements = Requirements::engine().and(requirements);
    let run = |road| -> Result<Outputs, Refusal> {
        // SAFETY: the caller's promise is ours.
        let host = unsafe { Host::new(host)? };
        let (outputs, calls) = host.run(&make, &requirements, options, road)?;
        check_state(&calls, road)?;
        Ok(outputs)
    };
    let (by_graph, by_record) = (run(Road::Graph)?, run(Road::Record)?);
    for (index, (by_graph, by_record)) in by_graph.iter().zip(&by_record).enumerate() {
        if let Some(byte) = by_graph.iter().zip(by_record).position(|(a, b)| a != b) {
            return Err(format!("resource {index}: the roads differ from byte {byte} on").into());
        }
    }
    let sizes = |outputs: &Outputs| outputs.iter().map(Vec::len).collect::<Vec<_>>();
    match sizes(&by_graph) == sizes(&by_record) {
        true => Ok(by_graph),
        false => Err("the roads give resources of other sizes".into()),
    }
}

/// Only documented commands, each scope closed again.
fn check_state(calls: &[Call], road: Road) -> Result<(), Refusal> {
    let wrong = |what: String| Err(format!("{road:?}: {what}").into());
    if calls.is_empty() {
        return wrong("nothing was recorded".to_owned());
    }
    for call in calls {
        if !STATE.contains(&call.name) && !ACTIONS.contains(&call.name) {
            return wrong(format!("{} is in neither list", call.name));
        }
        if call.name == "vkCmdBindDescriptorSets" && call.numbers.get(1..) != Some(&[0, 1]) {
            return wrong(format!("it binds other descriptor sets than 0: {:?}", call.numbers));
        }
    }
    for [begin, end] in [
        ["vkCmdBeginRendering", "vkCmdEndRendering"],
        ["vkCmdBeginDebugUtilsLabelEXT", "vkCmdEndDebugUtilsLabelEXT"],
    ] {
        let count = |name| calls.iter().filter(|call| call.name == name).count();
        if count(begin) != count(end) {
            return wrong(format!("{begin} without {end}"));
        }
    }
    Ok(())
}

/// Each image is left in the layout that was promised.
fn check_layouts(calls: &[Call], resources: &[HostResource], given: &[Given]) -> Result<(), Refusal> {
    for (resource, given) in resources.iter().zip(given) {
        let Given::Image(image) = given else { continue };
        let layout = layout_after(calls, image.raw(), resource.entry.layout)?;
        if layout != resource.exit.layout {
            let (name, promised) = (resource.name, resource.exit.layout);
            return Err(format!("{name}: {layout:?} on exit, {promised:?} promised").into());
        }
    }
    Ok(())
}

/// The layout that the commands leave `image` in, or `entry` if no barrier names it.
fn layout_after(
    calls: &[Call],
    image: vk::Image,
    entry: vk::ImageLayout,
) -> Result<vk::ImageLayout, Refusal> {
    let mut barriers = calls.iter().flat_map(|call| &call.images).filter(|barrier| barrier.image == image);
    barriers.try_fold(entry, |before, barrier| {
        match barrier.old_layout == before || barrier.old_layout == vk::ImageLayout::UNDEFINED {
            true => Ok(barrier.new_layout),
            false => {
                let expected = barrier.old_layout;
                Err(format!("a barrier expects {expected:?}, the image is in {before:?}").into())
            }
        }
    })
}
