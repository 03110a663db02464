//! The barriers of small graphs, field by field.

use super::barriers::{PlanBarriers, barriers};
use super::validate::validate;
use crate::plan::{BufferBarrier, Cause};
use crate::{Access, BufferDesc, Graph, ImageDesc, ImageRange, Limits, PassKind, State};
use ash::vk::{self, AccessFlags2 as A, ImageLayout as L, PipelineStageFlags2 as S};

/// The barriers with every pass in the order declared.
fn run(graph: &mut Graph<()>) -> PlanBarriers {
    validate(&mut graph.declaration, &Limits::default()).unwrap();
    let order: Vec<usize> = (0..graph.declaration.passes.len()).collect();
    barriers(&graph.declaration, &order, &Limits::default())
}

fn scopes(b: &BufferBarrier) -> ((S, A), (S, A), Cause) {
    ((b.src_stage, b.src_access), (b.dst_stage, b.dst_access), b.cause)
}

#[test]
fn compute_to_vertex_input_is_one_barrier_for_all_readers_and_none_between_them() {
    let mut graph = Graph::new();
    let desc = BufferDesc::new(64);
    let b = graph.pass("0", PassKind::Compute).create_buffer("b", desc, Access::ComputeStorageWrite);
    graph.pass("1", PassKind::Graphics).read(&b, Access::VertexBuffer);
    graph.pass("2", PassKind::Graphics).read(&b, Access::VertexStorageRead);
    let plan = run(&mut graph);
    let written = (S::COMPUTE_SHADER, A::SHADER_STORAGE_WRITE);
    let stages = S::VERTEX_ATTRIBUTE_INPUT | S::VERTEX_SHADER;
    let read = (stages, A::VERTEX_ATTRIBUTE_READ | A::SHADER_STORAGE_READ);
    assert_eq!(scopes(&plan.steps[1].buffers[0]), (written, read, Cause::ReadAfterWrite));
    assert!(plan.steps[2].is_empty());
    // The next execution's write waits for this one's reads, without a memory dependency.
    let (waits, runs) = ((stages, A::NONE), (S::COMPUTE_SHADER, A::NONE));
    assert_eq!(scopes(&plan.steps[0].buffers[0]), (waits, runs, Cause::WriteAfterRead));
    assert!(plan.exits.is_empty());
}

#[test]
fn fragment_pass_then_copy_reaches_vertex_input() {
    let mut graph = Graph::new();
    let packed = ImageDesc::new_2d(8, 8, vk::Format::R32G32B32A32_SFLOAT);
    let mut draw = graph.pass("draw", PassKind::Graphics);
    let image = draw.create_image("packed", packed, Access::ColorAttachmentWrite);
    let mut copy = graph.pass("copy", PassKind::Transfer);
    copy.read(&image, Access::TransferSource);
    let buffer = copy.create_buffer("colours", BufferDesc::new(1024), Access::TransferDestination);
    graph.pass("shade", PassKind::Graphics).read(&buffer, Access::VertexBuffer);
    let plan = run(&mut graph);
    let to_source = plan.steps[1].images[0];
    assert_eq!(
        (to_source.old_layout, to_source.new_layout),
        (L::COLOR_ATTACHMENT_OPTIMAL, L::TRANSFER_SRC_OPTIMAL)
    );
    assert_eq!(to_source.src_access, A::COLOR_ATTACHMENT_WRITE);
    let (copied, fetched) =
        ((S::ALL_TRANSFER, A::TRANSFER_WRITE), (S::VERTEX_ATTRIBUTE_INPUT, A::VERTEX_ATTRIBUTE_READ));
    assert_eq!(scopes(&plan.steps[2].buffers[0]), (copied, fetched, Cause::ReadAfterWrite));
    assert_eq!(plan.steps[0].images[0].old_layout, L::UNDEFINED);
}

#[test]
fn a_mip_chain_joins_layers_and_moves_one_mip_at_a_time() {
    let mut graph = Graph::new();
    let desc = ImageDesc {
        mips: 3,
        layers: 6,
        cube: true,
        ..ImageDesc::new_2d(4, 4, vk::Format::R16G16B16A16_SFLOAT)
    };
    let mut image = graph.create_image("cube", desc);
    image = graph.pass("mip 0", PassKind::Compute).write(image.mip(0), Access::ComputeStorageWrite);
    for mip in 1..3 {
        let mut pass = graph.pass("down", PassKind::Compute);
        pass.read(&image.mip(mip - 1), Access::ComputeSampled);
        image = pass.write(image.mip(mip), Access::ComputeStorageWrite);
    }
    graph.export(image.whole(), Access::FragmentSampled);
    let plan = run(&mut graph);
    let range = |base_mip, mips| ImageRange { base_mip, mips, base_layer: 0, layers: 6 };
    let ranges: Vec<_> = plan.steps[2].images.iter().map(|b| b.range).collect();
    assert_eq!(ranges, [range(1, 1), range(2, 1)]);
    // Mips 0 and 1 were made visible to the fragment shader with the compute read; mip 2 is left to the end.
    assert_eq!(plan.exits.images.iter().map(|b| b.range).collect::<Vec<_>>(), [range(2, 1)]);
}

#[test]
fn another_queue_family_is_acquired_and_given_back_without_a_layout_change() {
    for family in [3, vk::QUEUE_FAMILY_EXTERNAL, vk::QUEUE_FAMILY_FOREIGN_EXT] {
        let mut graph = Graph::new();
        let desc = ImageDesc {
            usage: vk::ImageUsageFlags::STORAGE,
            ..ImageDesc::new_2d(4, 4, vk::Format::R32_SFLOAT)
        };
        let hosts = State::of(Access::FragmentSampled).on_queue_family(family);
        let image = graph.import_image("hdr", desc, hosts, hosts);
        graph.pass("p", PassKind::Compute).write(image, Access::ComputeStorageReadWrite);
        let plan = run(&mut graph);
        let (acquire, release) = (plan.acquires.images[0], plan.releases.images[0]);
        assert_eq!((acquire.src_queue_family, acquire.dst_queue_family), (family, 0));
        assert_eq!((release.src_queue_family, release.dst_queue_family), (0, family));
        for barrier in [acquire, release] {
            assert_eq!(
                (barrier.old_layout, barrier.new_layout),
                (L::SHADER_READ_ONLY_OPTIMAL, L::SHADER_READ_ONLY_OPTIMAL)
            );
        }
        assert_eq!(plan.steps[0].images[0].new_layout, L::GENERAL);
        assert_eq!(plan.exits.images[0].src_access, A::SHADER_STORAGE_WRITE);
    }
}

#[test]
fn an_import_found_and_left_where_it_is_read_needs_nothing() {
    let mut graph = Graph::new();
    let desc = BufferDesc { size: 4, usage: vk::BufferUsageFlags::STORAGE_BUFFER };
    let state = State::of(Access::ComputeStorageRead);
    let buffer = graph.import_buffer("transfer", desc, state, state);
    let untouched = State::of(Access::HostWrite);
    graph.import_buffer("untouched", desc, untouched, untouched);
    graph.pass("p", PassKind::Compute).read(&buffer, Access::ComputeStorageRead);
    let plan = run(&mut graph);
    assert!(plan.steps[0].is_empty() && plan.exits.is_empty());
}
