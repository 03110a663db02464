//! Counts that a host asks for, and a broken receiver that stays by itself.

use airglow_gpu::open::FrameSemaphores;
use airglow_gpu::{Buffer, Health, Label, Location, Tally};
use airglow_graph::{Access, BufferDesc};
use airglow_shadow::{Bindings, Blockers, Counts, HEALTH, Settings, Shadow};
use airglow_tests::device::{Fixture, fixture_with};
use glam::DMat4;

use crate::graph::{SPHERES, ground};

fn buffer(fixture: &Fixture, size: u64) -> Buffer {
    let usage = Access::ComputeStorageRead.buffer_usage() | Access::TransferSource.buffer_usage();
    let desc = BufferDesc { size, usage };
    fixture.context().create_buffer(Label::new("host", "buffer"), &desc, Location::Upload).unwrap()
}

/// A frame over the ground with these positions: visibility, counts of the kernel, counts of the tally.
fn frame(positions: &[[f32; 3]]) -> (Vec<f32>, Counts, Vec<u32>) {
    let fixture = fixture_with(&Shadow::requirements().and(&Tally::requirements()));
    let (device, context) = (fixture.device(), fixture.context());
    let settings = Settings { normals: true, ..Settings::default() };
    let shadow = Shadow::new(context, settings).unwrap();
    let receivers = shadow.receivers(context, "ground", &ground().0).unwrap();
    let blockers = Blockers::default();
    blockers.set(&SPHERES, DMat4::IDENTITY).unwrap();
    let bytes = size_of_val(positions) as u64;
    let (places, normals) = (buffer(&fixture, bytes), buffer(&fixture, bytes));
    places.write(0, positions).unwrap();
    normals.write(0, &ground().1).unwrap();
    let visibility = buffer(&fixture, receivers.visibility_bytes(settings.order));
    let records = buffer(&fixture, receivers.record_bytes());
    let mut health = Health::new(context, &HEALTH).unwrap();
    let tally = Tally::new(context, &health).unwrap();
    let bindings = Bindings {
        positions: (&places).into(),
        normals: Some((&normals).into()),
        visibility: (&visibility).into(),
        records: (&records).into(),
    };
    let of = |buffer: &Buffer| buffer.into();
    let looks =
        receivers.looks(settings.order, of(&places), Some(of(&normals)), of(&visibility), of(&records));
    let copies = device.run(context, |recorder| {
        health.clear(recorder)?;
        shadow.record(recorder, &receivers, &blockers, &bindings)?;
        recorder.memory_barrier(Access::ComputeStorageWrite, Access::ComputeStorageRead)?;
        recorder.memory_barrier(Access::ComputeStorageWrite, Access::TransferSource)?;
        tally.record(recorder, &looks)?;
        health.collect(recorder)?;
        Ok([recorder.read_back_buffer(&visibility)?, recorder.read_back_buffer(&records)?])
    });
    let copies = copies.unwrap();
    // A frame is known to be done when as many as are in flight have begun after it.
    let mut frames = airglow_gpu::open::FrameLoop::new(device, context).unwrap();
    for _ in 0..context.frames_in_flight() {
        frames.frame(FrameSemaphores::default(), |_| Ok(())).unwrap();
    }
    frames.finish().unwrap();
    let counts = health.latest(context).unwrap().unwrap().counts;
    let records = copies[1].read::<[u32; 2]>().unwrap();
    (copies[0].read().unwrap(), Counts::of(&records), counts.into_iter().map(|(_, count)| count).collect())
}

#[test]
fn a_broken_receiver_stays_by_itself_and_is_counted() {
    let (mut positions, _) = ground();
    let (whole, counts, found) = frame(&positions);
    assert_eq!(found, [0, 0, counts.clamped as u32], "{counts:?}");
    let broken = [17, 140, 299];
    for (receiver, value) in broken.into_iter().zip([f32::NAN, f32::INFINITY, f32::NEG_INFINITY]) {
        positions[receiver][receiver % 3] = value;
    }
    let (values, counts, found) = frame(&positions);
    assert_eq!((found[0], found[2]), (3, counts.clamped as u32));
    for (receiver, (values, whole)) in values.chunks(16).zip(whole.chunks(16)).enumerate() {
        match broken.contains(&receiver) {
            true => assert!(values.iter().all(|value| value.is_finite()), "receiver {receiver}: {values:?}"),
            false => {
                // Where a bound of 64 receivers is another, a sphere of less than the reach may come or go.
                let error = values.iter().zip(whole).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                assert!(error < 1e-4, "receiver {receiver}: {error}");
            }
        }
    }
    assert_eq!(found[1], 0);
}
