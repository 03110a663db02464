//! A frame recorded with resources that it was recorded with before allocates nothing on the heap.

use std::mem::zeroed;
use std::ptr::{null, null_mut};

use airglow_gpu::ash::vk::{BufferUsageFlags, CommandBuffer, Handle};
use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_gpu::{Label, Location};
use airglow_graph::BufferDesc;
use airglow_relight::Relight;
use airglow_tests::conformance::Given;
use airglow_tests::device::{open, stated};
use airglow_tests::heap::allocations;

use super::{call, in_c, settings};
use crate::context::*;
use crate::prepared::*;
use crate::relight::frame::{AirglowLight, AirglowRelightFrame, AirglowRelightInstance};
use crate::relight::prepared::*;
use crate::relight::resources::AirglowRelightResource;
use crate::relight::*;
use crate::through_c::binding;

/// Warm-up, and frames that count.
const FRAMES: [u64; 2] = [10, 30];
const VERTICES: u32 = 100;

#[test]
fn a_frame_recorded_again_allocates_nothing() {
    let chosen = settings(0);
    let open = open(&Relight::requirements(&crate::pass::Settings::read(&chosen).unwrap()));
    let (made, relight) = in_c(&stated(&open, open.device()), &chosen).unwrap();
    // SAFETY: dropped below, when the device is idle.
    let host = unsafe { open.adopt(1) }.unwrap();
    let mut prepared = null_mut();
    // SAFETY: zero bytes are a valid instance and a valid frame.
    let (mut instance, mut frame): (AirglowRelightInstance, AirglowRelightFrame) = unsafe { zeroed() };
    let vectors = vec![0.5f32; 16 * VERTICES as usize];
    let mesh = &raw mut instance.mesh;
    call!(airglow_relight_add_mesh, relight, null(), VERTICES, vectors.as_ptr(), vectors.len(), mesh);
    call!(airglow_relight_set_environment, relight, 4, 2, [1f32; 24].as_ptr());
    frame.struct_size = size_of::<AirglowRelightFrame>() as u32;
    frame.light = AirglowLight::Environment as u32;
    (frame.instances, frame.instance_count) = (&raw const instance, 1);
    call!(airglow_relight_prepare, relight, &raw const frame, &raw mut prepared);
    call!(airglow_prepared_make_scratch, prepared);
    // A host with two buffers takes turns.
    let desc = BufferDesc { size: 16 * u64::from(VERTICES), usage: BufferUsageFlags::STORAGE_BUFFER };
    let buffers =
        [0, 1].map(|_| host.create_buffer(Label::new("host", "results"), &desc, Location::Device).unwrap());
    let results = (AirglowRelightResource::Results as u32, 0);
    let bindings = buffers.each_ref().map(|buffer| binding(results, &Given::Buffer(buffer.clone())));
    let mut counted = [0, 0];
    let mut frames = FrameLoop::new(&open, &host).unwrap();
    let [warm_up, measured] = FRAMES;
    for frame in 0..warm_up + measured {
        let recorded = frames.frame(FrameSemaphores::default(), |commands: CommandBuffer| {
            if frame > 0 {
                call!(airglow_context_begin_frame, made.context, frame);
            }
            let (bound, commands) = (&raw const bindings[frame as usize % 2], commands.as_raw());
            let before = allocations();
            call!(airglow_prepared_record, prepared, commands, bound, 1);
            counted[usize::from(frame >= warm_up)] += allocations() - before;
            Ok(())
        });
        recorded.unwrap();
    }
    frames.finish().unwrap();
    drop(frames);
    let [warming_up, after] = counted;
    assert!(warming_up > 0, "the counter is dead: the first frames import");
    assert_eq!(after, 0, "heap allocations in {measured} frames");
    call!(airglow_prepared_forget, prepared);
    drop((buffers, host, made));
    // SAFETY: it is not used again; all work is done.
    unsafe { airglow_prepared_drop(prepared) };
    let said = open.messages().take();
    assert!(said.is_empty(), "{said:?}");
}
