//! Plans printed and compared with text files. `AIRGLOW_BLESS=1` rewrites the files.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, its helpers too")]

use airglow_graph::{Access, BufferDesc, Graph, ImageDesc, LeftOut, Limits, PassKind, Plan, State};
use ash::vk;
use std::path::Path;

/// A frame as a host would declare it: light to SH, relighting to a vertex buffer by both ways, the host's own
/// draw, and what is culled and left out.
fn frame() -> Graph<&'static str> {
    let mut graph = Graph::new();
    graph.pipelines("relight", 4);
    let sampled = vk::ImageUsageFlags::SAMPLED;
    let float4 = vk::Format::R32G32B32A32_SFLOAT;
    let environment = ImageDesc { usage: sampled, ..ImageDesc::new_2d(1024, 512, float4) };
    let ready = State::of(Access::ComputeSampled);
    let environment = graph.import_image("environment", environment, ready, ready);
    let transfer = BufferDesc { size: 64 * 1000, usage: vk::BufferUsageFlags::STORAGE_BUFFER };
    let idle = State::idle(vk::ImageLayout::UNDEFINED);
    let transfer = graph.import_buffer("transfer", transfer, idle, idle);
    let color = vk::ImageUsageFlags::COLOR_ATTACHMENT | sampled;
    let hdr = ImageDesc { usage: color, ..ImageDesc::new_2d(640, 480, vk::Format::R16G16B16A16_SFLOAT) };
    let hdr = graph.import_image("hdr", hdr, Access::FragmentSampled, Access::FragmentSampled);

    let mut project = graph.pass("project environment", PassKind::Compute);
    project.read(&environment, Access::ComputeSampled).async_suitable();
    let light = project.create_buffer("light", BufferDesc::new(256), Access::ComputeStorageWrite);
    project.record("project");

    let left_out = LeftOut {
        what: "near emitters".to_owned(),
        why: "the scene has none".to_owned(),
        bytes: 4096,
        time: Some(0.000_25),
        would_return: "an emitter in the scene".to_owned(),
    };
    let light = graph.forward(light, left_out);

    let mut relight = graph.pass("relight", PassKind::Compute);
    relight.read(&light, Access::ComputeUniform).read(&transfer, Access::ComputeStorageRead);
    let colours = relight.create_buffer("colours", BufferDesc::new(16_000), Access::ComputeStorageWrite);
    relight.record("relight");

    let mut packed = graph.pass("relight by fragments", PassKind::Graphics);
    packed.read(&light, Access::FragmentUniform).read(&transfer, Access::FragmentStorageRead);
    let rectangle = ImageDesc::new_2d(32, 32, float4);
    let rectangle = packed.create_image("rectangle", rectangle, Access::ColorAttachmentWrite);
    packed.record("fragments");
    let mut copy = graph.pass("copy to vertices", PassKind::Transfer);
    copy.read(&rectangle, Access::TransferSource);
    let copied = copy.create_buffer("copied colours", BufferDesc::new(16_384), Access::TransferDestination);
    copy.record("copy");

    let mut preview = graph.pass("preview", PassKind::Compute);
    preview.read(&light, Access::ComputeUniform);
    preview.create_buffer("preview", BufferDesc::new(64), Access::ComputeStorageWrite);
    preview.record("preview");

    let depth = graph.create_image("depth", ImageDesc::new_2d(640, 480, vk::Format::D32_SFLOAT));
    let mut draw = graph.pass("draw", PassKind::Graphics);
    draw.read(&colours, Access::VertexBuffer).read(&copied, Access::VertexBuffer);
    draw.write(hdr, Access::ColorAttachmentWrite);
    draw.write(depth, Access::DepthAttachmentWrite);
    draw.record("draw");
    graph
}

fn plan() -> Plan<&'static str> {
    frame().compile(&Limits::default()).unwrap()
}

/// Compares with `tests/golden/NAME`, or rewrites it on request.
fn compare(name: &str, actual: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
    if std::env::var_os("AIRGLOW_BLESS").is_some() {
        std::fs::write(&path, actual).unwrap();
    }
    let expected = std::fs::read_to_string(&path).unwrap();
    assert!(actual == expected, "{name} differs; expected\n{expected}\nactual\n{actual}");
}

#[test]
fn the_frame_prints_as_it_did() {
    let plan = plan();
    compare("frame.txt", &plan.text());
    compare("frame.mermaid", &plan.mermaid());
    compare("frame.json", &(plan.json().unwrap() + "\n"));
}

#[test]
fn the_frame_is_synchronised_and_every_barrier_needed() {
    let trace = airglow_checker::Trace::of(&plan());
    let report = trace.check().unwrap();
    assert!(report.redundant.is_empty() && report.barriers == 11, "{report}");
    assert_eq!(trace.excess(), []);
}

#[test]
fn payloads_go_with_their_steps() {
    let mut names = Vec::new();
    let plan = plan().map_payload(|name, payload| {
        names.push(name.to_owned());
        payload.len()
    });
    let payloads: Vec<usize> = plan.steps().iter().map(|step| step.payload).collect();
    assert_eq!(names, ["project environment", "relight", "relight by fragments", "copy to vertices", "draw"]);
    assert_eq!(payloads, [7, 7, 9, 4, 4]);
    assert_eq!(plan.left_out().len(), 1);
    assert_eq!(plan.culled().len(), 1);
}

#[test]
fn a_pass_without_payload_is_named() {
    let mut graph = Graph::<()>::new();
    graph.pass("empty", PassKind::Compute);
    let message = graph.compile(&Limits::default()).map(|_| ()).unwrap_err().to_string();
    assert_eq!(message, "pass `empty`: has no payload; end its declaration with `record`");
}

#[test]
fn names_taken_are_numbered() {
    let mut graph = Graph::<()>::new();
    for _ in 0..2 {
        let mut pass = graph.pass("relight", PassKind::Compute);
        let buffer = pass.create_buffer("colours", BufferDesc::new(4), Access::ComputeStorageWrite);
        pass.record(());
        graph.export(buffer, Access::VertexBuffer);
    }
    let plan = graph.compile(&Limits::default()).unwrap();
    assert_eq!(plan.steps()[1].name, "relight#2");
    assert_eq!(plan.resources()[1].name, "colours#2");
}
