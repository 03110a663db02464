//! The scene's medium in a frame: by the pass, as depth fog, or in the forward draw.

use airglow::fog;
use airglow_gpu::{Imports, Record};
use airglow_graph::Graph;

use super::complete::{Complete, CompletePipelines};
use super::depth_fog::{DepthFog, DepthFogConstants};
use super::draw::{Drawn, Lights};
use super::fog::{left_out, no_medium};
use super::renderer::Renderer;
use super::settings::{Air, Settings};
use crate::failure::{Failure, Outcome};

/// Puts the medium before each view drawn; what is returned changes it before the plan is recorded again.
pub fn add(
    renderer: &Renderer<'_>,
    settings: &Settings,
    graph: &mut Graph<Record>,
    imports: &mut Imports,
    drawn: &mut [Drawn],
) -> Outcome<Vec<fog::Control>> {
    let fog_views = renderer.fog_views(settings, settings.turn)?;
    let size = settings.size.map(|side| side * settings.samples);
    let present = match (&renderer.fog, settings.air) {
        (Some(present), Air::Fog) => present,
        (Some(present), Air::DepthFog(colour)) => {
            let context = renderer.device.context();
            let pass = DepthFog::new(context, present.pass.settings().format).map_err(Failure::work)?;
            graph.leave_out(left_out("the host draws depth fog instead", "a frame without depth fog"));
            for (drawn, view) in drawn.iter_mut().zip(fog_views) {
                pass.add(graph, drawn, depth_fog_constants(&view, colour), size);
            }
            return Ok(Vec::new());
        }
        (Some(_), Air::Complete(_)) => {
            let why = "the forward draw has the complete model (--complete)";
            graph.leave_out(left_out(why, "a frame without --complete"));
            return Ok(Vec::new());
        }
        (Some(_), Air::Clear) => {
            graph.leave_out(left_out(
                "the host was asked to leave it out (--without fog)",
                "a frame without --without fog",
            ));
            return Ok(Vec::new());
        }
        (None, _) => {
            if !renderer.says_left_out("fog") {
                graph.leave_out(no_medium());
            }
            return Ok(Vec::new());
        }
    };
    if let Some(health) = &present.health {
        health.add(graph, imports, size, drawn.iter().map(|drawn| [drawn.hdr, drawn.depth]).collect());
    }
    let mut controls = Vec::new();
    for (drawn, view) in drawn.iter_mut().zip(fog_views) {
        let frame = fog::Frame { size, surface: drawn.hdr, depth: drawn.depth, target: None, view };
        let fogged = present.pass.add(graph, &frame).map_err(Failure::work)?;
        drawn.hdr = fogged.colour;
        controls.extend(fogged.control);
    }
    Ok(controls)
}

/// The lights of a view with the complete model in its draw, where that is asked for; `controls` gets what changes it.
pub fn complete(
    renderer: &Renderer<'_>,
    settings: &Settings,
    view: usize,
    lights: Option<Lights>,
    controls: &mut Vec<fog::Control>,
) -> Outcome<Option<Lights>> {
    let Air::Complete(road) = settings.air else { return Ok(lights) };
    let view = renderer.fog_views(settings, settings.turn)?.into_iter().nth(view);
    let whole = lights.filter(|lights| lights.lobes.is_some() && renderer.environment.is_none());
    let (Some(fog), Some(view), Some(lights)) = (&renderer.fog, view, whole) else {
        return Err(Failure::input(
            "--complete draws lamps in a medium at night: it needs a scene with both and without an environment",
        ));
    };
    let size = settings.size.map(|side| side * settings.samples);
    let frame = fog::Frame { size, surface: (), depth: (), target: None, view };
    let fog::Prepared::Pass(pass) = fog.pass.prepare(&frame).map_err(Failure::work)? else {
        return Ok(Some(lights));
    };
    let context = renderer.device.context();
    let pipelines =
        CompletePipelines::new(context, fog.pass.settings().format, road).map_err(Failure::work)?;
    controls.push(pass.control.clone());
    Ok(Some(Lights { complete: Some(Complete { pipelines, control: pass.control }), ..lights }))
}

/// Depth fog of the medium's extinction.
fn depth_fog_constants(view: &fog::View, colour: [f32; 3]) -> DepthFogConstants {
    let depth = &view.world.depth;
    let wide = |[r, g, b]: [f32; 3], w: f32| [r, g, b, w];
    DepthFogConstants {
        depth: view.world.depth_coefficients().map(|value| value as f32),
        extinction: wide(view.medium.extinction.map(|value| value as f32), depth.farthest() as f32),
        colour: wide(colour, 0.0),
    }
}
