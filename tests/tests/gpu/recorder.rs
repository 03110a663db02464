//! What a recorder refuses: calls that Vulkan does not allow become errors that say so, and nothing is recorded.

use airglow_gpu::ash::vk;
use airglow_gpu::{
    Binding, Blend, ColorAttachment, DepthAttachment, DepthState, GpuError, GraphicsPipelineDesc, Label,
    Load, Location, Recorder, Rendering,
};
use airglow_graph::{Access, BufferDesc, ImageDesc, State};
use airglow_tests::colours::{self, BYTES, storage};
use airglow_tests::device::fixture;
use airglow_tests::spirv::words;

fn error<T>(result: Result<T, GpuError>) -> String {
    result.err().expect("this must be refused").to_string()
}

#[test]
fn misuse_is_refused_before_it_is_recorded() {
    let fixture = fixture();
    let context = fixture.context();
    let pipeline = colours::pipeline(context);
    let buffer = storage(context, "test", BYTES);
    let uniform_only = BufferDesc { size: 64, usage: vk::BufferUsageFlags::UNIFORM_BUFFER };
    let uniform =
        context.create_buffer(Label::new("test", "uniform"), &uniform_only, Location::Device).unwrap();
    let (storage_0, uniform_1) = (Binding::storage(0, &buffer), Binding::uniform(1, &uniform));
    let refused = |problem: &str, run: &dyn Fn(&mut Recorder<'_>) -> Result<(), GpuError>| {
        let message = error(fixture.device().run(context, run));
        assert!(message.contains(problem), "expected `{problem}`, got `{message}`");
    };
    refused("binding 1 (UniformBuffer) is not given", &|r| {
        r.bind_compute(&pipeline, std::slice::from_ref(&storage_0))
    });
    refused("binding 0 is given twice", &|r| {
        r.bind_compute(&pipeline, &[storage_0.clone(), storage_0.clone(), uniform_1.clone()])
    });
    refused("binding 0 is StorageBuffer, given UniformBuffer", &|r| {
        r.bind_compute(&pipeline, &[Binding::uniform(0, &uniform), uniform_1.clone()])
    });
    refused("made without STORAGE_BUFFER", &|r| {
        r.bind_compute(&pipeline, &[Binding::storage(0, &uniform), uniform_1.clone()])
    });
    refused("is no multiple of", &|r| {
        let odd = buffer.slice(4, 64)?;
        r.bind_compute(&pipeline, &[Binding::storage(0, odd), uniform_1.clone()])
    });
    refused("bind a pipeline first", &|r| r.dispatch([1; 3]));
    refused("give it its push constants first", &|r| {
        r.bind_compute(&pipeline, &[storage_0.clone(), uniform_1.clone()])?;
        r.dispatch([1; 3])
    });
    refused("8 bytes of push constants given, 4 stated", &|r| {
        r.bind_compute(&pipeline, &[storage_0.clone(), uniform_1.clone()])?;
        r.push_constants(&[1u32, 2])
    });
    refused("maxComputeWorkGroupCount", &|r| {
        r.bind_compute(&pipeline, &[storage_0.clone(), uniform_1.clone()])?;
        r.push_constants(&1u32)?;
        r.dispatch([u32::MAX, 1, 1])
    });
    refused("bind a graphics pipeline", &|r| {
        r.bind_compute(&pipeline, &[storage_0.clone(), uniform_1.clone()])?;
        r.push_constants(&1u32)?;
        r.draw(0..3, 0..1)
    });
    refused("overlap", &|r| r.copy_buffer(buffer.slice(0, 64)?, buffer.slice(32, 64)?));
    refused("not within its", &|r| r.fill(buffer.slice(BYTES - 4, 8)?, 0));
    refused("not mapped", &|_| buffer.write(0, &[1u32]));
    let usage = vk::ImageUsageFlags::SAMPLED;
    let huge = ImageDesc { usage, ..ImageDesc::new_2d(1 << 20, 4, vk::Format::R8G8B8A8_UNORM) };
    let message = error(context.create_image(Label::new("test", "huge"), &huge));
    assert!(message.contains("huge: 1048576 x 4 x 1 texels; the device allows"), "{message}");
}

