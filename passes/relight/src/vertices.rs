//! The stages over vertices: which kernel each instance needs, and what each chunk of it binds.

use std::collections::BTreeMap;

use airglow_gpu::BindingKind;
use airglow_graph::{Access, PassKind};

use crate::RelightError;
use crate::builder::Builder;
use crate::frame::{Frame, Instance, ResultRange};
use crate::kernels::{self, Kernel, Source};
use crate::mesh::{Mesh, stride};
use crate::pack::{Chunk, RECTANGLE_WIDTH};
use crate::relight::{Relight, VertexPipeline};
use crate::settings::{LightKind, Method, Output};
use crate::stage::{Bound, ChunkConstants, ChunkWork, Resource, Work};

impl Relight {
    /// The kernel over the vertices of every instance, chunk by chunk, and for the fragment method the copy.
    pub(crate) fn vertices<B, I>(
        &self,
        builder: &mut Builder,
        frame: &Frame<B, I>,
        ranges: &[ResultRange],
    ) -> Result<(), RelightError> {
        let (mut compute, mut rectangle) = (Vec::new(), Vec::new());
        let mut uses: BTreeMap<Resource, Access> = BTreeMap::new();
        for (index, (instance, range)) in frame.instances.iter().zip(ranges).enumerate() {
            let mesh = self.meshes.get(instance.mesh)?;
            let source = self.source(index, instance, mesh)?;
            let (kernel, pipeline) = self.kernel(source)?;
            for binding in kernel.bindings {
                let resource =
                    self.resource(binding.binding, binding.kind, index as u32, instance.mesh.index);
                uses.insert(resource, binding.access);
                self.need(builder, resource, mesh, binding.access);
            }
            for chunk in &mesh.chunks {
                let bound = self.bind(&kernel, mesh, chunk, index as u32, instance.mesh.index, range);
                let first_row =
                    (range.offset / 16 / u64::from(RECTANGLE_WIDTH)) as u32 + chunk.first / RECTANGLE_WIDTH;
                let constants =
                    ChunkConstants { vertex_count: chunk.count, stride: stride(chunk), first_row };
                let groups = chunk.count.div_ceil(kernels::vertices_per_workgroup(&self.settings, source));
                match pipeline.clone() {
                    VertexPipeline::Compute(pipeline) => {
                        compute.push(ChunkWork { pipeline, bound, constants, groups });
                    }
                    VertexPipeline::Rectangle(pipeline) => {
                        rectangle.push(ChunkWork { pipeline, bound, constants, groups: 0 });
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
                builder.stage(name, PassKind::Compute, uses, Work::Vertices(compute), None);
            }
            Method::Fragment => {
                uses.push((Resource::Rectangle, Access::ColorAttachmentWrite));
                builder.stage(
                    "relight rectangle",
                    PassKind::Graphics,
                    uses,
                    Work::Rectangle(rectangle),
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
        match (instance.visibility.is_some(), mesh.vectors.is_some()) {
            (true, _) if !self.settings.visibility => {
                refuse("it has dynamic visibility", "set Settings::visibility")
            }
            (true, true) => Ok(Source::Both),
            (true, false) => Ok(Source::Dynamic),
            (false, true) => Ok(Source::Baked),
            (false, false) => refuse("its mesh has no vectors and it has no visibility", "give one of them"),
        }
    }

    fn kernel(&self, source: Source) -> Result<(Kernel, &VertexPipeline), RelightError> {
        let pipelines = &self.vertex_pipelines;
        let pipeline = match source {
            Source::Baked => Some(&pipelines.baked),
            Source::Dynamic => pipelines.dynamic.as_ref(),
            Source::Both => pipelines.both.as_ref(),
        };
        let kernel = match self.settings.method {
            Method::Compute => kernels::vertices(&self.settings, source),
            Method::Fragment => kernels::rectangle(&self.settings, source),
        };
        // `source` was checked against the settings the pipelines were made for.
        pipeline.map(|pipeline| (kernel, pipeline)).ok_or(RelightError::Settings {
            what: "this combination of inputs has no kernel",
            mend: "set Settings::visibility when instances have dynamic visibility",
        })
    }

    /// What a binding number of the kernels over vertices stands for.
    fn resource(&self, binding: u32, kind: BindingKind, instance: u32, mesh: u32) -> Resource {
        match (binding, kind) {
            (0, _) => Resource::Vectors(mesh),
            (1, BindingKind::UniformBuffer) => Resource::Lights,
            (1, _) => Resource::VertexLight(instance),
            (2, _) => Resource::Results,
            (3, _) => Resource::Visibility(instance),
            (_, BindingKind::UniformBuffer) => Resource::Matrices,
            _ => Resource::Tensor,
        }
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
            Resource::VertexLight(_) | Resource::Visibility(_) => builder.host(resource),
            _ => {}
        }
    }

    /// The bindings of one chunk of an instance: every resource from the chunk's first vertex on.
    fn bind(
        &self,
        kernel: &Kernel,
        mesh: &Mesh,
        chunk: &Chunk,
        instance: u32,
        mesh_index: u32,
        range: &ResultRange,
    ) -> Vec<Bound> {
        let coefficients = self.settings.coefficients() as u64;
        let of_vertices = |bytes: u64| (u64::from(chunk.first) * bytes, u64::from(chunk.count) * bytes);
        let bind = |binding: &kernels::Binding| {
            let resource = self.resource(binding.binding, binding.kind, instance, mesh_index);
            let (offset, size) = match resource {
                Resource::Vectors(_) => mesh.vector_range(&self.settings, chunk),
                Resource::Lights => (u64::from(instance) * self.light_stride(), 16 * coefficients),
                Resource::Matrices => {
                    (u64::from(instance) * self.matrix_stride(), 16 * u64::from(self.matrix_elements()))
                }
                Resource::VertexLight(_) => of_vertices(12 * coefficients),
                Resource::Visibility(_) => of_vertices(4 * coefficients),
                Resource::Tensor => (0, self.tensor.as_ref().map_or(0, |tensor| tensor.buffer().size())),
                _ => {
                    let (offset, size) = of_vertices(self.settings.output_bytes());
                    (range.offset + offset, size)
                }
            };
            Bound {
                binding: binding.binding,
                uniform: binding.kind == BindingKind::UniformBuffer,
                resource,
                offset,
                size,
            }
        };
        kernel.bindings.iter().map(bind).collect()
    }
}
