//! Adds the pass to a graph: the stages of a frame as passes, their resources as handles.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use airglow_gpu::{Context, Imports, Record};
use airglow_graph::{Buffer, Graph, Handle, Image, PassBuilder, ResourceDesc};

use crate::RelightError;
use crate::frame::{Frame, Light, Relit};
use crate::record::Bindings;
use crate::relight::Relight;
use crate::stage::{Need, Prepared, Resource, Stage};

/// A resource of the frame in the graph.
#[derive(Clone, Copy)]
enum Named {
    Buffer(Handle<Buffer>),
    Image(Handle<Image>),
}

/// The frame's inputs and outputs on the graph's road.
pub type GraphFrame = Frame<Handle<Buffer>, Handle<Image>>;

impl Relight {
    /// Adds the frame to a graph: uploads of new meshes, the projection of a changed environment, the rotation of the
    /// light, product matrices where there is visibility, and the kernel over the vertices. This room's own buffers are
    /// added to `imports`. The plan may be recorded again in later frames while meshes, light and sizes stay.
    ///
    /// # Errors
    /// As [`Relight::prepare`].
    pub fn add(
        &mut self,
        context: &Context,
        graph: &mut Graph<Record>,
        imports: &mut Imports,
        frame: &GraphFrame,
    ) -> Result<Relit<Handle<Buffer>>, RelightError> {
        let Prepared { stages, needs, left_out, ranges, rotations, shown } = self.prepare(context, frame)?;
        graph.pipelines("relight", self.pipeline_count);
        left_out.into_iter().for_each(|left_out| graph.leave_out(left_out));
        let mut named = BTreeMap::new();
        for (resource, need) in &needs {
            let name = resource.to_string();
            let handle = match need {
                Need::Ours { buffer, entry, exit } => {
                    let handle = graph.import_buffer(&name, *buffer.desc(), *entry, *exit);
                    imports.buffer(&handle, buffer);
                    Some(Named::Buffer(handle))
                }
                Need::Scratch(ResourceDesc::Buffer(desc)) => {
                    Some(Named::Buffer(graph.create_buffer(&name, *desc)))
                }
                Need::Scratch(ResourceDesc::Image(desc)) => {
                    Some(Named::Image(graph.create_image(&name, *desc)))
                }
                Need::Host => host_handle(frame, *resource),
            };
            named.extend(handle.map(|handle| (*resource, handle)));
        }
        for stage in stages {
            declare(graph, &mut named, stage);
        }
        let buffer = |resource| match named.get(&resource) {
            Some(Named::Buffer(handle)) => Some(*handle),
            _ => None,
        };
        Ok(Relit {
            results: buffer(Resource::Results),
            ranges,
            environment: buffer(Resource::EnvironmentLight),
            rotations,
            shown,
        })
    }
}

/// The handle the host gave for a resource.
fn host_handle(frame: &GraphFrame, resource: Resource) -> Option<Named> {
    let instance = |index: u32| frame.instances.get(index as usize);
    match (resource, &frame.light) {
        (Resource::Environment, Light::Environment(environment)) => Some(Named::Image(environment.image)),
        (Resource::UniformLight, Light::Uniform { coefficients, .. }) => Some(Named::Buffer(*coefficients)),
        (Resource::VertexLight(index), _) => instance(index)?.light.map(Named::Buffer),
        (Resource::Visibility(index), _) => instance(index)?.visibility.map(Named::Buffer),
        (Resource::Normals(index), _) => instance(index)?.normals.map(Named::Buffer),
        (Resource::Results, _) => frame.target.map(Named::Buffer),
        _ => None,
    }
}

/// One stage as a pass: its uses, in order, and its recording.
fn declare(graph: &mut Graph<Record>, named: &mut BTreeMap<Resource, Named>, stage: Stage) {
    let mut pass = graph.pass(stage.name, stage.kind);
    let mut used = Vec::with_capacity(stage.uses.len());
    for entry in &stage.uses {
        let Some(name) = named.get_mut(&entry.resource) else { continue };
        match name {
            Named::Buffer(handle) => *handle = touch(&mut pass, *handle, entry.access),
            Named::Image(handle) => *handle = touch(&mut pass, *handle, entry.access),
        }
        used.push((entry.resource, *name));
    }
    // Kept from frame to frame, so that a frame puts what it binds in places that are there.
    let kept = Mutex::new(Bindings::default());
    pass.record(Box::new(move |recorder, resources| {
        let mut bindings = kept.lock().unwrap_or_else(PoisonError::into_inner);
        for (resource, name) in &used {
            match name {
                Named::Buffer(handle) => {
                    bindings.buffers.insert(*resource, resources.buffer(handle)?.into());
                }
                Named::Image(handle) => {
                    bindings.images.insert(*resource, resources.view(&handle.mip(0))?);
                }
            }
        }
        stage.record(recorder, &bindings)
    }));
}

/// Reads or writes a handle; returns the version that follows.
fn touch<T: airglow_graph::Kind>(
    pass: &mut PassBuilder<'_, Record>,
    handle: Handle<T>,
    access: airglow_graph::Access,
) -> Handle<T> {
    if access.writes() {
        return pass.write(handle, access);
    }
    pass.read(&handle, access);
    handle
}
