//! The host's own draws: the scene with what the passes wrote for its vertices, then the sky, then the picture.

use std::collections::BTreeMap;
use std::sync::Arc;

use airglow_gpu::ash::vk;
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, ColorAttachment, ComputePipeline, ComputePipelineDesc, Context,
    DepthAttachment, GpuError, GraphicsPipeline, Load, Record, Recorder, Rendering, Resources,
};
use airglow_graph::{Access, Buffer, Graph, Handle, Image, ImageDesc, PassKind};
use bytemuck::{Pod, Zeroable};

#[cfg(feature = "fog")]
use super::complete::Complete;
use super::depth_first::{DepthFirst, is_worth};
use super::filter::{MAPPED_BINDINGS, MappedFragments};
use super::formats::DEPTH;
use super::lights::LightsConstants;
use super::scene::{DeviceScene, Draw, Look, MapBindings};
use super::shaders;
use super::skin::Posed;
use super::sky::{Behind, SkyPipelines};
use super::surface::{DRAW_BINDINGS, Inputs, scene_pipeline};
use super::view::SharedView;

/// The pipelines of the host's draws, for one format of the HDR target.
pub struct Pipelines {
    lit: GraphicsPipeline,
    ambient: GraphicsPipeline,
    /// The same two in fog.
    fogged: Option<[GraphicsPipeline; 2]>,
    /// The same for surfaces with normal maps, by how they are looked up and whether in fog.
    mapped: BTreeMap<(Look, bool), MappedPipelines>,
    /// Before these, which cost most of all draws.
    depth_first: Option<DepthFirst>,
    /// Behind the surfaces.
    pub sky: SkyPipelines,
    develop: ComputePipeline,
    hdr: vk::Format,
}

/// For surfaces whose maps are looked up in one way.
#[derive(Clone)]
struct MappedPipelines {
    lit: GraphicsPipeline,
    ambient: GraphicsPipeline,
    /// Lit by the radiance that meets the vertices, too.
    incident: Option<GraphicsPipeline>,
}

impl MappedPipelines {
    /// The one for the light that vertices have, and what of their incident radiance it takes.
    fn of(&self, colours: bool, incident: Option<Part>) -> (&GraphicsPipeline, Option<Part>) {
        match (&self.incident, incident) {
            (Some(pipeline), Some(_)) if colours => (pipeline, incident),
            _ if colours => (&self.lit, None),
            _ => (&self.ambient, None),
        }
    }
}

/// What passes wrote for a scene's vertices: a buffer, and where that of each instance begins.
#[derive(Clone)]
pub struct VertexArray {
    /// As many bytes a vertex as its kind takes.
    pub buffer: Handle<Buffer>,
    /// First byte and size for each instance; no bytes where there is nothing for it.
    pub ranges: Vec<(u64, u64)>,
}

/// The light of a scene's vertices.
#[derive(Clone)]
pub struct VertexLight {
    /// What white diffuse surfaces send out, `[f32; 4]` a vertex.
    pub colours: VertexArray,
    /// Coefficients of what meets the vertices of surfaces with normal maps.
    pub incident: Option<VertexArray>,
}

/// The part of an array that belongs to a draw.
type Part = (Handle<Buffer>, u64, u64);

impl VertexArray {
    fn of(&self, instance: usize) -> Option<Part> {
        let (offset, size) = *self.ranges.get(instance)?;
        (size > 0).then_some((self.buffer, offset, size))
    }
}

/// The scene's lights in a frame.
#[derive(Clone)]
pub struct Lights {
    /// As the draw takes them.
    pub constants: Arc<LightsConstants>,
    /// Tables of the lobes that the materials reflect by in fog.
    pub lobes: Option<Handle<Buffer>>,
    /// The complete model, where the draw has it.
    #[cfg(feature = "fog")]
    pub complete: Option<Complete>,
}

/// A view of the scene as the forward draw leaves it.
#[derive(Clone, Copy, Debug)]
pub struct Drawn {
    /// Scene-linear radiance.
    pub hdr: Handle<Image>,
    /// 0 at the near plane, 1 at the far one and where there is nothing.
    #[cfg(feature = "fog")]
    pub depth: Handle<Image>,
}

