//! The declaration: resources, passes, exports, and what was left out.

use crate::access::State;
use crate::compile;
use crate::error::GraphError;
use crate::extent::RelativeExtent;
use crate::handle::{Buffer, Handle, Image, ImageRange, Kind, ResourceId};
use crate::history::Half;
use crate::options::{Limits, Options};
use crate::pass::{Pass, PassBuilder, PassKind};
use crate::plan::Plan;
use crate::resource::{BufferDesc, ImageDesc, Origin, ResourceDesc};
use ash::vk;

/// Something a frame does without, for `plan` to print.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct LeftOut {
    /// What was left out: a pass, a table, an input.
    pub what: String,
    /// Why.
    pub why: String,
    /// Device memory this saved, in bytes.
    pub bytes: u64,
    /// Time this saved per frame, in seconds, where it has been measured.
    pub time: Option<f64>,
    /// What would bring it back.
    pub would_return: String,
}

/// The pipelines that a room holds ready, for `plan` to print.
#[derive(Clone, Debug, PartialEq, Eq, Hash, serde::Serialize)]
pub struct RoomPipelines {
    /// The room.
    pub room: String,
    /// Permutations prepared for it, used in this frame or not.
    pub prepared: usize,
}

/// A resource as declared.
#[derive(Clone, Debug, Hash)]
pub(crate) struct Resource {
    pub name: String,
    pub desc: ResourceDesc,
    pub origin: Origin,
    /// Which half of a history it is, if one.
    pub half: Option<Half>,
    /// What width and height follow, if anything.
    pub relative: Option<RelativeExtent>,
    /// Version `i + 1` at index `i`; version 0 is what the resource held before.
    pub versions: Vec<Version>,
}

/// One write in the life of a resource.
#[derive(Clone, Copy, Debug, Hash)]
pub(crate) struct Version {
    /// The version it was written over.
    pub parent: u32,
    /// The pass that wrote it, by index of declaration.
    pub writer: usize,
}

/// A version that outlives the plan.
#[derive(Clone, Copy, Debug, Hash)]
pub(crate) struct Export {
    pub resource: ResourceId,
    pub version: u32,
    pub range: ImageRange,
    pub state: State,
    pub is_image: bool,
}

/// Everything declared, without the payloads: what the compile phases work on.
#[derive(Clone, Debug, Default, Hash)]
pub(crate) struct Declaration {
    pub resources: Vec<Resource>,
    pub passes: Vec<Pass>,
    pub exports: Vec<Export>,
    pub left_out: Vec<LeftOut>,
    pub pipelines: Vec<RoomPipelines>,
}

/// `name`, or `name#2`, `name#3` … where it is taken: messages and printed plans stay unambiguous when one pass
/// is added for several meshes.
fn unique<'a>(name: &str, taken: impl Iterator<Item = &'a String> + Clone) -> String {
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

    /// Declares a pass; say what it uses on the builder this returns, and give it its payload there.
    pub fn pass(&mut self, name: &str, kind: PassKind) -> PassBuilder<'_, R> {
        let name = unique(name, self.declaration.passes.iter().map(|pass| &pass.name));
        self.declaration.passes.push(Pass::new(name, kind));
        self.payloads.push(None);
        PassBuilder::new(self)
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
        compile::compile(self, limits, options)
    }
}
