//! One frame, top to bottom, in the order light travels.

use airglow::relight::{Environment, Frame, Instance, Light, Rotations};
use airglow_gpu::{Imports, Record};
use airglow_graph::{Access, Graph, LeftOut};

use super::draw::{Developed, VertexColours};
use super::renderer::{Renderer, Settings};
use super::view::SharedView;
use crate::failure::{Failure, Outcome};

/// A frame as declared: the graph, the host's resources for it, and what turns the light without a new plan.
pub struct Declared {
    /// Every pass with what it uses.
    pub graph: Graph<Record>,
    /// What stands behind the imported handles.
    pub imports: Imports,
    /// Rotations of the light; `None` where nothing is relit.
    pub rotations: Option<Rotations>,
    /// The view, which turns with the light.
    pub view: SharedView,
}

/// Declares a frame: environment -> light of the vertices -> scene -> picture.
pub fn declare(renderer: &mut Renderer<'_>, settings: &Settings) -> Outcome<Declared> {
    let (mut graph, mut imports) = (Graph::new(), Imports::new());
    let context = renderer.device.context();

    // Distant light comes in as the host's own image.
    let environment = renderer.scene.environment.as_ref().map(|sky| {
        let map = sky.map.image();
        let handle =
            graph.import_image("environment", *map.desc(), Access::FragmentSampled, Access::FragmentSampled);
        imports.image(&handle, map);
        handle
    });

    // It becomes the light that leaves each vertex: by the pass, or from an array that the host brings.
    let mut rotations = None;
    let colours = if let Some(truth) = &renderer.vertex_colours {
        let why = "the vertices are lit by the ray-traced reference (--reference)";
        graph.leave_out(left_out(renderer, why, "a frame without --reference"));
        let state = Access::VertexBuffer;
        let handle = graph.import_buffer("reference colours", *truth.buffer.desc(), state, state);
        imports.buffer(&handle, &truth.buffer);
        Some(VertexColours { buffer: handle, ranges: truth.ranges.clone() })
    } else if settings.without_relight {
        let why = "the host was asked to leave it out (--without relight)";
        graph.leave_out(left_out(renderer, why, "a frame without --without relight"));
        None
    } else {
        let light = match (environment, &renderer.environment) {
            (Some(image), Some(map)) => Light::Environment(Environment {
                image,
                width: map.width,
                height: map.height,
                revision: 1,
                rotation: settings.turn * map.rotation,
            }),
            _ => Light::None,
        };
        let instances = renderer.instances.iter().map(|instance| Instance {
            orientation: instance.orientation,
            ..Instance::new(renderer.meshes[instance.transfer])
        });
        let frame = Frame { light, instances: instances.collect(), target: None };
        let relit = renderer.relight.add(context, &mut graph, &mut imports, &frame).map_err(Failure::work)?;
        rotations = relit.rotations;
        let ranges = relit.ranges.iter().map(|range| (range.offset, range.size)).collect();
        relit.results.map(|buffer| VertexColours { buffer, ranges })
    };

    // The host draws its scene with it, at several samples a pixel, and the sky behind.
    let samples = settings.samples;
    let size = settings.size.map(|side| side * samples);
    let view = SharedView::new(renderer.view(settings, settings.turn));
    let pipelines = &renderer.pipelines;
    let hdr = pipelines.scene(&mut graph, &renderer.scene, &view, colours.as_ref(), environment, size);

    // Exposure, tone map and encoding make the picture.
    let buffers = Developed {
        linear: graph.import_buffer(
            "linear picture",
            *renderer.linear.desc(),
            Access::HostRead,
            Access::HostRead,
        ),
        display: graph.import_buffer(
            "display picture",
            *renderer.display.desc(),
            Access::HostRead,
            Access::HostRead,
        ),
    };
    imports.buffer(&buffers.linear, &renderer.linear).buffer(&buffers.display, &renderer.display);
    pipelines.develop(&mut graph, hdr, buffers, settings.size, samples, settings.exposure);

    Ok(Declared { graph, imports, rotations, view })
}

/// The record of the relight pass being left out by the host.
fn left_out(renderer: &Renderer<'_>, why: &str, would_return: &str) -> LeftOut {
    LeftOut {
        what: "relight".to_owned(),
        why: why.to_owned(),
        bytes: renderer.relight_bytes(),
        time: renderer.relight_seconds,
        would_return: would_return.to_owned(),
    }
}
