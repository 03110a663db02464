//! The graph: what a frame is declared to.

use crate::access::State;
use crate::compile;
use crate::declaration::{Declaration, Export, Half, LeftOut, Resource, RoomPipelines};
use crate::error::GraphError;
use crate::extent::RelativeExtent;
use crate::handle::{Buffer, Handle, Image, ImageRange, Kind, ResourceId};
use crate::options::{Limits, Options};
use crate::plan::Plan;
use crate::resource::{BufferDesc, ImageDesc, Origin, ResourceDesc};
use ash::vk;

/// `name`, or `name#2`, `name#3` … where it is taken: messages and printed plans stay unambiguous when one pass
/// is added for several meshes.
pub(crate) fn unique<'a>(name: &str, taken: impl Iterator<Item = &'a String> + Clone) -> String {
    let free = |candidate: &str| taken.clone().all(|other| other != candidate);
    let numbered = (2..).map(|n: u64| format!("{name}#{n}"));
    std::iter::once(name.to_owned()).chain(numbered).find(|name| free(name)).unwrap_or_default()
}

/// A frame, declared by use. `R` is what each pass carries for whoever records it.
///
/// Nothing is checked while declaring; [`compile`](Self::compile) reports the first thing wrong, in a fixed order.
#[derive(Clone, Debug)]
pub struct Graph<R> {
    pub(crate) declaration: Declaration,
    pub(crate) payloads: Vec<Option<R>>,
}

impl<R> Default for Graph<R> {
    fn default() -> Self {
        Self::new()
    }
}

impl<R> Graph<R> {
    /// An empty frame.
    pub fn new() -> Self {
        Self { declaration: Declaration::default(), payloads: Vec::new() }
    }

    /// Brings in the host's buffer. What passes write to an import is kept, as if exported in state `exit`.
    pub fn import_buffer(
        &mut self,
        name: &str,
        desc: BufferDesc,
        entry: impl Into<State>,
        exit: impl Into<State>,
    ) -> Handle<Buffer> {
        let layout = vk::ImageLayout::UNDEFINED;
        let [entry, exit] = [entry.into(), exit.into()].map(|state| State { layout, ..state });
        self.add(name, ResourceDesc::Buffer(desc), Origin::Imported { entry, exit })
    }

    /// Brings in the host's image. What passes write to an import is kept, as if exported in state `exit`.
    /// An exit layout of `UNDEFINED` means the layout of the last use is left.
    pub fn import_image(
        &mut self,
        name: &str,
        desc: ImageDesc,
        entry: impl Into<State>,
        exit: impl Into<State>,
    ) -> Handle<Image> {
        let origin = Origin::Imported { entry: entry.into(), exit: exit.into() };
        self.add(name, ResourceDesc::Image(desc), origin)
    }

    /// A buffer that lives within the plan.
    pub fn create_buffer(&mut self, name: &str, desc: BufferDesc) -> Handle<Buffer> {
        self.add(name, ResourceDesc::Buffer(desc), Origin::Transient)
    }

    /// An image that lives within the plan.
    pub fn create_image(&mut self, name: &str, desc: ImageDesc) -> Handle<Image> {
        self.add(name, ResourceDesc::Image(desc), Origin::Transient)
    }

    pub(crate) fn add<T: Kind>(&mut self, name: &str, desc: ResourceDesc, origin: Origin) -> Handle<T> {
        let resource = ResourceId(u32::try_from(self.declaration.resources.len()).unwrap_or(u32::MAX));
        let name = unique(name, self.declaration.resources.iter().map(|resource| &resource.name));
        self.declaration.resources.push(Resource {
            name,
            desc,
            origin,
            half: None,
            relative: None,
            versions: Vec::new(),
        });
        Handle::new(resource, 0, ImageRange::WHOLE)
    }

    /// Makes width and height of a transient image or of a half of a history follow `extent`; what its
    /// description says of them is replaced, its depth stays. Both halves of a history follow.
    pub fn size_relative(&mut self, image: &Handle<Image>, extent: RelativeExtent) {
        // A handle of another graph may name no resource here; validation reports its uses.
        let index = image.resource().index();
        let resources = &mut self.declaration.resources;
        let halves = match resources.get(index).and_then(|resource| resource.half) {
            Some(Half::Previous) => index..index + 2,
            Some(Half::Current) => index - 1..index + 1,
            None => index..index + 1,
        };
        for resource in resources.get_mut(halves).into_iter().flatten() {
            resource.relative = Some(extent);
        }
    }

    /// Keeps a version alive past the plan and leaves it in `state`. For an import this replaces the exit
    /// state of the part the handle names.
    pub fn export<T: Kind>(&mut self, handle: Handle<T>, state: impl Into<State>) {
        let is_image = std::any::TypeId::of::<T>() == std::any::TypeId::of::<Image>();
        let mut state = state.into();
        if !is_image {
            state.layout = vk::ImageLayout::UNDEFINED;
        }
        let Handle { resource, version, range, .. } = handle;
        self.declaration.exports.push(Export { resource, version, range, state, is_image });
    }

    /// Records that something is not in this frame.
    pub fn leave_out(&mut self, left_out: LeftOut) {
        self.declaration.left_out.push(left_out);
    }

    /// Records how many pipelines a room holds ready; what is said for one room adds up.
    pub fn pipelines(&mut self, room: &str, prepared: usize) {
        match self.declaration.pipelines.iter_mut().find(|pipelines| pipelines.room == room) {
            Some(pipelines) => pipelines.prepared += prepared,
            None => self.declaration.pipelines.push(RoomPipelines { room: room.to_owned(), prepared }),
        }
    }

    /// Leaves out a pass that would have made the next version of `input`: records it, and returns `input`
    /// itself, so that what follows reads it without a copy.
    pub fn forward<T: Kind>(&mut self, input: Handle<T>, left_out: LeftOut) -> Handle<T> {
        self.leave_out(left_out);
        input
    }

    /// Turns the declaration into a plan: the same declaration always gives the same plan, byte for byte.
    pub fn compile(self, limits: &Limits) -> Result<Plan<R>, GraphError> {
        self.compile_with(limits, &Options::default())
    }

    /// [`compile`](Self::compile) with choices.
    pub fn compile_with(self, limits: &Limits, options: &Options) -> Result<Plan<R>, GraphError> {
        compile::compile(self.declaration, self.payloads, limits, options)
    }
}