/// The picture as it leaves the graph.
#[derive(Clone, Copy)]
pub struct Developed {
    /// Scene-linear RGB, three f32 a pixel.
    pub linear: Handle<Buffer>,
    /// sRGB, one u32 a pixel, red lowest unless asked for otherwise.
    pub display: Handle<Buffer>,
}

/// Where in the picture a view lies.
#[derive(Clone, Copy, Debug)]
pub struct Region {
    /// Pixels of the view.
    pub size: [u32; 2],
    /// Its first column.
    pub column: u32,
    /// Pixels of a row of the picture.
    pub row_length: u32,
}

/// From samples to pixels.
#[derive(Clone, Copy, Debug)]
pub struct Development {
    /// Along each side of a pixel.
    pub samples: u32,
    /// Factor from scene-linear values to the display.
    pub exposure: f32,
    /// Whether blue is the lowest byte of a pixel for the display.
    pub blue_first: bool,
}

/// `Settings` of `host/develop.comp`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct DevelopConstants {
    size: [u32; 2],
    samples: u32,
    exposure: f32,
    column: u32,
    row_length: u32,
    blue_first: u32,
}

impl Pipelines {
    /// Makes the pipelines; `hdr` is a float format with colour attachment and sampling, `lights` says whether the scene
    /// has lights, `fogged` is the fragment stage in fog where they shine into a medium, `mapped` those for normal maps.
    pub fn new(
        context: &Context,
        hdr: vk::Format,
        lights: bool,
        fogged: Option<&[u32]>,
        mapped: &[MappedFragments],
    ) -> Result<Self, GpuError> {
        let fragment = shaders::scene_fragment(lights);
        let bindings = &DRAW_BINDINGS[..if lights { 4 } else { 3 }];
        let plain = if lights { Inputs::Lit } else { Inputs::Unlit };
        let both = |inputs, fragment: &[u32], bindings: &[BindingDesc]| {
            let of = |relight| scene_pipeline(context, hdr, relight, inputs, fragment, bindings);
            Ok::<_, GpuError>([of(true)?, of(false)?])
        };
        let [lit, ambient] = both(plain, &fragment, bindings)?;
        let in_fog = |fragment| both(plain, fragment, &DRAW_BINDINGS);
        let with_map = |fragments: &MappedFragments| {
            let bindings = &MAPPED_BINDINGS[..if fragments.fogged { 9 } else { 8 }];
            let [lit, ambient] = both(Inputs::Mapped, &fragments.plain, bindings)?;
            let incident = fragments.incident.as_ref().map(|(bytes, fragment)| {
                scene_pipeline(context, hdr, true, Inputs::Incident(*bytes), fragment, bindings)
            });
            Ok::<_, GpuError>((
                (fragments.look, fragments.fogged),
                MappedPipelines { lit, ambient, incident: incident.transpose()? },
            ))
        };
        Ok(Self {
            lit,
            ambient,
            fogged: fogged.map(in_fog).transpose()?,
            mapped: mapped.iter().map(with_map).collect::<Result<_, _>>()?,
            depth_first: (!mapped.is_empty()).then(|| DepthFirst::new(context, DEPTH)).transpose()?,
            sky: SkyPipelines::new(context, hdr)?,
            develop: context.create_compute_pipeline(&ComputePipelineDesc {
                name: "develop",
                spirv: &shaders::develop(),
                bindings: &[
                    BindingDesc::new(0, BindingKind::SampledImage),
                    BindingDesc::new(1, BindingKind::StorageBuffer),
                    BindingDesc::new(2, BindingKind::StorageBuffer),
                ],
                push_constant_size: size_of::<DevelopConstants>() as u32,
            })?,
            hdr,
        })
    }

