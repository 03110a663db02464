//! What lists of lights a tile could save at most: the share of a frame that goes into lights which a pixel rejects.
//!
//! 64 lamps of mixed ranges over a street, 512 x 512, beside the same number that every pixel rejects and none at all, in
//! turn: `cargo run --release -p airglow-fog --example lists`.

use std::time::Instant;

use airglow_fog::{
    ACCESSES, Bindings, Camera, Fog, FogError, Frame, Light, Medium, Prepared, Settings, View,
};
use airglow_gpu::ash::vk::{Format, ImageLayout, ImageUsageFlags};
use airglow_gpu::{Image, Label};
use airglow_graph::{ImageDesc, State};
use airglow_math::World;
use airglow_tests::device::{Fixture, fixture_with};
use glam::DVec3;

const SIDE: u32 = 512;
const FRAMES: usize = 15;

fn view(lights: Vec<Light>) -> View {
    let camera = Camera {
        position: DVec3::new(0.0, 1.7, 0.0),
        right: DVec3::X,
        up: DVec3::Y,
        forward: DVec3::NEG_Z,
        edges: [-0.6, 0.6, -0.6, 0.6],
    };
    View { world: World::default(), camera, medium: Medium::with_visibility(60.0), lights, environment: None }
}

/// Lamps along both sides of a street, ranges from 2 to 16 m.
fn street(i: u32) -> Light {
    let position =
        DVec3::new(if i.is_multiple_of(2) { -4.0 } else { 4.0 }, 4.0, -3.0 - 2.0 * f64::from(i / 2));
    let lamp = Light::point(position, [40.0, 30.0, 15.0]);
    Light { radius: 0.1, range: Some(f64::from(2_u32 << (i % 4))), ..lamp }
}

/// Before the camera, so that it is not left out of the frame, in a range too small for any pixel's ray to meet.
fn rejected(i: u32) -> Light {
    Light { range: Some(1e-5), position: DVec3::new(0.001 * f64::from(i), 1.7, -50.0), ..street(i) }
}

fn milliseconds(fixture: &Fixture, images: &[Image; 3], fog: &Fog, view: &View) -> Result<f64, FogError> {
    let frame = Frame { size: [SIDE; 2], surface: (), depth: (), target: Some(()), view: view.clone() };
    let Prepared::Pass(pass) = fog.prepare(&frame)? else { return Ok(0.0) };
    let start = Instant::now();
    fixture.device().run(fixture.context(), |recorder| {
        for (image, (_, access)) in images.iter().zip(ACCESSES) {
            recorder.transition(image, State::idle(ImageLayout::UNDEFINED), access)?;
        }
        let [surface, depth, target] = images;
        let bindings = Bindings {
            surface: surface.full_view()?,
            depth: depth.full_view()?,
            target: target.full_view()?,
        };
        pass.record(recorder, &bindings)
    })?;
    Ok(1e3 * start.elapsed().as_secs_f64())
}

fn main() -> Result<(), FogError> {
    let settings = Settings { phase: airglow_fog::PhaseKind::Isotropic, ..Settings::default() };
    let fixture = fixture_with(&Fog::requirements(&settings));
    let fog = Fog::new(fixture.context(), settings)?;
    let (hdr, sampled) = (Format::R32G32B32A32_SFLOAT, ImageUsageFlags::SAMPLED);
    let make = |format, usage| {
        let desc = ImageDesc { usage, ..ImageDesc::new_2d(SIDE, SIDE, format) };
        fixture.context().create_image(Label::new("example", "image"), &desc)
    };
    let images = [
        make(hdr, sampled)?,
        make(Format::D32_SFLOAT, sampled | ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT)?,
        make(hdr, ImageUsageFlags::COLOR_ATTACHMENT)?,
    ];
    let views =
        [view((0..64).map(street).collect()), view((0..64).map(rejected).collect()), view(Vec::new())];
    let mut times = [const { Vec::new() }; 3];
    for _ in 0..FRAMES {
        for (times, view) in times.iter_mut().zip(&views) {
            times.push(milliseconds(&fixture, &images, &fog, view)?);
        }
    }
    let [mixed, rejected, none] = times.map(|mut times: Vec<f64>| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    });
    println!(
        "64 lamps of mixed ranges {mixed:.2} ms, 64 rejected by every pixel {rejected:.2} ms, none {none:.2} ms"
    );
    println!("rejecting is at most {:.1} % of the frame", 100.0 * (rejected - none) / mixed);
    Ok(())
}
