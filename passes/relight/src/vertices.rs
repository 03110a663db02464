//! The stages over vertices: which kernel each instance needs, and what each chunk of it binds.

use std::collections::BTreeMap;

use airglow_gpu::BindingKind;
use airglow_graph::{Access, PassKind};

use crate::RelightError;
use crate::builder::Builder;
use crate::constants::ChunkConstants;
use crate::envelope::VertexPipeline;
use crate::frame::{Frame, Instance, ResultRange};
use crate::kernels::{self, Kernel, Source};
use crate::mesh::{Mesh, stride};
use crate::pack::{Chunk, RECTANGLE_WIDTH};
use crate::relight::Relight;
use crate::settings::{LightKind, Method, Output};
use crate::shown::Shown;
use crate::stage::{Bound, ChunkWork, Resource, Work};

impl Relight {
    /// The kernel over the vertices of every instance, chunk by chunk, and for the fragment method the copy.
    pub(crate) fn vertices<B, I>(
        &self,
        builder: &mut Builder,
        frame: &Frame<B, I>,
        ranges: &[ResultRange],
        shown: &Shown,
    ) -> Result<(), RelightError> {
        let (mut compute, mut rectangle) = (Vec::new(), Vec::new());
        let mut uses: BTreeMap<Resource, Access> = BTreeMap::new();
        for (index, (instance, range)) in frame.instances.iter().zip(ranges).enumerate() {
            let mesh = self.meshes.get(instance.mesh)?;
            let source = self.source(index, instance, mesh)?;
            for source in [Some(source), source.unshadowed()].into_iter().flatten() {
                let (kernel, pipeline) = self.kernel(source)?;
                for binding in kernel.bindings {
                    let resource = resource(binding, source, index as u32, instance.mesh.index);
                    uses.insert(resource, binding.access);
                    self.need(builder, resource, mesh, binding.access);
                }
                for chunk in &mesh.chunks {
                    let bind = |binding| {
                        let resource = resource(binding, source, index as u32, instance.mesh.index);
                        self.bind(binding, resource, index as u32, mesh, chunk, range)
                    };
                    let bound = kernel.bindings.iter().map(bind).collect();
                    let first_row = (range.offset / 16 / u64::from(RECTANGLE_WIDTH)) as u32
                        + chunk.first / RECTANGLE_WIDTH;
                    let constants =
                        ChunkConstants { vertex_count: chunk.count, stride: stride(chunk), first_row };
                    let at_once = kernels::vertices_per_workgroup(&self.settings, source);
                    let work = ChunkWork {
                        instance: index as u32,
                        shadowed: source.is_shadowed(),
                        pipeline: (),
                        bound,
                        constants,
                        groups: chunk.count.div_ceil(at_once),
                    };
                    match pipeline.clone() {
                        VertexPipeline::Compute(pipeline) => compute.push(work.by(pipeline)),
                        VertexPipeline::Rectangle(pipeline) => rectangle.push(work.by(pipeline)),
                    }
                }
            }
        }
        let mut uses: Vec<_> = uses.into_iter().collect();
        match self.settings.method {
            Method::Compute => {
                let name = match self.settings.output {
                    Output::Colour => "relight colours",
                    Output::Incident => "relight incident radiance",
                };
                builder.stage(name, PassKind::Compute, uses, Work::Vertices(compute, shown.clone()), None);
            }
            Method::Fragment => {
                uses.push((Resource::Rectangle, Access::ColorAttachmentWrite));
                builder.stage(
                    "relight rectangle",
                    PassKind::Graphics,
                    uses,
                    Work::Rectangle(rectangle, shown.clone()),
                    None,
                );
                let uses = vec![
                    (Resource::Rectangle, Access::TransferSource),
                    (Resource::Results, Access::TransferDestination),
                ];
                let size = ranges.last().map_or(0, |range| range.offset + range.size);
                builder.stage("relight copy", PassKind::Transfer, uses, Work::Copy { size }, None);
            }
        }
        Ok(())
    }

