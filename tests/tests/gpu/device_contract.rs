//! What a host may rely on: adoption with named errors, memory accounts, deferred destruction, several contexts,
//! timestamps that do not stall.

use airglow_gpu::ash::vk;
use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_gpu::requirements::{Limit, LimitNeed};
use airglow_gpu::{
    AdoptInfo, Context, Execution, Feature, FeatureSet, GpuError, Imports, Label, Location, Record,
    Requirements, Timing,
};
use airglow_graph::{Access, BufferDesc, Graph, PassKind, State};
use airglow_tests::colours::{self, BYTES, STORAGE, storage};
use airglow_tests::compare::assert_same_bits;
use airglow_tests::device::{fixture, open};
use std::cell::Cell;
use std::ffi::{CStr, c_char};

fn error<T>(result: Result<T, GpuError>) -> String {
    result.err().expect("this must be refused").to_string()
}

thread_local! {
    /// The true function of the device that this thread's test has open. Not kept longer: the loader may be unloaded with
    /// its last instance, and come back at another address.
    static DEVICE_PROC_ADDR: Cell<Option<vk::PFN_vkGetDeviceProcAddr>> = const { Cell::new(None) };
}

/// A host's get-proc-addr that does not know one function.
unsafe extern "system" fn without_dispatch_indirect(
    device: vk::Device,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: the library passes the device and a nul-terminated name.
    unsafe {
        match DEVICE_PROC_ADDR.get() {
            Some(get) if CStr::from_ptr(name) != c"vkCmdDispatchIndirect" => get(device, name),
            _ => None,
        }
    }
}

/// A host's get-proc-addr on a device of Vulkan 1.2: only the extensions' names for what 1.3 made core.
unsafe extern "system" fn extension_names_only(
    device: vk::Device,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    const PROMOTED: [(&CStr, &CStr); 4] = [
        (c"vkCmdBeginRendering", c"vkCmdBeginRenderingKHR"),
        (c"vkCmdEndRendering", c"vkCmdEndRenderingKHR"),
        (c"vkCmdPipelineBarrier2", c"vkCmdPipelineBarrier2KHR"),
        (c"vkCmdWriteTimestamp2", c"vkCmdWriteTimestamp2KHR"),
    ];
    let get = DEVICE_PROC_ADDR.get()?;
    // SAFETY: the library passes the device and a nul-terminated name.
    unsafe {
        let asked = CStr::from_ptr(name);
        match PROMOTED.iter().find(|(core, extension)| [*core, *extension].contains(&asked)) {
            Some((core, _)) if *core == asked => None,
            Some((core, _)) => get(device, core.as_ptr()),
            None => get(device, name),
        }
    }
}

#[test]
fn functions_are_found_by_the_names_of_their_extensions() {
    let device = open(&Requirements::engine());
    DEVICE_PROC_ADDR.set(Some(device.instance().fp_v1_0().get_device_proc_addr));
    for (api_version, named) in [(vk::API_VERSION_1_2, true), (vk::API_VERSION_1_3, false)] {
        let mut extensions = Vec::new();
        let info = device.adopt_info(&mut extensions, 2);
        let mut names = info.extensions.to_vec();
        if named {
            names.extend(["VK_KHR_synchronization2", "VK_KHR_dynamic_rendering"]);
        }
        let get_device_proc_addr = Some(extension_names_only as vk::PFN_vkGetDeviceProcAddr);
        let info = AdoptInfo { api_version, extensions: &names, get_device_proc_addr, ..info };
        // SAFETY: the handles are the open device's; everything is dropped before it, after `run` has waited.
        let context = unsafe { Context::adopt(info) }.unwrap();
        let (pipeline, buffer) = (colours::pipeline(&context), storage(&context, "test", BYTES));
        let copy = device.run(&context, |recorder| {
            colours::record(recorder, &pipeline, &buffer, 1.0)?;
            recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
            recorder.read_back_buffer(&buffer)
        });
        let colours = copy.unwrap().read::<f32>().unwrap();
        assert_eq!(colours[4 * 128..][..2], [0.5, 0.5], "the barriers and the dispatch ran");
    }
    assert!(device.messages().take().is_empty());
}

