//! Counts that shaders make are readable frames later, without a stall, and a bad value stays where it was.

use airglow_gpu::ash::vk;
use airglow_gpu::open::FrameLoop;
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, ComputePipelineDesc, Health, Label, Location, Recorder,
};
use airglow_graph::{Access, BufferDesc};
use airglow_tests::device::fixture;
use airglow_tests::spirv::words;

const COUNT: u32 = 1000;

/// Values of frame `frame`: `frame` of them not finite, twice as many above 1.
fn values(frame: u32) -> Vec<f32> {
    let value = |i: u32| match i {
        _ if i < frame => [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][i as usize % 3],
        _ if i < 3 * frame => 1.5,
        _ => 0.25,
    };
    (0..COUNT).map(value).collect()
}

#[test]
fn counts_come_frames_later_and_bad_values_stay_local() {
    let fixture = fixture();
    let context = fixture.context();
    let bindings = [0, 1].map(|binding| BindingDesc::new(binding, BindingKind::StorageBuffer));
    let spirv = words("test/health");
    let desc =
        ComputePipelineDesc { name: "health", spirv: &spirv, bindings: &bindings, push_constant_size: 4 };
    let pipeline = context.create_compute_pipeline(&desc).unwrap();
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER
        | vk::BufferUsageFlags::TRANSFER_SRC
        | vk::BufferUsageFlags::TRANSFER_DST;
    let desc = BufferDesc { size: 4 * u64::from(COUNT), usage };
    let buffer = context.create_buffer(Label::new("test", "values"), &desc, Location::Device).unwrap();
    let mut health = Health::new(context, &["not finite", "clamped"]).unwrap();
    assert_eq!(health.latest(context).unwrap(), None);

    let mut frames = FrameLoop::new(fixture.device(), context).unwrap();
    let first = context.frame() + 1;
    let mut copy = None;
    for frame in 1..=6u32 {
        let recorded = frames.frame(Default::default(), |commands| {
            // SAFETY: the loop's command buffer is recording, in this frame, and is submitted once.
            let mut recorder = unsafe { Recorder::new(context, commands) };
            let recorder = &mut recorder;
            recorder.memory_barrier(Access::TransferSource, Access::TransferDestination)?;
            let source = recorder.upload(&values(frame))?;
            recorder.copy_buffer(&source, &buffer)?;
            recorder.memory_barrier(Access::TransferDestination, Access::ComputeStorageReadWrite)?;
            health.clear(recorder)?;
            recorder.bind_compute(
                &pipeline,
                &[Binding::storage(0, &buffer), Binding::storage(1, health.buffer())],
            )?;
            recorder.push_constants(&COUNT)?;
            recorder.dispatch([COUNT.div_ceil(64), 1, 1])?;
            health.collect(recorder)?;
            assert!(health.collect(recorder).unwrap_err().to_string().contains("once a frame"));
            recorder.memory_barrier(Access::ComputeStorageReadWrite, Access::TransferSource)?;
            copy = Some(recorder.read_back_buffer(&buffer)?);
            Ok(())
        });
        recorded.unwrap();
        // With two frames in flight the newest that is known to be done is the one before last.
        let latest = health.latest(context).unwrap();
        let Some(known) = frame.checked_sub(2).filter(|&known| known > 0) else {
            assert_eq!(latest, None, "frame {frame}");
            continue;
        };
        let latest = latest.unwrap();
        assert_eq!(latest.frame, first + u64::from(known) - 1);
        let expected = [("not finite".to_owned(), known), ("clamped".to_owned(), 2 * known)];
        assert_eq!(latest.counts, expected, "known in frame {frame}");
    }
    frames.finish().unwrap();
    assert_eq!(health.latest(context).unwrap().unwrap().counts[0].1, 6);
    let expected: Vec<f32> =
        values(6).into_iter().map(|value| if !value.is_finite() { 0.0 } else { value.min(1.0) }).collect();
    assert_eq!(copy.unwrap().read::<f32>().unwrap(), expected);
    assert!(Health::new(context, &[]).is_err());
}
