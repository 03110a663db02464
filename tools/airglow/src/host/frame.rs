//! One frame, top to bottom, in the order light travels.

use std::sync::Arc;

use airglow::relight::{Environment, Frame, Instance, Light, Rotations};
use airglow_gpu::{Imports, Record, surface};
use airglow_graph::{Access, Buffer, Graph, Handle, Image};

#[cfg(any(feature = "radiance", feature = "shadow"))]
use super::counted;
use super::draw::{self, Developed, Development, Drawn, Lights, Region, VertexArray, VertexLight};
#[cfg(feature = "fog")]
use super::fog_frame;
use super::lighting::Lighting;
#[cfg(feature = "radiance")]
use super::near::Arrival;
use super::relight::{left_out, no_environment};
use super::renderer::Renderer;
use super::settings::Settings;
#[cfg(feature = "shadow")]
use super::skin::Posed;
use super::sky::{Behind, Glow};
use super::source::Reason;
use super::view::SharedView;
use crate::failure::{Failure, Outcome};

/// A frame as declared: the graph, the host's resources for it, and what turns the light without a new plan.
pub struct Declared {
    /// Every pass with what it uses.
    pub graph: Graph<Record>,
    /// What stands behind the imported handles.
    pub imports: Imports,
    /// What changes from frame to frame.
    pub turning: Turning,
}

/// What changes from frame to frame while the plan stays.
pub struct Turning {
    /// Rotations of the light; `None` where nothing is relit, and where near emitters light each vertex.
    pub rotations: Option<Rotations>,
    /// The same of the radiance that meets surfaces with normal maps.
    #[cfg(feature = "normals")]
    pub incident: Option<Rotations>,
    /// The lights of the radiance pass, where there is one.
    #[cfg(feature = "radiance")]
    pub near: Option<airglow::radiance::Control>,
    /// What the shadow pass counts, where it was asked to.
    #[cfg(feature = "shadow")]
    pub shadow_counts: Vec<super::shadow::CountsSlot>,
    /// The views, which turn with the light.
    pub views: Vec<SharedView>,
    /// The fog pass of each view that has one.
    #[cfg(feature = "fog")]
    pub fog: Vec<airglow::fog::Control>,
    /// The image of the window, another one in each frame; `None` without a window.
    #[cfg_attr(not(feature = "view"), expect(dead_code, reason = "there is no window"))]
    pub window: Option<Handle<Image>>,
}

