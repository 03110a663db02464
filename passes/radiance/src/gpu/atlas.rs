//! The rival of the kernel of texels: cube maps drawn by the rasteriser into one atlas, by one instanced indirect draw.

use airglow_gpu::ash::vk;
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Blend, BufferSlice, ColorAttachment, ComputePipeline,
    ComputePipelineDesc, Context, DepthAttachment, DepthState, Feature, FeatureNeed, GpuError,
    GraphicsPipeline, GraphicsPipelineDesc, Image, Label, Load, Recorder, Rendering, Requirements, words,
};
use airglow_graph::{Access, ImageDesc, State};
use bytemuck::{Pod, Zeroable};

use super::kernels::{TEXEL_BINDINGS, TexelConstants};
use super::texels::solid_angles;
use super::{LightShape, TexelBuffers, TexelSettings};
use crate::RadianceError;

/// By gradients.
static PROJECT: [&[u8]; 2] = [
    include_bytes!("../../../../shaders/spirv/radiance/texels.ATLAS.ORDER4.RAYS4.spv").as_slice(),
    include_bytes!("../../../../shaders/spirv/radiance/texels.ATLAS.GRADIENTS.ORDER4.RAYS4.spv").as_slice(),
];
static VERTEX: &[u8] = include_bytes!("../../../../shaders/spirv/radiance/atlas_vertex.spv");
static FRAGMENT: &[u8] = include_bytes!("../../../../shaders/spirv/radiance/atlas_fragment.spv");

const NAME: vk::Format = vk::Format::R32_SFLOAT;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;
/// Metres along a face's normal, below which triangles are clipped.
const NEAREST: f32 = 1e-4;

const DRAW_BINDINGS: [BindingDesc; 2] =
    [BindingDesc::new(0, BindingKind::StorageBuffer), BindingDesc::new(1, BindingKind::StorageBuffer)];

/// `Settings` of `atlas.vert`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Placing {
    columns: u32,
    side: f32,
    nearest: f32,
}

/// Cube maps of order 4 and 4 x 4 rays a texel, drawn.
#[derive(Clone)]
pub struct Atlas {
    settings: TexelSettings,
    /// Faces in a row, and rows.
    columns: u32,
    draw: GraphicsPipeline,
    project: ComputePipeline,
    names: Image,
    depths: Image,
    solid_angles: airglow_gpu::Buffer,
}

impl Atlas {
    /// What a device must offer.
    #[must_use]
    pub fn requirements() -> Requirements {
        let image = BindingDesc::new(8, BindingKind::SampledImage);
        let mut requirements =
            Requirements::engine().with_descriptors(&TEXEL_BINDINGS).with_descriptors(&[image]);
        requirements.features.push(FeatureNeed {
            feature: Feature::ShaderClipDistance,
            required: true,
            buys: "faces that share one atlas",
        });
        requirements
    }

    /// Makes pipelines and an atlas of `side` by `side` rays.
    ///
    /// # Errors
    /// [`RadianceError::Setting`] for another order than 4, other rays than 4, and an atlas with no room for a cube map;
    /// [`RadianceError::Gpu`] when the device refuses.
    pub fn new(context: &Context, settings: TexelSettings, side: u32) -> Result<Self, RadianceError> {
        let TexelSettings { shape: LightShape { order, gradients }, size, rays } = settings;
        if (order, rays) != (4, 4) {
            return Err(RadianceError::setting(
                "the atlas's order and rays",
                format!("{order}, {rays}"),
                "4, 4",
            ));
        }
        let columns = side / (size * rays).max(1);
        if columns * columns < 6 {
            return Err(RadianceError::setting("the atlas's side", side, "room for six faces"));
        }
        let mut bindings = TEXEL_BINDINGS[..7 + usize::from(gradients)].to_vec();
        bindings.push(BindingDesc::new(8, BindingKind::SampledImage));
        let project = context.create_compute_pipeline(&ComputePipelineDesc {
            name: "radiance atlas project",
            spirv: &words(PROJECT[usize::from(gradients)]),
            bindings: &bindings,
            push_constant_size: size_of::<TexelConstants>() as u32,
        })?;
        let image = |name, format, usage| {
            let usage = usage | vk::ImageUsageFlags::SAMPLED;
            let desc = ImageDesc { usage, ..ImageDesc::new_2d(side, side, format) };
            context.create_image(Label::new("radiance", name), &desc)
        };
        Ok(Self {
            settings,
            columns,
            draw: draw_pipeline(context)?,
            project,
            names: image("radiance atlas", NAME, vk::ImageUsageFlags::COLOR_ATTACHMENT)?,
            depths: image("radiance atlas depth", DEPTH, vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT)?,
            solid_angles: solid_angles(context, size as usize)?,
        })
    }

