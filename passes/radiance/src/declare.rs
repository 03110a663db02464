//! Adds the pass to a graph: the stages of a frame as passes, their resources as handles.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use airglow_gpu::{Imports, Look, Record};
use airglow_graph::{Buffer, BufferDesc, Graph, Handle};

use crate::RadianceError;
use crate::control::Control;
use crate::health::looks;
use crate::lights::Lights;
use crate::radiance::Radiance;
use crate::receiver::Receiver;
use crate::resource::Resource;
use crate::stage::{Bindings, Prepared, Scene, Stage};

/// What the pass hands on.
#[derive(Clone, Debug)]
pub struct Lit {
    /// The light of each part's vertices, `[[f32; 3]; order^2]` a vertex; empty when the pass was left out.
    pub light: Vec<Handle<Buffer>>,
    /// What a [`Tally`](airglow_gpu::Tally) of [`HEALTH`](crate::HEALTH) looks at; empty when the pass was left out.
    pub looks: Vec<Look<Handle<Buffer>>>,
    /// Changes the lights before the plan is recorded again; `None` when the pass was left out.
    pub control: Option<Control>,
}

impl Radiance {
    /// Adds the pass to a graph: copies of a new receiver, samples, the light of its vertices. This room's own buffers are
    /// added to `imports`. The plan may be recorded again in later frames; [`Lit::control`] changes the lights in between.
    ///
    /// # Errors
    /// As [`Radiance::prepare`].
    pub fn add(
        &self,
        graph: &mut Graph<Record>,
        imports: &mut Imports,
        receiver: &Receiver,
        lights: &Lights<'_>,
    ) -> Result<Lit, RadianceError> {
        let Prepared { stages, ours, light_bytes, left_out, control, scene } =
            self.prepare(receiver, lights)?;
        graph.pipelines("radiance", self.pipeline_count());
        left_out.into_iter().for_each(|left_out| graph.leave_out(left_out));
        let Some(scene) = scene else { return Ok(Lit { light: Vec::new(), looks: Vec::new(), control }) };
        let mut named = BTreeMap::new();
        for (resource, buffer, state) in ours {
            let handle = graph.import_buffer(&resource.to_string(), *buffer.desc(), state, state);
            imports.buffer(&handle, &buffer);
            named.insert(resource, handle);
        }
        for (bytes, part) in light_bytes.iter().zip(0..) {
            let resource = Resource::VertexLight(part);
            named.insert(resource, graph.create_buffer(&resource.to_string(), BufferDesc::new(*bytes)));
        }
        for stage in stages {
            declare(graph, &mut named, &scene, stage);
        }
        let light = |part: u32| named.get(&Resource::VertexLight(part)).copied();
        let looks = looks(receiver, light, named.get(&Resource::State).copied());
        Ok(Lit { light: (0..light_bytes.len() as u32).filter_map(light).collect(), looks, control })
    }
}

/// One stage as a pass: its uses, in order, and its recording.
fn declare(
    graph: &mut Graph<Record>,
    named: &mut BTreeMap<Resource, Handle<Buffer>>,
    scene: &Scene,
    stage: Stage,
) {
    let mut pass = graph.pass(stage.name, stage.kind);
    let mut lights = Vec::new();
    for (resource, access) in &stage.uses {
        let Some(handle) = named.get_mut(resource) else { continue };
        match access.writes() {
            true => *handle = pass.write(*handle, *access),
            false => {
                pass.read(handle, *access);
            }
        }
        if let Resource::VertexLight(part) = resource {
            lights.push((*part, *handle));
        }
    }
    // Kept from frame to frame, so that a frame puts what it binds in places that are there.
    let (scene, kept) = (scene.clone(), Mutex::new(Bindings::new()));
    pass.record(Box::new(move |recorder, resources| {
        let mut bindings = kept.lock().unwrap_or_else(PoisonError::into_inner);
        for (part, handle) in &lights {
            bindings.insert(*part, resources.buffer(handle)?.into());
        }
        scene.record(recorder, stage.work, &bindings)
    }));
}