/// Declares a frame: environment -> light of the vertices -> the scene in each view -> picture -> window, if there is
/// one.
pub fn declare(renderer: &mut Renderer<'_>, settings: &Settings) -> Outcome<Declared> {
    let (mut graph, mut imports) = (Graph::new(), Imports::new());
    renderer.unread.iter().cloned().for_each(|left_out| graph.leave_out(left_out));
    let context = renderer.device.context();

    // Distant light comes in as the host's own image.
    let environment = renderer.scene.environment.as_ref().map(|sky| {
        let map = sky.map.image();
        let handle =
            graph.import_image("environment", *map.desc(), Access::FragmentSampled, Access::FragmentSampled);
        imports.image(&handle, map);
        handle
    });

    // What moves is posed, and hides some of the light from every vertex.
    let posed = renderer.skins.as_ref().map_or(Vec::new(), |skins| skins.add(&mut graph, &mut imports));
    #[cfg(feature = "shadow")]
    let mut shadowed = shadow(renderer, settings, &mut graph, &mut imports, &posed);
    #[cfg(feature = "shadow")]
    counted::look(
        renderer.counters.shadow.as_ref(),
        &mut graph,
        &mut imports,
        "shadow health",
        std::mem::take(&mut shadowed.looks),
    );

    // It becomes the light that leaves each vertex, once for all views: by the pass, or from an array that the host
    // brings.
    let (bytes, time) = (renderer.relight_bytes, renderer.relight_seconds);
    let (filter, mut rotations) = (filter(renderer, settings), None);
    #[cfg(feature = "radiance")]
    let (mut near, extinction) = (None, extinction(renderer, settings));
    #[cfg(feature = "normals")]
    let mut incident_rotations = None;
    let colours = match &mut renderer.lighting {
        Lighting::Relight(lit) if !settings.without_relight => {
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
            let placed = lit.instances.iter().zip(lit.orientations());
            let instances = placed.enumerate().map(|(number, (instance, orientation))| Instance {
                orientation,
                #[cfg(feature = "shadow")]
                visibility: shadowed.visibility.get(number).copied().flatten(),
                normals: posed.iter().find(|posed| posed.instance == number).map(|posed| posed.normals),
                ..Instance::new(lit.meshes[instance.transfer])
            });
            #[cfg_attr(
                not(feature = "radiance"),
                expect(unused_mut, reason = "only near emitters change it")
            )]
            let mut frame = Frame { light, instances: instances.collect(), target: None };
            #[cfg(feature = "radiance")]
            if let Some(emitters) = &lit.near {
                // Near emitters first make the light of each vertex, the environment's with it.
                let arrival = Arrival { turn: settings.turn, filter: filter.as_deref(), extinction };
                let sampled = emitters.add(&mut graph, &mut imports, arrival)?;
                counted::look(
                    renderer.counters.radiance.as_ref(),
                    &mut graph,
                    &mut imports,
                    "radiance health",
                    sampled.looks,
                );
                frame.light = if sampled.light.is_empty() { Light::None } else { Light::Vertices };
                let lights = frame.instances.iter_mut().zip(sampled.light);
                lights.for_each(|(instance, light)| instance.light = Some(light));
                near = sampled.control;
            }
            let relit = lit.relight.add(context, &mut graph, &mut imports, &frame).map_err(Failure::work)?;
            if let (Some(rotations), Some(factors)) = (&relit.rotations, &filter) {
                rotations.set_filter(factors).map_err(Failure::work)?;
            }
            #[cfg(feature = "normals")]
            let incident = match &mut lit.incident {
                // What meets surfaces with normal maps, for the draw to reflect.
                Some(incident) => {
                    let filter = filter.as_deref();
                    let (array, turned) =
                        incident.add(context, &mut graph, &mut imports, &frame, &relit, filter)?;
                    incident_rotations = turned;
                    array
                }
                None => None,
            };
            #[cfg(not(feature = "normals"))]
            let incident = None;
            rotations = relit.rotations;
            let ranges = relit.ranges.iter().map(|range| (range.offset, range.size)).collect();
            relit.results.map(|buffer| VertexLight { colours: VertexArray { buffer, ranges }, incident })
        }
        Lighting::Colours(truth) => {
            let why = "the vertices are lit by the ray-traced reference (--reference)";
            graph.leave_out(left_out(why, "a frame without --reference", bytes, time));
            let state = Access::VertexBuffer;
            let handle = graph.import_buffer("reference colours", *truth.buffer.desc(), state, state);
            imports.buffer(&handle, &truth.buffer);
            let colours = VertexArray { buffer: handle, ranges: truth.ranges.clone() };
            Some(VertexLight { colours, incident: None })
        }
        Lighting::Even(Reason::NoEnvironment) => {
            graph.leave_out(no_environment(bytes, time));
            None
        }
        Lighting::Even(Reason::Asked) | Lighting::Relight(_) => {
            let why = "the host was asked to leave it out (--without relight)";
            graph.leave_out(left_out(why, "a frame without --without relight", bytes, time));
            None
        }
    };

    // The host draws its scene with it in each view, at several samples a pixel, and the sky behind.
    let samples = settings.samples;
    let size = settings.size.map(|side| side * samples);
    let views: Vec<_> = renderer.views(settings, settings.turn).into_iter().map(SharedView::new).collect();
    let pipelines = &renderer.pipelines;
    let lobes = lobes(renderer, settings, &mut graph, &mut imports);
    let lights = renderer.lights.map(|lights| {
        let lights = if settings.air.is_fog() { lights } else { lights.without_medium() };
        Lights {
            constants: Arc::new(lights),
            lobes,
            #[cfg(feature = "fog")]
            complete: None,
        }
    });
    let behind = environment.map(|environment| Behind { environment, glow: glow(renderer, settings) });
    let mut drawn = Vec::with_capacity(views.len());
    #[cfg(feature = "fog")]
    let mut fog = Vec::new();
    #[cfg_attr(not(feature = "fog"), expect(unused_variables, reason = "only fog differs from view to view"))]
    for (index, view) in views.iter().enumerate() {
        #[cfg(feature = "fog")]
        let lights = fog_frame::complete(renderer, settings, index, lights.clone(), &mut fog)?;
        let (colours, lights) = (colours.as_ref(), lights.as_ref());
        drawn.push(pipelines.scene(
            &mut graph,
            &renderer.scene,
            view,
            colours,
            lights,
            behind.as_ref(),
            &posed,
            size,
        ));
    }

    // The medium before it dims them and glows.
    #[cfg(feature = "fog")]
    fog.extend(fog_frame::add(renderer, settings, &mut graph, &mut imports, &mut drawn)?);

    // Exposure, tone map and encoding make the picture, the views side by side.
    let mut picture = |name, buffer: &airglow_gpu::Buffer| {
        let handle = graph.import_buffer(name, *buffer.desc(), Access::HostRead, Access::HostRead);
        imports.buffer(&handle, buffer);
        handle
    };
    let mut developed = Developed {
        linear: picture("linear picture", &renderer.linear),
        display: picture("display picture", &renderer.display),
    };
    let development = Development { samples, exposure: settings.exposure, blue_first: settings.blue_first() };
    for (column, Drawn { hdr, .. }) in (0..).step_by(settings.size[0] as usize).zip(drawn) {
        let region = Region { size: settings.size, column, row_length: settings.picture_size()[0] };
        developed = pipelines.develop(&mut graph, hdr, developed, region, development);
    }

    // A window shows a copy of it, and its own over that.
    let window = settings.window.map(|desc| {
        let image = graph.import_image("window", desc, surface::ACQUIRED, Access::Present);
        let shown = draw::show(&mut graph, developed.display, image);
        renderer.over.iter().for_each(|over| over(&mut graph, shown));
        image
    });

    Ok(Declared {
        graph,
        imports,
        turning: Turning {
            rotations,
            #[cfg(feature = "normals")]
            incident: incident_rotations,
            #[cfg(feature = "radiance")]
            near,
            views,
            #[cfg(feature = "shadow")]
            shadow_counts: shadowed.counts,
            #[cfg(feature = "fog")]
            fog,
            window,
        },
    })
}

