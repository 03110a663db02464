//! Rendering to a vertex array, both ways: a compute pass writes the vertex buffer, or a fragment pass renders a packed
//! rectangle that is copied into it. Both are drawn, read back, and give the same bits, in every legal order.

use airglow_gpu::ash::vk;
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Blend, ColorAttachment, ComputePipelineDesc, Context, Execution,
    GpuError, GraphicsPipelineDesc, Imports, Label, Load, Record, Rendering, VertexAttribute,
    VertexBufferLayout,
};
use airglow_graph::{
    Access, Buffer, BufferDesc, Graph, Handle, Image, ImageDesc, Options, PassKind, Plan, State,
};
use airglow_tests::compare::{assert_close, assert_same_bits};
use airglow_tests::device::{Fixture, fixture};
use airglow_tests::plan::compile_with;
use airglow_tests::spirv::words;
use airglow_tests::workload::{HEIGHT, WIDTH, begin_points};
use std::collections::BTreeSet;

/// Vertices; not a multiple of the width, so that the copy ends within a row.
const COUNT: u32 = 1000;
const TINT: [f32; 4] = [2.0, 0.5, 1.0, 1.0];
const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const TINT_BINDING: BindingDesc = BindingDesc::new(1, BindingKind::UniformBuffer);

/// The colours as the shaders compute them, in double precision.
fn reference() -> Vec<f64> {
    let color = |i: u32| {
        let t = f64::from(i) / f64::from(COUNT);
        let color = [t, 1.0 - t, (6.0 * t).sin(), 1.0];
        std::array::from_fn::<_, 4, _>(|c| color[c] * f64::from(TINT[c]))
    };
    (0..COUNT).flat_map(color).collect()
}

/// A triangle list over a rectangle, or a list of points with a colour each.
fn draw_desc<'a>(
    name: &'a str,
    vertex: &'a [u32],
    fragment: &'a [u32],
    topology: vk::PrimitiveTopology,
) -> GraphicsPipelineDesc<'a> {
    GraphicsPipelineDesc {
        name,
        vertex,
        fragment: Some(fragment),
        bindings: &[],
        push_constant_size: 8,
        vertex_buffers: &[],
        topology,
        cull: vk::CullModeFlags::NONE,
        front_face: vk::FrontFace::COUNTER_CLOCKWISE,
        depth: None,
        colors: &[FORMAT],
        blend: Blend::None,
    }
}

fn add_compute(context: &Context, graph: &mut Graph<Record>) -> Result<Handle<Buffer>, GpuError> {
    let pipeline = context.create_compute_pipeline(&ComputePipelineDesc {
        name: "colours",
        spirv: &words("test/colours_compute"),
        bindings: &[BindingDesc::new(0, BindingKind::StorageBuffer), TINT_BINDING],
        push_constant_size: 4,
    })?;
    let mut pass = graph.pass("colours", PassKind::Compute);
    let size = u64::from(COUNT) * 16;
    let colours = pass.create_buffer("colours", BufferDesc::new(size), Access::ComputeStorageWrite);
    pass.record(Box::new(move |recorder, resources| {
        let tint = recorder.upload(&[TINT])?;
        let buffer = resources.buffer(&colours)?;
        recorder.bind_compute(&pipeline, &[Binding::storage(0, buffer), Binding::uniform(1, &tint)])?;
        recorder.push_constants(&COUNT)?;
        recorder.dispatch([COUNT.div_ceil(64), 1, 1])
    }));
    Ok(colours)
}