    /// Draws the scene: lit by `colours` where a pass made them, else by the view's ambient light, and by the scene's
    /// `lights`; what is `posed` in the frame is drawn so. Returns the HDR target with the environment behind the surfaces, and the depth.
    pub fn scene(
        &self,
        graph: &mut Graph<Record>,
        scene: &Arc<DeviceScene>,
        view: &SharedView,
        colours: Option<&VertexLight>,
        lights: Option<&Lights>,
        behind: Option<&Behind>,
        posed: &[Posed],
        size: [u32; 2],
    ) -> Drawn {
        let mapped = self.mapped.clone();
        #[cfg(feature = "fog")]
        let complete = lights.and_then(|lights| lights.complete.clone());
        // The complete model has no draw of normal maps.
        #[cfg(feature = "fog")]
        let mapped = if complete.is_some() { BTreeMap::new() } else { mapped };
        let first = self.depth_first.as_ref().filter(|_| !mapped.is_empty() && is_worth(scene));
        let first = first.map(|pass| pass.add(graph, scene, view, posed, size));
        let mut pass = graph.pass("scene draw", PassKind::Graphics);
        posed.iter().for_each(|posed| posed.read(&mut pass));
        let incident = colours.and_then(|light| light.incident.as_ref());
        for array in colours.map(|light| &light.colours).into_iter().chain(incident) {
            pass.read(&array.buffer, Access::VertexBuffer);
        }
        if let Some(behind) = behind {
            pass.read(&behind.environment, Access::FragmentSampled);
        }
        let lobes = lights.and_then(|lights| lights.lobes);
        if let Some(lobes) = &lobes {
            pass.read(lobes, Access::FragmentStorageRead).read(lobes, Access::VertexStorageRead);
        }
        let image = |format| ImageDesc::new_2d(size[0], size[1], format);
        let hdr = pass.create_image("hdr", image(self.hdr), Access::ColorAttachmentWrite);
        let depth = match first {
            Some(depth) => pass.update(depth, Access::DepthAttachmentReadWrite),
            None => pass.create_image("depth", image(DEPTH), Access::DepthAttachmentWrite),
        };
        let [lit, ambient] = match (&self.fogged, lobes) {
            (Some([lit, ambient]), Some(_)) => [lit, ambient],
            _ => [&self.lit, &self.ambient],
        };
        let lit = if colours.is_some() { lit } else { ambient };
        #[cfg(feature = "fog")]
        let lit = complete.as_ref().map_or(lit, |complete| complete.pipelines.of(colours.is_some()));
        let (pipeline, sky) = (lit.clone(), self.sky.clone());
        let glow = behind.and_then(|behind| behind.glow.clone());
        let (scene, view) = (Arc::clone(scene), view.clone());
        let (colours, incident, lights) = (colours.cloned(), incident.cloned(), lights.cloned());
        pass.record(Box::new(move |recorder, resources| {
            let targets = [resources.view(&hdr)?, resources.view(&depth)?];
            let load = first.map_or(Load::Clear(1.0), |_| Load::Keep);
            recorder.begin_rendering(&Rendering {
                colors: &[ColorAttachment { view: &targets[0], load: Load::Clear([0.0, 0.0, 0.0, 1.0]) }],
                depth: Some(DepthAttachment { view: &targets[1], load, write: true }),
            })?;
            let view = recorder.upload(&[view.get()])?;
            let mut bound = vec![Binding::uniform(0, &view)];
            if let Some(lights) = &lights {
                bound.push(Binding::uniform(3, &recorder.upload(&[*lights.constants])?));
            }
            let mut of_maps = bound.clone();
            if lights.is_none() && !mapped.is_empty() {
                of_maps.push(Binding::uniform(3, &recorder.upload(&[LightsConstants::NONE])?));
            }
            if let Some(lobes) = &lobes {
                let tables = Binding::storage(4, resources.buffer(lobes)?);
                bound.push(tables.clone());
                of_maps.push(tables);
            }
            #[cfg(feature = "fog")]
            if let Some(complete) = &complete {
                let through = complete.binding(recorder)?;
                complete.record_sky(recorder, &view, &through)?;
                bound.push(through);
            }
            for (instance, draw) in scene.draws.iter().enumerate() {
                let colours = colours.as_ref().and_then(|light| light.colours.of(instance));
                let incident = incident.as_ref().and_then(|array| array.of(instance));
                let map = draw
                    .mapped
                    .as_ref()
                    .and_then(|map| Some((map, mapped.get(&(map.look, lobes.is_some()))?)));
                let (pipeline, bound, map, incident) = match map {
                    Some((map, pipelines)) => {
                        let (pipeline, incident) = pipelines.of(colours.is_some(), incident);
                        (pipeline, &of_maps, Some(&map.bindings), incident)
                    }
                    None => (&pipeline, &bound, None, None),
                };
                let (normals, arrays) = (map.is_some() || lights.is_some(), [colours, incident]);
                record_draw(recorder, resources, pipeline, draw, bound, normals, map, arrays)?;
            }
            if let Some(environment) = &scene.environment {
                sky.record(recorder, &view, environment, glow.as_ref())?;
            }
            recorder.end_rendering()
        }));
        Drawn {
            hdr,
            #[cfg(feature = "fog")]
            depth,
        }
    }

