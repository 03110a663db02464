//! Declaring a pass by what it uses.

use crate::access::Access;
use crate::declaration::Version;
use crate::graph::{Graph, unique};
use crate::handle::{Buffer, Handle, Image, Kind};
use crate::pass::{Pass, PassKind, Use};
use crate::resource::{BufferDesc, ImageDesc};

impl<R> Graph<R> {
    /// Declares a pass; say what it uses on the builder this returns, and give it its payload there.
    pub fn pass(&mut self, name: &str, kind: PassKind) -> PassBuilder<'_, R> {
        let name = unique(name, self.declaration.passes.iter().map(|pass| &pass.name));
        self.declaration.passes.push(Pass::new(name, kind));
        self.payloads.push(None);
        PassBuilder::new(self)
    }
}

/// Says what a pass uses. Nothing is checked here; [`Graph::compile`] checks it all.
#[derive(Debug)]
pub struct PassBuilder<'g, R> {
    graph: &'g mut Graph<R>,
    index: usize,
}

impl<'g, R> PassBuilder<'g, R> {
    /// Builds the pass declared last.
    pub(crate) fn new(graph: &'g mut Graph<R>) -> Self {
        let index = graph.declaration.passes.len().saturating_sub(1);
        Self { graph, index }
    }

    fn pass(&mut self) -> &mut Pass {
        &mut self.graph.declaration.passes[self.index]
    }

    /// Reads the version `handle` names.
    pub fn read<T: Kind>(&mut self, handle: &Handle<T>, access: Access) -> &mut Self {
        self.add(*handle, access, true, None);
        self
    }

    /// Writes all of what `handle` names and returns its next version. What was there is lost, unless
    /// `access` reads it too ([`Access::keeps_contents`]); to write only a part and keep the rest, use
    /// [`update`](Self::update).
    pub fn write<T: Kind>(&mut self, handle: Handle<T>, access: Access) -> Handle<T> {
        self.write_version(handle, access, access.keeps_contents())
    }

    /// Writes some of what `handle` names, keeps the rest, and returns the next version.
    pub fn update<T: Kind>(&mut self, handle: Handle<T>, access: Access) -> Handle<T> {
        self.write_version(handle, access, true)
    }

    /// A new transient buffer that this pass writes.
    pub fn create_buffer(&mut self, name: &str, desc: BufferDesc, access: Access) -> Handle<Buffer> {
        let handle = self.graph.create_buffer(name, desc);
        self.write(handle, access)
    }

    /// A new transient image that this pass writes.
    pub fn create_image(&mut self, name: &str, desc: ImageDesc, access: Access) -> Handle<Image> {
        let handle = self.graph.create_image(name, desc);
        self.write(handle, access)
    }

    /// The pass does something the graph cannot see: it is never culled.
    pub fn side_effect(&mut self) -> &mut Self {
        self.pass().side_effect = true;
        self
    }

    /// The pass may run on an asynchronous queue; the host chooses. Only recorded in the plan.
    pub fn async_suitable(&mut self) -> &mut Self {
        self.pass().async_suitable = true;
        self
    }

    /// Gives the pass what its recorder needs. A pass without a payload does not compile.
    pub fn record(&mut self, payload: R) {
        self.graph.payloads[self.index] = Some(payload);
    }

    fn write_version<T: Kind>(&mut self, handle: Handle<T>, access: Access, keeps: bool) -> Handle<T> {
        let version = Version { parent: handle.version, writer: self.index };
        // A handle of another graph may name no resource here; validation reports it.
        let output = match self.graph.declaration.resources.get_mut(handle.resource.index()) {
            Some(resource) => {
                resource.versions.push(version);
                u32::try_from(resource.versions.len()).unwrap_or(u32::MAX)
            }
            None => handle.version.saturating_add(1),
        };
        self.add(handle, access, keeps, Some(output));
        Handle { version: output, ..handle }
    }

    fn add<T: Kind>(&mut self, handle: Handle<T>, access: Access, keeps: bool, output: Option<u32>) {
        let is_image = std::any::TypeId::of::<T>() == std::any::TypeId::of::<Image>();
        let Handle { resource, version, range, .. } = handle;
        self.pass().uses.push(Use { resource, version, output, range, access, keeps, is_image });
    }
}
