//! Adds steps of a build to a graph.

use std::collections::BTreeMap;

use airglow_gpu::ash::vk::ImageLayout;
use airglow_gpu::{Imports, Record};
use airglow_graph::{Access, Buffer, Graph, Handle, Image, PassKind, State};

use crate::build::Build;
use crate::stage::{Resource, Stage};

#[derive(Clone, Copy)]
enum Named {
    Buffer(Handle<Buffer>),
    Image(Handle<Image>),
}

impl Build {
    /// Adds the next steps, at most `most`, to a graph; they count as taken. All that they use is added to `imports`. The
    /// texture's handle comes back with the last step, to be sampled in the same graph; later graphs import the image in
    /// the state of [`Access::FragmentSampled`].
    pub fn add(
        &mut self,
        graph: &mut Graph<Record>,
        imports: &mut Imports,
        most: usize,
    ) -> Option<Handle<Image>> {
        if self.next == 0 {
            graph.pipelines("normals", self.pipeline_count);
            self.left_out().iter().for_each(|left_out| graph.leave_out(left_out.clone()));
        }
        let stages = self.take(most).to_vec();
        let mut named = BTreeMap::new();
        for stage in stages {
            for &(resource, _) in &stage.accesses {
                if !named.contains_key(&resource) {
                    named.extend(self.import(graph, imports, resource).map(|found| (resource, found)));
                }
            }
            declare(graph, &mut named, stage);
        }
        match named.get(&Resource::Texture) {
            Some(Named::Image(texture)) => Some(*texture),
            _ => None,
        }
    }

    fn import(&self, graph: &mut Graph<Record>, imports: &mut Imports, resource: Resource) -> Option<Named> {
        if resource == Resource::Texture {
            let image = &self.texture()?.image;
            let entry = State::idle(ImageLayout::UNDEFINED);
            let handle = graph.import_image(image.name(), *image.desc(), entry, Access::FragmentSampled);
            imports.image(&handle, image);
            return Some(Named::Image(handle));
        }
        let buffer = self.buffer(resource)?;
        // Steps of an earlier frame may have written what later ones read; normals and kept lobes were there before any.
        let state = match resource {
            Resource::Normals => State::UNDEFINED,
            _ if self.normals.is_none() => State::UNDEFINED,
            _ => State::of(Access::ComputeStorageReadWrite),
        };
        let name = format!("{resource:?}");
        let handle = graph.import_buffer(&name, *buffer.desc(), state, state);
        imports.buffer(&handle, buffer);
        Some(Named::Buffer(handle))
    }
}

/// One step as a pass.
fn declare(graph: &mut Graph<Record>, named: &mut BTreeMap<Resource, Named>, stage: Stage) {
    let kind = if named_texture(&stage) { PassKind::Transfer } else { PassKind::Compute };
    let mut pass = graph.pass(stage.name, kind);
    for &(resource, access) in &stage.accesses {
        match named.get_mut(&resource) {
            Some(Named::Buffer(handle)) if access.writes() => *handle = pass.write(*handle, access),
            Some(Named::Buffer(handle)) => {
                pass.read(handle, access);
            }
            Some(Named::Image(handle)) => *handle = pass.write(*handle, access),
            None => {}
        }
    }
    pass.record(Box::new(move |recorder, _| stage.record(recorder)));
}

fn named_texture(stage: &Stage) -> bool {
    stage.accesses.iter().any(|(resource, _)| *resource == Resource::Texture)
}
