//! What stands in the plan, and that what is stated in Rust is what the shader has. Without a device.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail the test they are called from")]

use std::path::Path;

use airglow___room__::{BINDINGS, PushConstants, Settings, declare};
use airglow_graph::{Access, BufferDesc, Graph, Limits, Plan};
use airglow_tests::golden::assert_text;
use airglow_tests::host_layout;
use airglow_tests::reflect::Module;

fn plan(stops: f64, count: u32) -> Plan<()> {
    let mut graph = Graph::new();
    let usage = Access::ComputeStorageRead.buffer_usage();
    let desc = BufferDesc { size: 1600, usage };
    let colours =
        graph.import_buffer("colours", desc, Access::ComputeStorageWrite, Access::ComputeStorageRead);
    let exposed = declare(&mut graph, &Settings { stops }, colours, count, |_, _| ());
    let mut draw = graph.pass("draw", airglow_graph::PassKind::Graphics);
    draw.read(&exposed, Access::VertexStorageRead).side_effect().record(());
    airglow_tests::plan::compile(graph, &Limits::default())
}

#[test]
fn the_plan_is_as_written_down() {
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/plans/expose.txt");
    assert_text(&golden, &plan(1.5, 100).text());
}

#[test]
fn what_changes_nothing_is_left_out() {
    for (stops, count, why) in [(0.0, 100, "0 stops"), (1.5, 0, "no colours")] {
        let plan = plan(stops, count);
        assert_eq!(plan.steps().len(), 1, "{}", plan.text());
        assert!(plan.left_out()[0].why.contains(why), "{:?}", plan.left_out());
    }
}

#[test]
fn what_rust_states_is_what_the_shader_has() {
    let module = Module::load("__room__/expose.spv").unwrap();
    module.assert_bindings(&BINDINGS);
    let block = module.push_constants.as_ref().expect("the shader has push constants");
    block.assert_matches(&host_layout!(PushConstants { count, factor }));
}