    /// Samples that one draw has room for.
    #[must_use]
    pub fn most_samples(&self) -> u32 {
        self.columns * self.columns / 6
    }

    /// Arguments of the indirect draw of so many triangles at so many samples.
    #[must_use]
    pub fn arguments(triangles: u32, samples: u32) -> [u32; 4] {
        [3 * triangles, 6 * samples, 0, 0]
    }

    /// Records draw and projection of a batch whose first sample is 0, without barriers around them; `arguments` are
    /// [`Atlas::arguments`] in a buffer.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] for buffers that do not fit.
    pub fn record(
        &self,
        recorder: &mut Recorder<'_>,
        buffers: &TexelBuffers,
        arguments: &BufferSlice,
    ) -> Result<(), GpuError> {
        recorder.transition(&self.names, State::UNDEFINED, Access::ColorAttachmentWrite)?;
        recorder.transition(&self.depths, State::UNDEFINED, Access::DepthAttachmentWrite)?;
        let (names, depths) = (self.names.full_view()?, self.depths.full_view()?);
        recorder.begin_rendering(&Rendering {
            colors: &[ColorAttachment { view: &names, load: Load::Clear([0.0; 4]) }],
            depth: Some(DepthAttachment { view: &depths, load: Load::Clear(0.0), write: true }),
        })?;
        let bound =
            [Binding::storage(0, buffers.points.clone()), Binding::storage(1, buffers.triangles.clone())];
        recorder.bind_graphics(&self.draw, &bound)?;
        let rays = self.settings.size * self.settings.rays;
        let side = rays as f32 / self.names.desc().extent[0] as f32;
        recorder.push_constants(&Placing { columns: self.columns, side, nearest: NEAREST })?;
        recorder.draw_indirect(arguments.clone(), 1)?;
        recorder.end_rendering()?;
        recorder.transition(&self.names, Access::ColorAttachmentWrite, Access::ComputeSampled)?;
        let mut bound = vec![
            Binding::storage(0, buffers.batch.clone()),
            Binding::storage(1, buffers.points.clone()),
            Binding::storage(2, buffers.triangles.clone()),
            Binding::storage(3, &self.solid_angles),
            Binding::storage(4, buffers.lights.clone()),
            Binding::storage(5, buffers.surfaces.clone()),
            Binding::storage(6, buffers.pictures.clone()),
        ];
        if self.settings.shape.gradients {
            bound.push(Binding::storage(7, buffers.gradients.clone()));
        }
        bound.push(Binding::sampled(8, names));
        recorder.bind_compute(&self.project, &bound)?;
        recorder.push_constants(&TexelConstants {
            triangle_count: buffers.triangle_count,
            size: self.settings.size,
            keep_exact: 0,
            shown_first: buffers.flat_count,
            shown_count: buffers.shown_count,
            red: buffers.extinction[0],
            green: buffers.extinction[1],
            blue: buffers.extinction[2],
            columns: self.columns,
        })?;
        recorder.dispatch_indirect(buffers.batch.clone())
    }
}

/// Nearest first: depth is one over the distance.
fn draw_pipeline(context: &Context) -> Result<GraphicsPipeline, GpuError> {
    context.create_graphics_pipeline(&GraphicsPipelineDesc {
        name: "radiance atlas",
        vertex: &words(VERTEX),
        fragment: Some(&words(FRAGMENT)),
        bindings: &DRAW_BINDINGS,
        push_constant_size: size_of::<Placing>() as u32,
        vertex_buffers: &[],
        topology: vk::PrimitiveTopology::TRIANGLE_LIST,
        cull: vk::CullModeFlags::NONE,
        front_face: vk::FrontFace::COUNTER_CLOCKWISE,
        depth: Some(DepthState { format: DEPTH, compare: vk::CompareOp::GREATER, write: true }),
        colors: &[NAME],
        blend: Blend::None,
    })
}
