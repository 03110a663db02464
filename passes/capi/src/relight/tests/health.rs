//! Bad texels of a host's image are counted, frames later and without a stall.

use std::mem::zeroed;
use std::ptr::null;

use airglow_gpu::ash::vk::{BufferUsageFlags, Format, Handle, ImageUsageFlags};
use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_gpu::{Label, Location, Recorder};
use airglow_graph::{Access, BufferDesc, ImageDesc, State};
use airglow_relight::Relight;
use airglow_tests::conformance::Given;
use airglow_tests::device::{open, stated};

use super::{call, in_c, refused, settings};
use crate::context::airglow_context_begin_frame;
use crate::prepared::*;
use crate::relight::airglow_relight_add_mesh;
use crate::relight::frame::*;
use crate::relight::health::*;
use crate::relight::prepared::airglow_relight_prepare;
use crate::relight::resources::AirglowRelightResource;
use crate::relight::settings::AirglowRelightSettings;
use crate::status::AirglowStatus;
use crate::through_c::{attempt, record};

#[test]
fn bad_texels_of_a_live_environment_are_counted() {
    let chosen = AirglowRelightSettings { health: 1, ..settings(0) };
    let open = open(&Relight::requirements(&crate::pass::Settings::read(&chosen).unwrap()));
    let (mut made, relight) = in_c(&stated(&open, open.device()), &chosen).unwrap();
    // SAFETY: dropped below, when the device is idle.
    let host = unsafe { open.adopt(1) }.unwrap();
    // SAFETY: zero bytes are a valid instance and a valid frame.
    let (mut instance, mut frame): (AirglowRelightInstance, AirglowRelightFrame) = unsafe { zeroed() };
    let (vectors, mesh) = ([0.5f32; 160], &raw mut instance.mesh);
    call!(airglow_relight_add_mesh, relight, null(), 10, vectors.as_ptr(), 160, mesh);
    (frame.struct_size, frame.instances) = (size_of::<AirglowRelightFrame>() as u32, &raw const instance);
    (frame.light, frame.instance_count) = (AirglowLight::EnvironmentImage as u32, 1);
    (frame.environment_width, frame.environment_height) = (4, 2);
    let frame = &raw const frame;
    let prepared = made.prepare(|to| attempt!(airglow_relight_prepare, relight, frame, to)).unwrap();
    call!(airglow_prepared_make_scratch, prepared);
    let usage = ImageUsageFlags::SAMPLED | ImageUsageFlags::TRANSFER_DST;
    let desc = ImageDesc { usage, ..ImageDesc::new_2d(4, 2, Format::R32G32B32A32_SFLOAT) };
    let sky = host.create_image(Label::new("host", "sky"), &desc).unwrap();
    let mut texels = [[1f32; 4]; 8];
    (texels[1][0], texels[2][1], texels[5][2]) = (f32::NAN, -1.0, f32::INFINITY);
    let results = BufferDesc { size: 160, usage: BufferUsageFlags::STORAGE_BUFFER };
    let results = host.create_buffer(Label::new("host", "results"), &results, Location::Device);
    let (sky, results) = (Given::Image(sky), Given::Buffer(results.unwrap()));
    let mut frames = FrameLoop::new(&open, &host).unwrap();
    for number in 0..3u64 {
        let recorded = frames.frame(FrameSemaphores::default(), |commands| {
            if number > 0 {
                call!(airglow_context_begin_frame, made.context, number);
                return Ok(());
            }
            // SAFETY: the loop's command buffer is recording.
            let mut recorder = unsafe { Recorder::new(&host, commands) };
            let image = sky.image().unwrap();
            let source = recorder.upload(&texels)?;
            recorder.transition(image, State::UNDEFINED, Access::TransferDestination)?;
            recorder.copy_buffer_to_image(&source, &image.full_view()?)?;
            recorder.transition(image, Access::TransferDestination, Access::ComputeSampled)?;
            call!(airglow_relight_health_clear, relight, commands.as_raw());
            let numbers = [AirglowRelightResource::Environment, AirglowRelightResource::Results];
            let numbers = numbers.map(|resource| (resource as u32, 0));
            record(prepared, &mut recorder, numbers.into_iter().zip([&sky, &results])).unwrap();
            call!(airglow_relight_health_collect, relight, commands.as_raw());
            refused!(InvalidArgument, airglow_relight_health_collect, relight, commands.as_raw());
            Ok(())
        });
        recorded.unwrap();
    }
    frames.finish().unwrap();
    drop(frames);
    // SAFETY: zero bytes are valid counts.
    let mut counts: AirglowRelightHealth = unsafe { zeroed() };
    call!(airglow_relight_health_latest, relight, &raw mut counts);
    assert_eq!((counts.frame, counts.counted, counts.not_finite, counts.negative), (0, 1, 2, 1));
    call!(airglow_prepared_forget, prepared);
    let (made_without, silent) = in_c(&stated(&open, open.device()), &settings(0)).unwrap();
    let said = refused!(InvalidArgument, airglow_relight_health_latest, silent, &raw mut counts);
    assert!(said.contains("set health in its settings"), "{said}");
    drop((sky, results, host, made, made_without));
    assert!(open.messages().take().is_empty());
}