/// The shadows of what moves, or the reason why there are none.
#[cfg(feature = "shadow")]
fn shadow(
    renderer: &Renderer<'_>,
    settings: &Settings,
    graph: &mut Graph<Record>,
    imports: &mut Imports,
    posed: &[Posed],
) -> super::shadow::Shadowed {
    let present = match &renderer.lighting {
        Lighting::Relight(lit) if !settings.without_relight => lit.shadow.as_ref(),
        _ => None,
    };
    match present {
        Some(pass) if settings.without_shadow => graph.leave_out(super::shadow::asked(pass.bytes())),
        Some(pass) => return pass.add(graph, imports, posed, settings.count_shadow),
        None if settings.without_shadow => {
            graph.leave_out(super::shadow::asked(renderer.unshadowed.bytes));
        }
        None => graph.leave_out(renderer.unshadowed.clone()),
    }
    super::shadow::Shadowed::default()
}

/// What a medium before the environment does to the bands of its light, where there is one.
#[cfg(feature = "fog")]
pub(super) fn filter(renderer: &Renderer<'_>, settings: &Settings) -> Option<Vec<[f64; 3]>> {
    let fog = renderer.fog.as_ref().filter(|_| settings.air.is_fog())?;
    Some(fog.sky.as_ref()?.factors.clone())
}

/// There is no fog.
#[cfg(not(feature = "fog"))]
pub(super) fn filter(_: &Renderer<'_>, _: &Settings) -> Option<Vec<[f64; 3]>> {
    None
}

/// By how much the medium dims light that passes it, 1/m; zero in clear air.
#[cfg(feature = "radiance")]
pub(super) fn extinction(renderer: &Renderer<'_>, settings: &Settings) -> [f32; 3] {
    #[cfg(feature = "fog")]
    if let Some(fog) = renderer.fog.as_ref().filter(|_| settings.air.is_fog()) {
        return fog.medium.extinction.map(|x| x as f32);
    }
    let _ = (renderer, settings);
    [0.0; 3]
}

/// What it makes of the background.
#[cfg(feature = "fog")]
fn glow(renderer: &Renderer<'_>, settings: &Settings) -> Option<Glow> {
    let fog = renderer.fog.as_ref().filter(|_| settings.air.is_fog())?;
    Some(fog.sky.as_ref()?.glow.clone())
}

/// There is no fog.
#[cfg(not(feature = "fog"))]
fn glow(_: &Renderer<'_>, _: &Settings) -> Option<Glow> {
    None
}

/// The tables that the materials' lobes need in fog.
#[cfg(feature = "fog")]
fn lobes(
    renderer: &Renderer<'_>,
    settings: &Settings,
    graph: &mut Graph<Record>,
    imports: &mut Imports,
) -> Option<Handle<Buffer>> {
    let fog = renderer.fog.as_ref().filter(|_| settings.air.is_fog())?;
    fog.lobes.add(graph, imports)
}

/// There is no fog.
#[cfg(not(feature = "fog"))]
fn lobes(_: &Renderer<'_>, _: &Settings, _: &mut Graph<Record>, _: &mut Imports) -> Option<Handle<Buffer>> {
    None
}