#[test]
fn adopting_names_what_is_missing() {
    let device = open(&Requirements::engine());
    let adopt = |change: &dyn Fn(&mut AdoptInfo<'_>)| {
        let mut extensions = Vec::new();
        let mut info = device.adopt_info(&mut extensions, 2);
        change(&mut info);
        // SAFETY: the handles are the open device's; the context is dropped at once, and nothing was submitted.
        unsafe { Context::adopt(info) }
    };
    assert!(adopt(&|_| {}).is_ok());

    let lacking = FeatureSet::default().with(Feature::DynamicRendering);
    let message = error(adopt(&|info| info.features = lacking));
    assert!(message.contains("feature synchronization2, not enabled (the plan's barriers)"), "{message}");
    assert!(!message.contains("dynamicRendering"), "{message}");

    let message = error(adopt(&|info| info.api_version = vk::API_VERSION_1_2));
    assert!(message.contains("extension VK_KHR_synchronization2, not enabled"), "{message}");
    let message = error(adopt(&|info| info.api_version = vk::API_VERSION_1_1));
    assert!(message.contains("Vulkan 1.2 (this is 1.1)"), "{message}");

    let message = error(adopt(&|info| info.queue_family = 99));
    assert!(message.contains("a queue family with"), "{message}");

    let mut greedy = Requirements::engine();
    greedy.extensions.push("VK_EXT_nothing");
    greedy.limits =
        vec![LimitNeed { limit: Limit::ComputeSharedMemorySize, at_least: 1 << 40, why: "greed" }];
    let mut extensions = Vec::new();
    let info = AdoptInfo { requirements: &greedy, ..device.adopt_info(&mut extensions, 2) };
    // SAFETY: as above.
    let message = error(unsafe { Context::adopt(info) });
    assert!(message.contains("extension VK_EXT_nothing, not enabled"), "{message}");
    assert!(message.contains("maxComputeSharedMemorySize of 1099511627776"), "{message}");

    let message = error(adopt(&|info| info.frames_in_flight = 0));
    assert!(message.contains("frames_in_flight"), "{message}");

    DEVICE_PROC_ADDR.set(Some(device.instance().fp_v1_0().get_device_proc_addr));
    let message = error(adopt(&|info| info.get_device_proc_addr = Some(without_dispatch_indirect)));
    assert!(message.contains("returned null for vkCmdDispatchIndirect"), "{message}");
    assert!(device.messages().take().is_empty(), "adopting and refusing leaves validation silent");
}

#[test]
fn memory_is_charged_to_owners_and_freed_frames_later() {
    let fixture = fixture();
    let context = fixture.context();
    let bytes = |owner: &str| {
        context.memory_report().iter().find(|entry| entry.owner == owner).map_or(0, |entry| entry.bytes)
    };
    let first = storage(context, "fog", 1000);
    let second = storage(context, "fog", 3000);
    let _other = storage(context, "relight", 500);
    let held = bytes("fog");
    assert!((4000..8192).contains(&held), "{held} bytes for 4000");
    assert!(bytes("relight") >= 500);
    drop(second);
    assert_eq!(bytes("fog"), held, "frames in flight may still use it");
    let frame = context.frame();
    // SAFETY: nothing was submitted.
    unsafe { context.begin_frame(frame + 1) }.unwrap();
    assert_eq!(bytes("fog"), held, "one frame later, the other in flight may still use it");
    // SAFETY: as above.
    unsafe { context.begin_frame(frame + 2) }.unwrap();
    let left = bytes("fog");
    assert!((1000..held - 2999).contains(&left), "{left} bytes for 1000");
    drop(first);
    // SAFETY: as above.
    let message = error(unsafe { context.begin_frame(frame + 2) });
    assert!(message.contains("frames count up"), "{message}");
    let too_large = BufferDesc { size: 1 << 50, usage: STORAGE };
    let message = error(context.create_buffer(Label::new("fog", "all of it"), &too_large, Location::Device));
    assert!(
        message.contains("all of it needs 1125899906842624 bytes but maxMemoryAllocationSize"),
        "{message}"
    );
}

/// A buffer that another API or process owns between frames: acquired, changed, given back, under validation.
#[test]
fn what_another_owner_has_is_acquired_and_given_back() {
    let fixture = fixture();
    let context = fixture.context();
    let (pipeline, buffer) = (colours::pipeline(context), storage(context, "test", BYTES));
    let foreign = State::of(Access::ComputeStorageReadWrite).on_queue_family(vk::QUEUE_FAMILY_EXTERNAL);
    let mut graph: Graph<Record> = Graph::new();
    let imported = graph.import_buffer("colours", *buffer.desc(), foreign, foreign);
    let mut pass = graph.pass("colours", PassKind::Compute);
    let changed = pass.update(imported, Access::ComputeStorageReadWrite);
    pass.record(Box::new(move |recorder, resources| {
        colours::record(recorder, &pipeline, resources.buffer(&changed)?, 1.0)
    }));
    let plan = airglow_tests::plan::compile(graph, &context.graph_limits());
    let (acquire, release) = (&plan.acquires().buffers[0], &plan.releases().buffers[0]);
    assert_eq!((acquire.src_queue_family, acquire.dst_queue_family), (vk::QUEUE_FAMILY_EXTERNAL, 0));
    assert_eq!((release.src_queue_family, release.dst_queue_family), (0, vk::QUEUE_FAMILY_EXTERNAL));
    let mut execution = Execution::prepare(context, plan).unwrap();
    let mut imports = Imports::new();
    imports.buffer(&imported, &buffer);
    for _ in 0..2 {
        let record = |recorder: &mut airglow_gpu::Recorder<'_>| {
            // SAFETY: a recording command buffer of this frame; nobody else has the buffer, whoever owns it.
            unsafe { execution.record(context, recorder.command_buffer(), &imports, None) }
        };
        fixture.device().run(context, record).unwrap();
    }
    let copy = fixture.device().run(context, |recorder| recorder.read_back_buffer(&buffer)).unwrap();
    assert_eq!(copy.read::<f32>().unwrap()[4 * 128..][..2], [0.5, 0.5]);
}