    /// Which vectors an instance is lit by; refuses inputs that do not fit the settings.
    fn source<B>(&self, index: usize, instance: &Instance<B>, mesh: &Mesh) -> Result<Source, RelightError> {
        let refuse = |what, mend| Err(RelightError::Instance { instance: index, what, mend });
        if self.settings.light == LightKind::Vertex && instance.light.is_none() {
            return refuse("it has no light for its vertices", "give Instance::light");
        }
        if self.settings.light == LightKind::Uniform && instance.light.is_some() {
            return refuse("it has light for its vertices", "set Settings::light to LightKind::Vertex");
        }
        if instance.visibility.is_some() && !self.settings.visibility {
            return refuse("it has dynamic visibility", "set Settings::visibility");
        }
        if instance.normals.is_some() && !self.settings.normals {
            return refuse("it has normals", "set Settings::normals");
        }
        let colour = self.settings.output == Output::Colour;
        match (mesh.has_vectors(), instance.normals.is_some(), instance.visibility.is_some()) {
            (true, true, _) => refuse("it has normals and its mesh has vectors", "give one of them"),
            (true, false, false) => Ok(Source::Baked),
            (true, false, true) => Ok(Source::Both),
            (false, true, false) => Ok(Source::Normals),
            (false, true, true) => Ok(Source::ShadowedNormals),
            (false, false, _) if colour => refuse("its mesh has no vectors", "give Instance::normals"),
            (false, false, false) => Ok(Source::Open),
            (false, false, true) => Ok(Source::Dynamic),
        }
    }

    fn kernel(&self, source: Source) -> Result<(Kernel, &VertexPipeline), RelightError> {
        let kernel = match self.settings.method {
            Method::Compute => kernels::vertices(&self.settings, source),
            Method::Fragment => kernels::rectangle(&self.settings, source),
        };
        // `source` was checked against the settings the pipelines were made for.
        let pipeline = self.vertex_pipelines.get(&source).ok_or(RelightError::Settings {
            what: "this combination of inputs has no kernel",
            mend: "set Settings::visibility or Settings::normals when instances have them",
        })?;
        Ok((kernel, pipeline))
    }

    /// Makes sure that a resource of the host's or of ours is known to the frame.
    fn need(&self, builder: &mut Builder, resource: Resource, mesh: &Mesh, access: Access) {
        match resource {
            Resource::Vectors(_) => {
                if let Some(vectors) = &mesh.vectors {
                    builder.resident(resource, vectors, access);
                }
            }
            Resource::Tensor => {
                if let Some(tensor) = &self.tensor {
                    builder.resident(resource, tensor, access);
                }
            }
            Resource::VertexLight(_) | Resource::Visibility(_) | Resource::Normals(_) => {
                builder.host(resource);
            }
            _ => {}
        }
    }

    /// A binding of one chunk of an instance: the resource from the chunk's first vertex on.
    fn bind(
        &self,
        binding: &kernels::Binding,
        resource: Resource,
        instance: u32,
        mesh: &Mesh,
        chunk: &Chunk,
        range: &ResultRange,
    ) -> Bound {
        let coefficients = self.settings.coefficients() as u64;
        let of_vertices = |bytes: u64| (u64::from(chunk.first) * bytes, u64::from(chunk.count) * bytes);
        let (offset, size) = match resource {
            Resource::Vectors(_) => mesh.vector_range(&self.settings, chunk),
            Resource::Lights => (u64::from(instance) * self.light_stride(), 16 * coefficients),
            Resource::Matrices => {
                (u64::from(instance) * self.matrix_stride(), 16 * u64::from(self.matrix_elements()))
            }
            Resource::VertexLight(_) => of_vertices(12 * coefficients),
            Resource::Visibility(_) => of_vertices(4 * coefficients),
            Resource::Normals(_) => of_vertices(12),
            Resource::Tensor => (0, self.tensor.as_ref().map_or(0, |tensor| tensor.buffer().size())),
            _ => {
                let (offset, size) = of_vertices(self.settings.output_bytes());
                (range.offset + offset, size)
            }
        };
        let uniform = binding.kind == BindingKind::UniformBuffer;
        Bound { binding: binding.binding, uniform, resource, offset, size }
    }
}

/// What a binding of the kernels over vertices stands for.
fn resource(binding: &kernels::Binding, source: Source, instance: u32, mesh: u32) -> Resource {
    match (binding.binding, binding.kind) {
        (0, _) if source.has_normals() => Resource::Normals(instance),
        (0, _) => Resource::Vectors(mesh),
        (1, BindingKind::UniformBuffer) => Resource::Lights,
        (1, _) => Resource::VertexLight(instance),
        (2, _) => Resource::Results,
        (3, _) => Resource::Visibility(instance),
        (_, BindingKind::UniformBuffer) => Resource::Matrices,
        _ => Resource::Tensor,
    }
}