/// A pipeline that writes depth only, made for an attachment that is tested with `compare`.
fn depth_desc<'a>(name: &'a str, vertex: &'a [u32], compare: vk::CompareOp) -> GraphicsPipelineDesc<'a> {
    GraphicsPipelineDesc {
        name,
        vertex,
        fragment: None,
        bindings: &[],
        push_constant_size: 0,
        vertex_buffers: &[],
        topology: vk::PrimitiveTopology::TRIANGLE_LIST,
        cull: vk::CullModeFlags::NONE,
        front_face: vk::FrontFace::COUNTER_CLOCKWISE,
        depth: Some(DepthState { format: vk::Format::D32_SFLOAT, compare, write: true }),
        colors: &[],
        blend: Blend::None,
    }
}

#[test]
fn depth_is_tested_and_written_and_attachments_must_fit() {
    let fixture = fixture();
    let context = fixture.context();
    let vertex = words("test/rectangle");
    let less = depth_desc("less", &vertex, vk::CompareOp::LESS);
    let greater = depth_desc("greater", &vertex, vk::CompareOp::GREATER);
    let [less, greater] = [less, greater].map(|desc| context.create_graphics_pipeline(&desc).unwrap());
    let usage = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
    let desc = ImageDesc { usage, ..ImageDesc::new_2d(8, 4, vk::Format::D32_SFLOAT) };
    let image = context.create_image(Label::new("test", "depth"), &desc).unwrap();
    let view = image.full_view().unwrap();
    let attachment = DepthAttachment { view: &view, load: Load::Clear(0.5), write: true };
    let draw = |recorder: &mut Recorder<'_>, pipeline, depth: DepthAttachment<'_>| {
        recorder.transition(&image, State::UNDEFINED, Access::DepthAttachmentWrite)?;
        recorder.begin_rendering(&Rendering { colors: &[], depth: Some(depth) })?;
        recorder.bind_graphics(pipeline, &[])?;
        recorder.draw(0..3, 0..1)?;
        recorder.end_rendering()
    };
    for (pipeline, expected) in [(&less, 0.0), (&greater, 0.5)] {
        let copy = fixture.device().run(context, |recorder| {
            draw(recorder, pipeline, attachment)?;
            recorder.transition(&image, Access::DepthAttachmentWrite, Access::TransferSource)?;
            recorder.read_back_image(&view)
        });
        let depths = copy.unwrap().texels().unwrap();
        assert_eq!(depths, vec![[expected, 0.0, 0.0, 1.0]; 32], "{}", pipeline.name());
    }
    let refused = |problem: &str, run: &dyn Fn(&mut Recorder<'_>) -> Result<(), GpuError>| {
        let message = error(fixture.device().run(context, run));
        assert!(message.contains(problem), "expected `{problem}`, got `{message}`");
    };
    let read_only = DepthAttachment { load: Load::Keep, write: false, ..attachment };
    refused("writes depth, but the attachment is read only", &|r| draw(r, &less, read_only));
    refused("is kept, not cleared", &|r| draw(r, &less, DepthAttachment { write: false, ..attachment }));
    refused("made without COLOR_ATTACHMENT", &|r| {
        let colors = [ColorAttachment { view: &view, load: Load::Discard }];
        r.begin_rendering(&Rendering { colors: &colors, depth: None })
    });
    refused("there is no attachment", &|r| r.begin_rendering(&Rendering { colors: &[], depth: None }));
    refused("begin rendering first", &|r| {
        r.bind_graphics(&less, &[])?;
        r.draw(0..3, 0..1)
    });
}
