//! What goes wrong on a host's device: memory running out at every call in turn, a budget, a lost device. Nothing leaks,
//! nothing panics, and the host is told.

use airglow_gpu::ash::vk;
use airglow_gpu::open::OpenDevice;
use airglow_gpu::{
    AdoptInfo, Context, Execution, GpuError, Health, Label, Location, Options, Readback, Record,
    Requirements, SamplerDesc, Timing,
};
use airglow_graph::{Access, BufferDesc, Graph, PassKind, State};
use airglow_tests::compare::assert_close;
use airglow_tests::device::open;
use airglow_tests::shim::{Shim, watch};
use airglow_tests::workload::{Workload, reference};

/// Adopts through the watch.
///
/// # Safety
/// The context is dropped before the device, when the device is idle.
unsafe fn adopt(device: &OpenDevice, shim: &Shim, options: Options) -> Result<Context, GpuError> {
    let mut extensions = Vec::new();
    let get_device_proc_addr = Some(shim.get_device_proc_addr());
    let info = AdoptInfo { get_device_proc_addr, options, ..device.adopt_info(&mut extensions, 2) };
    // SAFETY: handles of the open device; the rest is the caller's promise.
    unsafe { Context::adopt(info) }
}

/// One of everything the library makes, used in a frame.
fn all(device: &OpenDevice, shim: &Shim) -> Result<(Readback, Context), GpuError> {
    let options = Options { breadcrumbs: true, ..Options::default() };
    // SAFETY: `run` waits; the caller drops what is returned before the device.
    let context = unsafe { adopt(device, shim, options) }?;
    let mut work = Workload::new(&context, State::UNDEFINED, Access::TransferSource.into())?;
    let _sampler = context.create_sampler(&SamplerDesc::linear("linear"))?;
    let mut health = Health::new(&context, &["clamped"])?;
    let copy = device.run(&context, |recorder| {
        health.clear(recorder)?;
        work.record(recorder)?;
        health.collect(recorder)?;
        recorder.read_back_image(&work.picture.full_view()?)
    })?;
    work.timing.collect()?;
    Ok((copy, context))
}

#[test]
fn running_out_of_memory_anywhere_unwinds_clean() {
    let device = open(&Requirements::engine());
    let shim = watch(&device);
    shim.fail(u64::MAX, vk::Result::SUCCESS);
    let (copy, context) = all(&device, &shim).unwrap();
    assert_close("the picture", &copy.texels().unwrap().concat(), &reference(), 1e-6, 1e-6);
    drop((copy, context));
    let calls = shim.heal();
    assert!(shim.alive().is_empty(), "left alive without a failure: {:?}", shim.alive());
    assert!(calls > 30, "only {calls} calls could fail");
    for nth in 0..calls {
        shim.fail(nth, vk::Result::ERROR_OUT_OF_DEVICE_MEMORY);
        let error = all(&device, &shim).map(drop).expect_err("a failure must be told");
        shim.heal();
        let told = match &error {
            GpuError::Vulkan { result, .. } => *result == vk::Result::ERROR_OUT_OF_DEVICE_MEMORY,
            GpuError::Memory { .. } => true,
            _ => false,
        };
        assert!(told, "call {nth}: {error}");
        assert!(shim.alive().is_empty(), "call {nth} ({error}) left alive: {:?}", shim.alive());
    }
    println!("{calls} calls failed in turn");
    let messages = device.messages();
    drop(device);
    let said = messages.take();
    assert!(said.is_empty(), "validation said {said:?}");
}

#[test]
fn a_lost_device_is_told_and_everything_can_be_dropped() {
    let device = open(&Requirements::engine());
    let shim = watch(&device);
    let options = Options { breadcrumbs: true, ..Options::default() };
    // SAFETY: nothing is submitted after the last wait; dropped before the device.
    let context = unsafe { adopt(&device, &shim, options) }.unwrap();
    assert_eq!(context.last_pass_reached().unwrap(), None, "nothing was recorded yet");
    let mut work = Workload::new(&context, State::UNDEFINED, Access::TransferSource.into()).unwrap();
    device.run(&context, |recorder| work.record(recorder)).unwrap();
    shim.lose_device();
    let error = work.timing.collect().map(|_| ()).unwrap_err();
    assert!(error.is_device_lost(), "{error}");
    assert_eq!(error.to_string(), "vkGetQueryPoolResults returned ERROR_DEVICE_LOST");
    drop((work, context));
    shim.heal();
    assert!(shim.alive().is_empty(), "left alive: {:?}", shim.alive());
}