fn add_fragment(context: &Context, graph: &mut Graph<Record>) -> Result<Handle<Buffer>, GpuError> {
    let (vertex, fragment) = (words("test/rectangle"), words("test/colours_fragment"));
    let pipeline = context.create_graphics_pipeline(&GraphicsPipelineDesc {
        bindings: &[TINT_BINDING],
        ..draw_desc("colours", &vertex, &fragment, vk::PrimitiveTopology::TRIANGLE_LIST)
    })?;
    let mut pass = graph.pass("colours", PassKind::Graphics);
    let packed = ImageDesc::new_2d(WIDTH, HEIGHT, FORMAT);
    let packed = pass.create_image("packed colours", packed, Access::ColorAttachmentWrite);
    pass.record(Box::new(move |recorder, resources| {
        let tint = recorder.upload(&[TINT])?;
        let view = resources.view(&packed)?;
        let colors = [ColorAttachment { view: &view, load: Load::Discard }];
        recorder.begin_rendering(&Rendering { colors: &colors, depth: None })?;
        recorder.bind_graphics(&pipeline, &[Binding::uniform(1, &tint)])?;
        recorder.push_constants(&[COUNT, WIDTH])?;
        recorder.draw(0..3, 0..1)?;
        recorder.end_rendering()
    }));
    let mut pass = graph.pass("copy to vertices", PassKind::Transfer);
    pass.read(&packed, Access::TransferSource);
    let size = u64::from(COUNT) * 16;
    let colours = pass.create_buffer("colours", BufferDesc::new(size), Access::TransferDestination);
    pass.record(Box::new(move |recorder, resources| {
        recorder.copy_image_to_buffer(&resources.view(&packed)?, resources.buffer(&colours)?)
    }));
    Ok(colours)
}

type Road = fn(&Context, &mut Graph<Record>) -> Result<Handle<Buffer>, GpuError>;

/// Adds a draw of each vertex as a point on its own pixel.
fn add_draw(
    context: &Context,
    graph: &mut Graph<Record>,
    target: Handle<Image>,
    colours: Handle<Buffer>,
) -> Result<(), GpuError> {
    let (vertex, fragment) = (words("test/points_vertex"), words("test/points_fragment"));
    let attributes = [VertexAttribute { location: 0, format: FORMAT, offset: 0 }];
    let colour_buffer =
        VertexBufferLayout { stride: 16, rate: vk::VertexInputRate::VERTEX, attributes: &attributes };
    let pipeline = context.create_graphics_pipeline(&GraphicsPipelineDesc {
        vertex_buffers: &[colour_buffer],
        ..draw_desc("points", &vertex, &fragment, vk::PrimitiveTopology::POINT_LIST)
    })?;
    let mut pass = graph.pass("draw", PassKind::Graphics);
    pass.read(&colours, Access::VertexBuffer);
    let drawn = pass.write(target, Access::ColorAttachmentWrite);
    pass.record(Box::new(move |recorder, resources| {
        begin_points(recorder, &pipeline, &resources.view(&drawn)?, resources.buffer(&colours)?)?;
        recorder.draw(0..COUNT, 0..1)?;
        recorder.end_rendering()
    }));
    Ok(())
}

/// A picture by each road, all in one frame, and the order its passes ran in.
fn draw(
    fixture: &Fixture,
    roads: &[Road],
    seed: Option<u64>,
    prepare: fn(&Context, Plan<Record>) -> Result<Execution, GpuError>,
) -> Result<(Vec<Vec<f32>>, Vec<String>), GpuError> {
    let context = fixture.context();
    let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
    let desc = ImageDesc { usage, ..ImageDesc::new_2d(WIDTH, HEIGHT, FORMAT) };
    let mut graph: Graph<Record> = Graph::new();
    let mut imports = Imports::new();
    let mut pictures = Vec::new();
    for road in roads {
        let picture = context.create_image(Label::new("test", "picture"), &desc)?;
        let target = graph.import_image("picture", desc, State::UNDEFINED, Access::TransferSource);
        let colours = road(context, &mut graph)?;
        add_draw(context, &mut graph, target, colours)?;
        imports.image(&target, &picture);
        pictures.push(picture);
    }
    let options = Options { seed, ..Options::default() };
    let plan = compile_with(graph, &context.graph_limits(), &options);
    let order = plan.steps().iter().map(|step| step.name.to_string()).collect();
    let mut execution = prepare(context, plan)?;
    // Twice, so that the second recording meets what the first left behind.
    let mut pictures_back = Vec::new();
    for _ in 0..2 {
        let readbacks = fixture.device().run(context, |recorder| {
            // SAFETY: a recording command buffer of this frame; the pictures' contents do not matter on entry.
            unsafe { execution.record(context, recorder.command_buffer(), &imports, None)? };
            pictures.iter().map(|p| recorder.read_back_image(&p.full_view()?)).collect::<Result<Vec<_>, _>>()
        })?;
        pictures_back = readbacks.iter().map(|r| r.texels()).collect::<Result<Vec<_>, _>>()?;
    }
    Ok((pictures_back.into_iter().map(|texels| texels.into_iter().flatten().collect()).collect(), order))
}

