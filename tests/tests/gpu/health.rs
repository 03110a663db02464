//! Counts that shaders make are readable frames later, without a stall, and a bad value stays where it was.

use airglow_gpu::ash::vk;
use airglow_gpu::open::FrameLoop;
use airglow_gpu::requirements::Limit;
use airglow_gpu::{
    AdoptInfo, Binding, BindingDesc, BindingKind, Buffer, BufferSlice, ComputePipelineDesc, Context, Counted,
    DeviceMask, Health, Label, Location, Look, Options, Recorder, Records, Tally,
};
use airglow_graph::{Access, BufferDesc};
use airglow_tests::device::{fixture, open};
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

/// Records of three floats, of which every seventh is broken in one place.
fn records(count: u32) -> Vec<[f32; 3]> {
    let record = |i: u32| match i % 7 {
        0 => [0.5, [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][i as usize % 3], 1.0],
        3 => [0.5, -0.5, 1.0],
        4 => [0.5, 0.5, -0.0],
        _ => [0.5, 0.5, f32::MAX],
    };
    (0..count).map(record).collect()
}

#[test]
fn a_tally_counts_records_range_by_range() {
    let device = open(&Tally::requirements());
    let mut extensions = Vec::new();
    // 12 bytes a record: ranges of 1024 records and a rest.
    let mask =
        DeviceMask { limits: vec![(Limit::StorageBufferRange, 13_000)], without_optional_features: true };
    let options = Options { mask, ..Options::default() };
    let info = AdoptInfo { options, ..device.adopt_info(&mut extensions, 2) };
    // SAFETY: `run` waits; everything is dropped before the device.
    let context = &unsafe { Context::adopt(info) }.unwrap();
    let values = records(5000);
    let desc = BufferDesc { size: 60_000, usage: vk::BufferUsageFlags::STORAGE_BUFFER };
    let buffer = context.create_buffer(Label::new("test", "records"), &desc, Location::Upload).unwrap();
    buffer.write(0, &values).unwrap();
    let counts = context.create_buffer(Label::new("test", "counts"), &desc, Location::Upload).unwrap();
    counts.write(0, &[[1u32, 20, 300], [4000, 50_000, 600_000]]).unwrap();
    let mut health = Health::new(context, &["not finite", "not positive", "summed"]).unwrap();
    let tally = Tally::new(context, &health).unwrap();
    let look = |counter, counted, buffer: &Buffer, records| Look {
        counter,
        counted,
        buffer: buffer.into(),
        records,
    };
    let looks: [Look<BufferSlice>; 3] = [
        look(0, Counted::NotFinite, &buffer, Records::whole(5000, 3)),
        look(1, Counted::NotPositive, &buffer, Records { count: 5000, stride: 3, first: 2, words: 1 }),
        look(2, Counted::Sum, &counts, Records { count: 2, stride: 3, first: 1, words: 2 }),
    ];
    let frame = device.run(context, |recorder| {
        health.clear(recorder)?;
        tally.record(recorder, &looks)?;
        health.collect(recorder)
    });
    frame.unwrap();
    for _ in 0..2 {
        device.run(context, |_| Ok(())).unwrap();
    }
    let of = |wrong: &dyn Fn(&[f32; 3]) -> bool| values.iter().filter(|record| wrong(record)).count() as u32;
    let not_finite = of(&|record| record.iter().any(|value| !value.is_finite()));
    let expected = [not_finite, of(&|record| record[2] <= 0.0), 650_320];
    let found: Vec<u32> =
        health.latest(context).unwrap().unwrap().counts.iter().map(|(_, count)| *count).collect();
    assert_eq!(found, expected);
    assert!(not_finite > 700);
    for (counter, records) in [
        (0, Records::whole(5001, 3)),
        (3, Records::whole(1, 3)),
        (0, Records { count: 1, stride: 3, first: 2, words: 2 }),
    ] {
        let look = [look(counter, Counted::Sum, &buffer, records)];
        let told = device.run(context, |recorder| tally.record(recorder, &look)).unwrap_err().to_string();
        assert!(told.contains("records") && told.contains("for counter"), "{told}");
    }
    let said = device.messages().take();
    assert!(said.is_empty(), "validation said {said:?}");
}