#[test]
fn contexts_interleave() {
    let (left, right) = (fixture(), fixture());
    let contexts = [left.context(), right.context()];
    let pipelines = contexts.map(colours::pipeline);
    let buffers = contexts.map(|context| storage(context, "test", BYTES));
    let mut copies = [Vec::new(), Vec::new()];
    for round in 0..3u8 {
        for (i, fixture) in [&left, &right].into_iter().enumerate() {
            let readback = fixture.device().run(contexts[i], |recorder| {
                colours::record(recorder, &pipelines[i], &buffers[i], f32::from(round))?;
                recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
                recorder.read_back_buffer(&buffers[i])
            });
            copies[i] = readback.unwrap().read::<f32>().unwrap();
        }
    }
    assert!(copies[0].iter().any(|&value| value > 1.0), "the last round doubles the colours");
    assert_same_bits("two contexts", &copies[0], &copies[1]);
    let message = error(left.device().run(contexts[0], |recorder| {
        recorder.bind_compute(&pipelines[1], &[])?;
        Ok(())
    }));
    assert!(message.contains("made by another context"), "{message}");
}

#[test]
fn timestamps_come_frames_later_without_waiting() {
    let fixture = fixture();
    let context = fixture.context();
    let pipeline = colours::pipeline(context);
    let buffer = storage(context, "test", BYTES);
    let mut graph: Graph<Record> = Graph::new();
    let mut handle = graph.import_buffer(
        "colours",
        *buffer.desc(),
        Access::ComputeStorageWrite,
        Access::ComputeStorageWrite,
    );
    let imported = handle;
    for name in ["first", "second"] {
        let mut pass = graph.pass(name, PassKind::Compute);
        handle = pass.update(handle, Access::ComputeStorageReadWrite);
        let (pipeline, target) = (pipeline.clone(), handle);
        pass.record(Box::new(move |recorder, resources| {
            colours::record(recorder, &pipeline, resources.buffer(&target)?, 1.0)
        }));
    }
    let mut execution =
        Execution::prepare(context, airglow_tests::plan::compile(graph, &context.graph_limits())).unwrap();
    let mut imports = Imports::new();
    imports.buffer(&imported, &buffer);

    let warm_up = 3;
    let mut timing = Timing::new(context, 2, warm_up, 8).unwrap();
    assert_eq!(timing.collect().unwrap(), None, "nothing was recorded yet");
    let mut frames = FrameLoop::new(fixture.device(), context).unwrap();
    let recorded = 12;
    for _ in 0..recorded {
        let recorded = frames.frame(FrameSemaphores::default(), |command_buffer| {
            // SAFETY: the loop's command buffer is recording; the buffer's state is as declared from frame to frame.
            unsafe { execution.record(context, command_buffer, &imports, Some(&mut timing)) }
        });
        let recorded = recorded.unwrap();
        assert_eq!(recorded.passes, 2);
        assert!(recorded.barriers >= 1 && recorded.cpu.as_secs_f64() < 1.0, "{recorded:?}");
    }
    frames.finish().unwrap();
    assert!(timing.collect().unwrap().is_some());
    let summary = timing.summary().unwrap();
    assert_eq!(timing.passes(), ["first", "second"]);
    assert_eq!(summary.frames, 8, "the newest 8 of {recorded} less {warm_up}");
    for frame in timing.frames() {
        let longest = frame.passes.iter().fold(0.0, |a: f64, &b| a.max(b));
        assert!(frame.passes.iter().all(|&time| time > 0.0), "{frame:?}");
        assert!(frame.span >= longest && frame.span < 10.0, "{frame:?}");
        assert!((frame.sum - frame.passes.iter().sum::<f64>()).abs() < 1e-12, "{frame:?}");
    }
}