#[test]
fn compute_and_fragment_pass_draw_the_same_bits() {
    let fixture = fixture();
    let values = COUNT as usize * 4;
    let by_compute = draw(&fixture, &[add_compute], None, Execution::prepare).unwrap().0.remove(0);
    let by_fragment = draw(&fixture, &[add_fragment], None, Execution::prepare).unwrap().0.remove(0);
    assert_close("compute pass", &by_compute[..values], &reference(), 1e-6, 1e-6);
    assert_same_bits("fragment pass", &by_fragment, &by_compute);
    let untouched = &by_compute[values..];
    assert!(
        untouched.iter().all(|&value| value == -1.0),
        "pixels without a vertex stay clear: {untouched:?}"
    );
}

#[test]
fn every_legal_order_draws_the_same_bits() {
    let fixture = fixture();
    let roads: [Road; 3] = [add_compute, add_fragment, add_compute];
    let (expected, declared) = draw(&fixture, &roads, None, Execution::prepare).unwrap();
    let mut orders = BTreeSet::from([declared]);
    for seed in 0..8 {
        let (pictures, order) = draw(&fixture, &roads, Some(seed), Execution::prepare).unwrap();
        for (road, (picture, expected)) in pictures.iter().zip(&expected).enumerate() {
            assert_same_bits(&format!("road {road} in order {order:?}"), picture, expected);
        }
        orders.insert(order);
    }
    println!("{} orders of {} passes gave the same bits", orders.len(), 7);
    assert!(orders.len() > 4, "the seeds shuffle too little: {orders:?}");
}

/// Both ways of making the plan's transients, and what the second takes.
#[test]
fn transients_in_shared_memory_draw_the_same_bits() {
    let fixture = fixture();
    let roads: [Road; 4] = [add_compute, add_fragment, add_compute, add_fragment];
    let (expected, _) = draw(&fixture, &roads, None, Execution::prepare).unwrap();
    let shared: fn(&Context, Plan<Record>) -> Result<Execution, GpuError> = |context, plan| {
        let held = |context: &Context| {
            context.memory_report().iter().find(|of| of.owner == "transient").map_or(0, |of| of.bytes)
        };
        let before = held(context);
        let execution = Execution::prepare_shared(context, plan)?;
        let sharing = execution.sharing().expect("one memory type for all");
        airglow_checker::check_sharing(execution.plan(), sharing).expect("sound places");
        let (bytes, taken) = (execution.plan().bytes(), held(context) - before);
        println!("{} bytes apart, {taken} shared, {} waits", bytes.transient, sharing.handovers.len());
        assert!(sharing.saved() > 0 && taken < bytes.transient, "{taken} of {bytes:?}");
        Ok(execution)
    };
    for seed in [None, Some(1), Some(2), Some(3)] {
        let (pictures, order) = draw(&fixture, &roads, seed, shared).unwrap();
        for (picture, expected) in pictures.iter().zip(&expected) {
            assert_same_bits(&format!("shared, in order {order:?}"), picture, expected);
        }
    }
}
