//! The nets that all other tests hang in, each shown to be alive: what is plainly wrong must be heard, and what these
//! layers are deaf to the checker must report.

use airglow_checker::{Kind, Mutation, Trace};
use airglow_gpu::ash::{self, vk};
use airglow_graph::{Access, BufferDesc, Graph, Limits, PassKind};
use airglow_tests::colours::{self, BYTES, STORAGE, storage};
use airglow_tests::device::{Fixture, fixture};

/// Versions of the layers, and whether they report two dispatches that write one storage buffer without a barrier.
const HEARS_DISPATCH_AFTER_DISPATCH: [(u32, bool); 1] = [(vk::make_api_version(0, 1, 3, 239), false)];

/// A fixture whose layers are on, or `None` where the environment turned them off.
fn validated() -> Option<Fixture> {
    let fixture = fixture();
    if std::env::var("AIRGLOW_TEST_VALIDATION").as_deref() == Ok("off") {
        println!("not run: validation is off");
        return None;
    }
    Some(fixture)
}

#[test]
fn core_validation_is_heard() {
    let Some(fixture) = validated() else { return };
    let device = fixture.context().device();
    // SAFETY: a buffer of no bytes is wrong on purpose, and what core validation has to report; it is never used.
    unsafe {
        let info = vk::BufferCreateInfo::default().size(0).usage(STORAGE);
        if let Ok(raw) = device.create_buffer(&info, None) {
            device.destroy_buffer(raw, None);
        }
    }
    let heard = fixture.messages().take();
    let core =
        heard.iter().any(|message| message.error && message.id.contains("VUID-VkBufferCreateInfo-size"));
    assert!(core, "core validation is silent; heard {heard:?}");
}

#[test]
fn synchronisation_validation_is_heard() {
    let Some(fixture) = validated() else { return };
    let context = fixture.context();
    let pipeline = colours::pipeline(context);
    let buffer = storage(context, "test", BYTES);
    // Without the barrier between dispatch and copy: a hazard.
    let result = fixture.device().run(context, |recorder| {
        colours::record(recorder, &pipeline, &buffer, 1.0)?;
        recorder.read_back_buffer(&buffer)
    });
    result.unwrap();
    let heard = fixture.messages().take();
    let hazard = heard.iter().any(|message| message.id.contains("SYNC-HAZARD-READ-AFTER-WRITE"));
    assert!(hazard, "synchronisation validation is silent; heard {heard:?}");
}

#[test]
fn what_these_layers_are_deaf_to_is_on_record() {
    let Some(fixture) = validated() else { return };
    let context = fixture.context();
    let pipeline = colours::pipeline(context);
    let buffer = storage(context, "test", BYTES);
    let result = fixture.device().run(context, |recorder| {
        colours::record(recorder, &pipeline, &buffer, 1.0)?;
        colours::record(recorder, &pipeline, &buffer, 2.0)
    });
    result.unwrap();
    let heard = fixture.messages().take();
    let hazard = heard.iter().any(|message| message.id.contains("SYNC-HAZARD-WRITE-AFTER-WRITE"));
    let version = layer_version(fixture.device().entry());
    let text = format!(
        "{}.{}.{}",
        vk::api_version_major(version),
        vk::api_version_minor(version),
        vk::api_version_patch(version)
    );
    println!(
        "layers {text}: a dispatch that overwrites a dispatch is {}",
        if hazard { "heard" } else { "missed" }
    );
    if let Some((_, on_record)) = HEARS_DISPATCH_AFTER_DISPATCH.iter().find(|(of, _)| *of == version) {
        assert_eq!(hazard, *on_record, "layers {text} no longer do what is on record; heard {heard:?}");
    }
}

fn layer_version(entry: &ash::Entry) -> u32 {
    // SAFETY: the loader is loaded while the entry lives.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }.expect("layers can be listed");
    let name = Ok(c"VK_LAYER_KHRONOS_validation");
    layers.iter().find(|layer| layer.layer_name_as_c_str() == name).expect("the layer is on").spec_version
}

/// The same two dispatches as a plan, from which the barrier is taken.
#[test]
fn the_checker_reports_it() {
    let mut graph: Graph<()> = Graph::new();
    let mut buffer = graph.create_buffer("colours", BufferDesc::new(BYTES));
    for name in ["first", "second"] {
        let mut pass = graph.pass(name, PassKind::Compute);
        buffer = pass.write(buffer, Access::ComputeStorageWrite);
        pass.side_effect();
        pass.record(());
    }
    let trace = Trace::of(&graph.compile(&Limits::default()).unwrap());
    trace.check().unwrap();
    let between = |edit: &airglow_checker::Edit| {
        edit.mutation == Mutation::Drop && trace.moments[edit.moment].name.contains("second")
    };
    let edit = trace.edits().into_iter().find(between).expect("a barrier before the second pass");
    let violation = trace.check_edit(edit).unwrap_err();
    println!("{violation}");
    assert_eq!(violation.kind, Kind::WriteAfterWrite, "{violation}");
}
