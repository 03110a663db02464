//! On the device: every setting of the sweep against the f64 reference, by both roads.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail the test they are called from")]

use std::sync::Arc;
use std::sync::Mutex;

use airglow___room__::{ACCESSES, Bindings, Settings, curve, reference, __Room__};
use airglow_gpu::{Buffer, Execution, GpuError, Imports, Label, Location, Recorder};
use airglow_graph::{Access, BufferDesc, Graph, PassKind};
use airglow_tests::compare::{assert_same_bits, worst_against};
use airglow_tests::device::{Fixture, fixture_with};

/// Not a multiple of the workgroup.
const COUNT: u32 = 1000;

/// Colours over seven decades, alphas in [0, 1).
fn colours() -> Vec<[f32; 4]> {
    (0..COUNT)
        .map(|i| {
            let t = i as f32 / COUNT as f32;
            [10f32.powf(7.0 * t - 4.0), 3.0 * t, -t, t]
        })
        .collect()
}

/// The colours on the device, visible to [`ACCESSES`].
fn upload(fixture: &Fixture) -> Buffer {
    let desc = BufferDesc { size: 16 * u64::from(COUNT), usage: Access::ComputeStorageRead.buffer_usage() };
    let buffer = fixture.context().create_buffer(Label::new("host", "colours"), &desc, Location::Upload).unwrap();
    buffer.write(0, &colours()).unwrap();
    buffer
}

/// By the road without a graph: the host's own buffers, accesses and commands.
fn without_graph(fixture: &Fixture, pass: &__Room__) -> Vec<f32> {
    let context = fixture.context();
    let usage = ACCESSES[1].1.buffer_usage() | Access::TransferSource.buffer_usage();
    let desc = BufferDesc { size: 16 * u64::from(COUNT), usage };
    let target = context.create_buffer(Label::new("host", "exposed"), &desc, Location::Device).unwrap();
    let bindings = Bindings { colours: (&upload(fixture)).into(), exposed: (&target).into() };
    let record = |recorder: &mut Recorder<'_>| {
        pass.record(recorder, &bindings, COUNT)?;
        recorder.memory_barrier(ACCESSES[1].1, Access::TransferSource)?;
        recorder.read_back_buffer(&target)
    };
    fixture.device().run(context, record).unwrap().read().unwrap()
}

/// By the road of the graph.
fn with_graph(fixture: &Fixture, pass: &__Room__) -> Vec<f32> {
    let context = fixture.context();
    let source = upload(fixture);
    let mut graph = Graph::new();
    let entry = Access::HostWrite;
    let colours = graph.import_buffer("colours", *source.desc(), entry, Access::ComputeStorageRead);
    let exposed = pass.add(&mut graph, colours, COUNT);
    let slot = Arc::new(Mutex::new(None));
    let filled = Arc::clone(&slot);
    let mut read = graph.pass("read back", PassKind::Transfer);
    read.read(&exposed, Access::TransferSource).side_effect();
    read.record(Box::new(move |recorder, resources| {
        *filled.lock().unwrap() = Some(recorder.read_back_buffer(resources.buffer(&exposed)?)?);
        Ok(())
    }));
    let plan = airglow_tests::plan::compile(graph, &context.graph_limits());
    let mut execution = Execution::prepare(context, plan).unwrap();
    let mut imports = Imports::new();
    imports.buffer(&colours, &source);
    let record = |recorder: &mut Recorder<'_>| -> Result<(), GpuError> {
        // SAFETY: a recording command buffer of this frame; the import is in its entry state.
        unsafe { execution.record(context, recorder.command_buffer(), &imports, None) }.map(|_| ())
    };
    fixture.device().run(context, record).unwrap();
    let readback = slot.lock().unwrap().take().unwrap();
    readback.read().unwrap()
}

#[test]
fn every_setting_agrees_with_the_reference() {
    let fixture = fixture_with(&__Room__::requirements());
    for settings in curve::sweep() {
        let pass = __Room__::new(fixture.context(), settings).unwrap();
        let exposed = without_graph(&fixture, &pass);
        let wide = colours().into_iter().map(|colour| colour.map(f64::from));
        let truth: Vec<f64> = wide.flat_map(|colour| reference::expose(colour, &settings)).collect();
        let worst = worst_against(&exposed, &truth, |truth| curve::RELATIVE_ERROR * truth.abs()).unwrap();
        println!("{:6.2} stops: {:.2} of the allowed error, {worst}", settings.stops, worst.error);
        assert!(worst.error <= 1.0, "{settings:?}: {worst}");
    }
}

#[test]
fn both_roads_give_the_same_bits() {
    let fixture = fixture_with(&__Room__::requirements());
    let pass = __Room__::new(fixture.context(), Settings { stops: -1.3 }).unwrap();
    assert_same_bits("exposed", &with_graph(&fixture, &pass), &without_graph(&fixture, &pass));
}

#[test]
fn what_is_out_of_range_is_refused() {
    let fixture = fixture_with(&__Room__::requirements());
    let context = fixture.context();
    for stops in [16.5, -17.0, f64::NAN, f64::INFINITY] {
        let error = __Room__::new(context, Settings { stops }).err().unwrap().to_string();
        assert!(error.contains("give -16 to 16"), "{error}");
    }
    let pass = __Room__::new(context, Settings { stops: 1.0 }).unwrap();
    let buffer = upload(&fixture);
    let bindings = Bindings { colours: (&buffer).into(), exposed: (&buffer).into() };
    let refused = fixture.device().run(context, |recorder| pass.record(recorder, &bindings, COUNT + 1));
    assert!(refused.unwrap_err().to_string().contains("1001 colours need 16016 bytes"));
}
