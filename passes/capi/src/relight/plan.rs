//! What our graph makes of a frame: its plan as text, as JSON or as a diagram.

use airglow_gpu::ash::vk::{BufferUsageFlags, Format, ImageUsageFlags};
use airglow_gpu::{Imports, Record};
use airglow_graph::{Access, Buffer, BufferDesc, Graph, Handle, ImageDesc};
use airglow_relight::{Environment, Frame, Instance, Light, Output, Resource};

use super::AirglowRelight;
use super::frame::{AirglowRelightFrame, read};
use super::resources::host_bytes;
use crate::input::{shared, versioned};
use crate::plan::write_plan;
use crate::status::{AirglowError, AirglowStatus, Failure, edge};
use crate::text::AirglowText;

/// Writes the plan that the library's graph makes of a frame: steps, barriers, lifetimes and bytes of what they use, and
/// what was left out, why, and what would bring it back. The host's resources stand in it with the sizes needed, handed
/// over as their first use wants them, the results going on to vertex input or to vertex shaders. The format is an
/// `AirglowPlanFormat`.
///
/// # Safety
/// `frame` as with `airglow_relight_prepare`; `text` as `AirglowText` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airglow_relight_plan(
    relight: *const AirglowRelight,
    frame: *const AirglowRelightFrame,
    format: u32,
    text: *mut AirglowText,
    error: *mut AirglowError,
) -> AirglowStatus {
    // SAFETY: the caller vouches for the pointers.
    unsafe {
        edge(error, || {
            let relight = shared(relight, "relight")?;
            write_plan(&relight.context, graph(relight, &versioned(frame, "frame")?)?, format, text)
        })
    }
}

/// # Safety
/// The instances of `frame` are as many as it says.
unsafe fn graph(relight: &AirglowRelight, frame: &AirglowRelightFrame) -> Result<Graph<Record>, Failure> {
    let state = &mut *relight.state();
    // SAFETY: the caller's promise is ours.
    let given = unsafe { read(state, frame)? };
    let prepared = state.relight.prepare(&relight.context, &given.frame)?;
    let settings = *state.relight.settings();
    let coefficients = settings.coefficients() as u64;
    let (mut graph, mut imports) = (Graph::<Record>::new(), Imports::new());
    let mut import = |resource: Resource, access: Access| {
        let usage = BufferUsageFlags::STORAGE_BUFFER
            | BufferUsageFlags::UNIFORM_BUFFER
            | BufferUsageFlags::VERTEX_BUFFER
            | BufferUsageFlags::TRANSFER_DST;
        let desc = BufferDesc { size: host_bytes(&prepared, coefficients, resource).max(1), usage };
        graph.import_buffer(&format!("{resource} of the host"), desc, access, access)
    };
    let mut instances = Vec::new();
    for (index, instance) in given.frame.instances.iter().enumerate() {
        let index = index as u32;
        let mut input =
            |has: Option<()>, resource| has.map(|()| import(resource, Access::ComputeStorageRead));
        instances.push(Instance {
            mesh: instance.mesh,
            orientation: instance.orientation,
            light: input(instance.light, Resource::VertexLight(index)),
            visibility: input(instance.visibility, Resource::Visibility(index)),
            normals: input(instance.normals, Resource::Normals(index)),
        });
    }
    let read_by = match settings.output {
        Output::Colour => Access::VertexBuffer,
        Output::Incident => Access::VertexStorageRead,
    };
    let target = (!prepared.ranges.is_empty()).then(|| import(Resource::Results, read_by));
    let light = match given.frame.light {
        Light::None => Light::None,
        Light::Vertices => Light::Vertices,
        Light::Uniform { rotation, .. } => {
            let coefficients: Handle<Buffer> = import(Resource::UniformLight, Access::ComputeStorageRead);
            Light::Uniform { coefficients, rotation }
        }
        Light::Environment(Environment { width, height, revision, rotation, .. }) => {
            let format = Format::R32G32B32A32_SFLOAT;
            let desc =
                ImageDesc { usage: ImageUsageFlags::SAMPLED, ..ImageDesc::new_2d(width, height, format) };
            let access = Access::ComputeSampled;
            let image = graph.import_image("relight environment", desc, access, access);
            Light::Environment(Environment { image, width, height, revision, rotation })
        }
    };
    let frame = Frame { light, instances, target };
    state.relight.add(&relight.context, &mut graph, &mut imports, &frame)?;
    Ok(graph)
}
