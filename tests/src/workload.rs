//! A small frame that uses every kind of command: colours by compute, drawn indexed as points, copied and read back.

use airglow_gpu::ash::vk;
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Blend, Buffer, ColorAttachment, ComputePipeline, ComputePipelineDesc,
    Context, Execution, GpuError, GraphicsPipeline, GraphicsPipelineDesc, Image, ImageView, Imports, Label,
    Load, Location, Record, Recorder, Rendering, Timing, VertexAttribute, VertexBufferLayout,
};
use airglow_graph::{Access, BufferDesc, Graph, ImageDesc, PassKind, State};

use crate::spirv::words;

/// Points, and pixels of the picture they are drawn to.
pub const COUNT: u32 = 1024;
/// Width of the picture.
pub const WIDTH: u32 = 64;
/// Height of the picture.
pub const HEIGHT: u32 = COUNT / WIDTH;
const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// The frame's own objects, and its plan.
pub struct Workload {
    /// The plan, ready to be recorded.
    pub execution: Execution,
    /// Its imports.
    pub imports: Imports,
    /// Timestamps of its passes.
    pub timing: Timing,
    /// The picture that the plan draws, between the two states given to [`Workload::new`].
    pub picture: Image,
}

/// What the pipelines need, for the passes to take.
struct Parts {
    compute: ComputePipeline,
    draw: GraphicsPipeline,
    indices: Buffer,
}

/// Begins to draw points, one a pixel, in colours from a vertex buffer.
///
/// # Errors
/// [`GpuError::Misuse`] for what does not fit.
pub fn begin_points(
    recorder: &mut Recorder<'_>,
    pipeline: &GraphicsPipeline,
    view: &ImageView,
    colours: &Buffer,
) -> Result<(), GpuError> {
    let colors = [ColorAttachment { view, load: Load::Clear([-1.0; 4]) }];
    recorder.begin_rendering(&Rendering { colors: &colors, depth: None })?;
    recorder.bind_graphics(pipeline, &[])?;
    recorder.push_constants(&[WIDTH, HEIGHT])?;
    recorder.bind_vertex_buffer(0, colours)
}

/// The compute pipeline of the test shader `colours`.
///
/// # Errors
/// Those of making a pipeline.
pub fn colours(context: &Context) -> Result<ComputePipeline, GpuError> {
    let bindings =
        [BindingDesc::new(0, BindingKind::StorageBuffer), BindingDesc::new(1, BindingKind::UniformBuffer)];
    let spirv = words("test/colours_compute");
    context.create_compute_pipeline(&ComputePipelineDesc {
        name: "colours",
        spirv: &spirv,
        bindings: &bindings,
        push_constant_size: 4,
    })
}

/// The pipeline that draws points, for [`begin_points`].
///
/// # Errors
/// Those of making a pipeline.
pub fn points(context: &Context) -> Result<GraphicsPipeline, GpuError> {
    let (vertex, fragment) = (words("test/points_vertex"), words("test/points_fragment"));
    let attributes = [VertexAttribute { location: 0, format: FORMAT, offset: 0 }];
    let colours =
        VertexBufferLayout { stride: 16, rate: vk::VertexInputRate::VERTEX, attributes: &attributes };
    context.create_graphics_pipeline(&GraphicsPipelineDesc {
        name: "points",
        vertex: &vertex,
        fragment: Some(&fragment),
        bindings: &[],
        push_constant_size: 8,
        vertex_buffers: &[colours],
        topology: vk::PrimitiveTopology::POINT_LIST,
        cull: vk::CullModeFlags::NONE,
        front_face: vk::FrontFace::COUNTER_CLOCKWISE,
        depth: None,
        colors: &[FORMAT],
        blend: Blend::None,
    })
}

fn parts(context: &Context) -> Result<Parts, GpuError> {
    let desc = BufferDesc { size: 4 * u64::from(COUNT), usage: vk::BufferUsageFlags::INDEX_BUFFER };
    let indices = context.create_buffer(Label::new("test", "indices"), &desc, Location::Upload)?;
    indices.write(0, &(0..COUNT).collect::<Vec<u32>>())?;
    Ok(Parts { compute: colours(context)?, draw: points(context)?, indices })
}

impl Workload {
    /// Makes everything, with a picture whose state before and after the plan is `entry` and `exit`.
    ///
    /// # Errors
    /// Those of making pipelines, buffers, images and timestamps.
    pub fn new(context: &Context, entry: State, exit: State) -> Result<Self, GpuError> {
        let Parts { compute, draw, indices } = parts(context)?;
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT
            | vk::ImageUsageFlags::TRANSFER_SRC
            | vk::ImageUsageFlags::SAMPLED;
        let desc = ImageDesc { usage, ..ImageDesc::new_2d(WIDTH, HEIGHT, FORMAT) };
        let picture = context.create_image(Label::new("test", "picture"), &desc)?;

        let mut graph: Graph<Record> = Graph::new();
        let target = graph.import_image("picture", desc, entry, exit);
        let mut pass = graph.pass("colours", PassKind::Compute);
        let size = 16 * u64::from(COUNT);
        let colours = pass.create_buffer("colours", BufferDesc::new(size), Access::ComputeStorageWrite);
        pass.record(Box::new(move |recorder, resources| {
            let tint = recorder.upload(&[[2.0f32, 0.5, 1.0, 1.0]])?;
            let bindings = [Binding::storage(0, resources.buffer(&colours)?), Binding::uniform(1, &tint)];
            recorder.bind_compute(&compute, &bindings)?;
            recorder.push_constants(&COUNT)?;
            recorder.dispatch([COUNT.div_ceil(64), 1, 1])
        }));
        let mut pass = graph.pass("draw", PassKind::Graphics);
        pass.read(&colours, Access::VertexBuffer);
        let drawn = pass.write(target, Access::ColorAttachmentWrite);
        pass.record(Box::new(move |recorder, resources| {
            begin_points(recorder, &draw, &resources.view(&drawn)?, resources.buffer(&colours)?)?;
            recorder.bind_index_buffer(&indices)?;
            recorder.draw_indexed(0..COUNT, 0, 0..1)?;
            recorder.end_rendering()
        }));
        let plan = crate::plan::compile(graph, &context.graph_limits());
        let mut imports = Imports::new();
        imports.image(&target, &picture);
        let execution = Execution::prepare(context, plan)?;
        let timing = Timing::new(context, 2, 0, 4)?;
        Ok(Self { execution, imports, timing, picture })
    }

    /// Records the plan, with timestamps.
    ///
    /// # Errors
    /// As [`Execution::record`].
    pub fn record(&mut self, recorder: &mut Recorder<'_>) -> Result<(), GpuError> {
        let (context, commands) = (recorder.context(), recorder.command_buffer());
        // SAFETY: the recorder's command buffer is recording in this frame; tests bring the picture to its entry state.
        unsafe { self.execution.record(context, commands, &self.imports, Some(&mut self.timing)) }.map(drop)
    }
}

/// The picture, in double precision: RGBA of each pixel.
pub fn reference() -> Vec<f64> {
    let colour = |i: u32| {
        let t = f64::from(i) / f64::from(COUNT);
        [2.0 * t, 0.5 * (1.0 - t), (6.0 * t).sin(), 1.0]
    };
    (0..COUNT).flat_map(colour).collect()
}