    /// Develops the HDR target of a view into its region of two buffers of the host's. Returns the buffers with it in
    /// them.
    pub fn develop(
        &self,
        graph: &mut Graph<Record>,
        hdr: Handle<Image>,
        buffers: Developed,
        region: Region,
        development: Development,
    ) -> Developed {
        let mut pass = graph.pass("tone map", PassKind::Compute);
        pass.read(&hdr, Access::ComputeSampled);
        let linear = pass.update(buffers.linear, Access::ComputeStorageWrite);
        let display = pass.update(buffers.display, Access::ComputeStorageWrite);
        let pipeline = self.develop.clone();
        pass.record(Box::new(move |recorder, resources| {
            recorder.bind_compute(
                &pipeline,
                &[
                    Binding::sampled(0, resources.view(&hdr)?),
                    Binding::storage(1, resources.buffer(&linear)?),
                    Binding::storage(2, resources.buffer(&display)?),
                ],
            )?;
            let Region { size, column, row_length } = region;
            let Development { samples, exposure, blue_first } = development;
            recorder.push_constants(&DevelopConstants {
                size,
                samples,
                exposure,
                column,
                row_length,
                blue_first: blue_first.into(),
            })?;
            recorder.dispatch([size[0].div_ceil(8), size[1].div_ceil(8), 1])
        }));
        Developed { linear, display }
    }
}

/// Copies the developed picture, pixel for pixel, to an image of a window's, which it returns.
pub fn show(graph: &mut Graph<Record>, picture: Handle<Buffer>, window: Handle<Image>) -> Handle<Image> {
    let mut pass = graph.pass("show", PassKind::Transfer);
    pass.read(&picture, Access::TransferSource);
    let window = pass.write(window, Access::TransferDestination);
    pass.record(Box::new(move |recorder, resources| {
        recorder.copy_buffer_to_image(resources.buffer(&picture)?, &resources.view(&window)?)
    }));
    window
}

fn record_draw(
    recorder: &mut Recorder<'_>,
    resources: &Resources<'_>,
    pipeline: &GraphicsPipeline,
    draw: &Draw,
    bound: &[Binding],
    normals: bool,
    map: Option<&MapBindings>,
    [colours, incident]: [Option<Part>; 2],
) -> Result<(), GpuError> {
    let mut bindings = bound.to_vec();
    bindings.extend(map.into_iter().flatten().cloned());
    bindings.extend([Binding::sampled(1, draw.base_colour.clone()), Binding::sampler(2, &draw.sampler)]);
    recorder.bind_graphics(pipeline, &bindings)?;
    recorder.push_constants(&draw.material)?;
    recorder.bind_vertex_buffer(0, &draw.mesh.positions)?;
    recorder.bind_vertex_buffer(1, &draw.mesh.texture_coordinates)?;
    if let Some((colours, offset, size)) = colours {
        recorder.bind_vertex_buffer(2, resources.buffer(&colours)?.slice(offset, size)?)?;
    }
    let next = 2 + u32::from(colours.is_some());
    if let (Some(array), true) = (&draw.mesh.normals, normals) {
        recorder.bind_vertex_buffer(next, array)?;
    }
    if let (Some(tangents), Some(_)) = (&draw.mesh.tangents, map) {
        recorder.bind_vertex_buffer(next + 1, tangents)?;
    }
    if let Some((incident, offset, size)) = incident {
        recorder.bind_vertex_buffer(next + 2, resources.buffer(&incident)?.slice(offset, size)?)?;
    }
    recorder.bind_index_buffer(&draw.mesh.indices)?;
    recorder.draw_indexed(0..draw.mesh.index_count, 0, 0..1)
}
