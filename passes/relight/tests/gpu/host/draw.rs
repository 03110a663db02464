//! A host's draw of meshes with the colours of their vertices.

#![expect(clippy::unwrap_used, reason = "helpers fail the test they are called from")]

use airglow_gpu::ash::vk;
use airglow_gpu::{
    Blend, Buffer, ColorAttachment, DepthAttachment, DepthState, GpuError, GraphicsPipeline,
    GraphicsPipelineDesc, Image, Label, Load, Location, Recorder, Rendering, VertexAttribute,
    VertexBufferLayout,
};
use airglow_graph::{Access, BufferDesc, ImageDesc, State};
use airglow_math::world::Depth;
use airglow_relight::Bench;
use airglow_tests::spirv::words;
use bytemuck::Pod;
use glam::Mat4;

/// Pixels of a side of the picture.
pub const SIDE: usize = 192;
const COLOUR: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

/// One instance.
pub struct Drawing {
    pub clip_from_object: Mat4,
    /// RGBA of each vertex.
    pub colours: Vec<f32>,
    /// Whether its fronts wind clockwise in the picture.
    pub clockwise: bool,
}

/// Draws fronts only, the nearest by the host's depth: pixels, alpha 0 where nothing is, and depth values.
pub fn draw(
    bench: &Bench<'_>,
    depth: Depth,
    positions: &[[f32; 3]],
    indices: &[u32],
    drawings: &[Drawing],
) -> (Vec<[f32; 4]>, Vec<f32>) {
    let pipelines = [false, true].map(|clockwise| pipeline(bench, depth.reversed, clockwise).unwrap());
    let vertex_usage = vk::BufferUsageFlags::VERTEX_BUFFER;
    let positions = buffer(bench, positions, vertex_usage);
    let indices = buffer(bench, indices, vk::BufferUsageFlags::INDEX_BUFFER);
    let colours: Vec<Buffer> =
        drawings.iter().map(|drawing| buffer(bench, &drawing.colours, vertex_usage)).collect();
    let picture = image(bench, COLOUR, vk::ImageUsageFlags::COLOR_ATTACHMENT);
    let depths = image(bench, DEPTH, vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT);
    let count = (indices.size() / 4) as u32;
    let mut copies = None;
    (bench.run)(&mut |recorder: &mut Recorder<'_>| -> Result<(), GpuError> {
        recorder.transition(&picture, State::UNDEFINED, Access::ColorAttachmentWrite)?;
        recorder.transition(&depths, State::UNDEFINED, Access::DepthAttachmentWrite)?;
        let views = [picture.full_view()?, depths.full_view()?];
        recorder.begin_rendering(&Rendering {
            colors: &[ColorAttachment { view: &views[0], load: Load::Clear([0.0; 4]) }],
            depth: Some(DepthAttachment {
                view: &views[1],
                load: Load::Clear(depth.farthest() as f32),
                write: true,
            }),
        })?;
        for (drawing, colours) in drawings.iter().zip(&colours) {
            recorder.bind_graphics(&pipelines[usize::from(drawing.clockwise)], &[])?;
            recorder.push_constants(&drawing.clip_from_object.to_cols_array())?;
            recorder.bind_vertex_buffer(0, &positions)?;
            recorder.bind_vertex_buffer(1, colours)?;
            recorder.bind_index_buffer(&indices)?;
            recorder.draw_indexed(0..count, 0, 0..1)?;
        }
        recorder.end_rendering()?;
        recorder.transition(&picture, Access::ColorAttachmentWrite, Access::TransferSource)?;
        recorder.transition(&depths, Access::DepthAttachmentWrite, Access::TransferSource)?;
        copies = Some([recorder.read_back_image(&views[0])?, recorder.read_back_image(&views[1])?]);
        Ok(())
    })
    .unwrap();
    let [picture, depths] = copies.unwrap().map(|copy| copy.texels().unwrap());
    (picture, depths.iter().map(|texel| texel[0]).collect())
}

fn buffer<T: Pod>(bench: &Bench<'_>, values: &[T], usage: vk::BufferUsageFlags) -> Buffer {
    let desc = BufferDesc { size: size_of_val(values) as u64, usage };
    let buffer = bench.context.create_buffer(Label::new("host", "draw"), &desc, Location::Upload).unwrap();
    buffer.write(0, values).unwrap();
    buffer
}

fn image(bench: &Bench<'_>, format: vk::Format, usage: vk::ImageUsageFlags) -> Image {
    let usage = usage | vk::ImageUsageFlags::TRANSFER_SRC;
    let desc = ImageDesc { usage, ..ImageDesc::new_2d(SIDE as u32, SIDE as u32, format) };
    bench.context.create_image(Label::new("host", "picture"), &desc).unwrap()
}

fn pipeline(bench: &Bench<'_>, reversed: bool, clockwise: bool) -> Result<GraphicsPipeline, GpuError> {
    let rate = vk::VertexInputRate::VERTEX;
    let position = [VertexAttribute { location: 0, format: vk::Format::R32G32B32_SFLOAT, offset: 0 }];
    let colour = [VertexAttribute { location: 1, format: COLOUR, offset: 0 }];
    bench.context.create_graphics_pipeline(&GraphicsPipelineDesc {
        name: "lit",
        vertex: &words("test/lit_vertex"),
        fragment: Some(&words("test/lit_fragment")),
        bindings: &[],
        push_constant_size: 64,
        vertex_buffers: &[
            VertexBufferLayout { stride: 12, rate, attributes: &position },
            VertexBufferLayout { stride: 16, rate, attributes: &colour },
        ],
        topology: vk::PrimitiveTopology::TRIANGLE_LIST,
        cull: vk::CullModeFlags::BACK,
        front_face: if clockwise { vk::FrontFace::CLOCKWISE } else { vk::FrontFace::COUNTER_CLOCKWISE },
        depth: Some(DepthState {
            format: DEPTH,
            compare: if reversed { vk::CompareOp::GREATER } else { vk::CompareOp::LESS },
            write: true,
        }),
        colors: &[COLOUR],
        blend: Blend::None,
    })
}