#[test]
fn breadcrumbs_name_the_pass_the_device_reached() {
    let device = open(&Requirements::engine());
    let shim = watch(&device);
    let options = Options { breadcrumbs: true, ..Options::default() };
    // SAFETY: `frame` waits; everything is dropped before the device.
    let context = unsafe { adopt(&device, &shim, options) }.unwrap();
    let mut work = Workload::new(&context, State::UNDEFINED, Access::TransferSource.into()).unwrap();
    let mut frames = airglow_gpu::open::FrameLoop::new(&device, &context).unwrap();
    let frame = frames.frame(Default::default(), |commands| {
        // SAFETY: the loop's command buffer is recording and submitted once.
        let mut recorder = unsafe { airglow_gpu::Recorder::new(&context, commands) };
        work.record(&mut recorder)?;
        Ok(context.frame())
    });
    device.wait_idle().unwrap();
    let reached = context.last_pass_reached().unwrap().expect("a frame ran");
    assert_eq!((reached.frame, &*reached.pass, reached.finished), (frame.unwrap(), "draw", true));
    // A frame that ends in the middle of a step, as for a device that hangs there.
    let frame = frames.frame(Default::default(), |commands| {
        // SAFETY: as above.
        let mut recorder = unsafe { airglow_gpu::Recorder::new(&context, commands) };
        recorder.labelled("before", |_| Ok(()))?;
        let hangs = |_: &mut _| Err(GpuError::misuse("the device", "it hangs here"));
        assert!(recorder.labelled::<()>("the one that hangs", hangs).is_err());
        Ok(context.frame())
    });
    device.wait_idle().unwrap();
    let reached = context.last_pass_reached().unwrap().expect("a frame ran");
    assert_eq!(
        (reached.frame, &*reached.pass, reached.finished),
        (frame.unwrap(), "the one that hangs", false)
    );
    frames.finish().unwrap();
    assert_eq!(context.last_pass_reached().unwrap(), None, "the slots are clear for the next frames");
    drop(frames);
    drop((work, context));
    let said = device.messages().take();
    assert!(said.is_empty(), "validation said {said:?}");
}

#[test]
fn a_budget_is_met_or_refused_with_what_would_fit() {
    let device = open(&Requirements::engine());
    let shim = watch(&device);
    let options = Options { memory_budget: Some(10_000), ..Options::default() };
    // SAFETY: nothing is submitted; dropped before the device.
    let context = unsafe { adopt(&device, &shim, options) }.unwrap();
    let make = |size| {
        let desc = BufferDesc { size, usage: vk::BufferUsageFlags::STORAGE_BUFFER };
        context.create_buffer(Label::new("test", "table"), &desc, Location::Device)
    };
    let held = make(6000).unwrap();
    let left = context.memory_left().unwrap();
    assert!((3000..=4000).contains(&left), "{left} of 10000 left beside 6000");
    let before = shim.alive();
    let error = make(5000).map(drop).unwrap_err();
    let GpuError::Budget { size, held: counted, budget, .. } = &error else { panic!("{error}") };
    assert!(*size >= 5000 && *counted == 10_000 - left && *budget == 10_000, "{error}");
    assert!(error.to_string().contains(&format!("only {left} more fit")), "{error}");
    assert_eq!(shim.alive(), before, "nothing was made");
    // A plan is refused whole, before its first transient is made.
    let mut graph: Graph<Record> = Graph::new();
    for name in ["first", "second"] {
        let mut pass = graph.pass(name, PassKind::Compute);
        pass.create_buffer(name, BufferDesc::new(3000), Access::ComputeStorageWrite);
        pass.side_effect().record(Box::new(|_, _| Ok(())));
    }
    let plan = airglow_tests::plan::compile(graph, &context.graph_limits());
    assert_eq!(plan.bytes().transient, 6000);
    let error = Execution::prepare(&context, plan).map(drop).unwrap_err().to_string();
    assert!(error.contains("the plan's transient resources needs 6000 bytes"), "{error}");
    assert_eq!(shim.alive(), before, "no transient was made");
    drop(held);
    // SAFETY: nothing was submitted.
    unsafe { context.begin_frame(2) }.unwrap();
    assert_eq!(context.memory_left(), Some(10_000));
    assert!(make(5000).is_ok());
    let _ = Timing::new(&context, 1, 0, 1).unwrap();
    drop(context);
    assert!(shim.alive().is_empty(), "left alive: {:?}", shim.alive());
}
