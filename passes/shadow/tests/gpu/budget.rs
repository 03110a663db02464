//! A plan that a host's memory budget has no room for is refused, and the next settings fit.

use airglow_gpu::{AdoptInfo, Context, Execution, GpuError, Options, Record};
use airglow_graph::{Access, BufferDesc, Graph};
use airglow_shadow::{Blockers, Settings, Shadow};
use airglow_tests::device::open;
use glam::DMat4;

use crate::graph::{SPHERES, ground};

/// The shadow of two spheres on the ground, declared and prepared.
fn prepare(context: &Context, settings: Settings) -> Result<(), GpuError> {
    let positions = ground().0;
    let shadow = Shadow::new(context, settings).unwrap();
    let receivers = shadow.receivers(context, "ground", &positions).unwrap();
    let blockers = Blockers::default();
    blockers.set(&SPHERES, DMat4::IDENTITY).unwrap();
    let mut graph = Graph::<Record>::new();
    let read = Access::ComputeStorageRead;
    let desc = BufferDesc { size: size_of_val(&*positions) as u64, usage: read.buffer_usage() };
    let places = graph.import_buffer("positions", desc, read, read);
    let shadowed = shadow.add(&mut graph, &receivers, &blockers, places, None);
    graph.export(shadowed.visibility.unwrap(), read);
    Execution::prepare(context, graph.compile(&context.graph_limits()).unwrap()).map(drop)
}

#[test]
fn a_refused_plan_leaves_room_for_the_next_settings() {
    let device = open(&Shadow::requirements());
    let adopt = |memory_budget| {
        let mut extensions = Vec::new();
        let options = Options { memory_budget, ..Options::default() };
        let info = AdoptInfo { options, ..device.adopt_info(&mut extensions, 1) };
        // SAFETY: nothing is submitted; the context is dropped before the device.
        unsafe { Context::adopt(info) }.unwrap()
    };
    let settings = Settings::default();
    // 300 receivers take 19,200 bytes of visibility in order 4 and 10,800 in order 3.
    let context = adopt(None);
    prepare(&context, settings).unwrap();
    let tables: u64 =
        context.memory_report().iter().filter(|of| of.owner == "shadow").map(|of| of.bytes).sum();
    drop(context);
    let context = adopt(Some(tables + 15_000));
    let refused = prepare(&context, settings).unwrap_err();
    let GpuError::Budget { size, held, budget, .. } = refused else { panic!("{refused}") };
    assert!(size >= settings.visibility_bytes(300), "{refused}");
    let next = settings.next_that_fits(300, budget - held).unwrap();
    assert_eq!(next.order, 3, "{refused}");
    drop(context);
    prepare(&adopt(Some(tables + 15_000)), next).unwrap();
    assert!(settings.next_that_fits(300, 10_000).is_none());
}
