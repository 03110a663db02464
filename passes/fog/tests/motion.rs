//! A small step of a lamp or of the camera makes a small step of the picture.

#![allow(clippy::panic, clippy::unwrap_used, reason = "helpers of tests fail the test they are called from")]

use airglow_fog::{
    ACCESSES, Bindings, Camera, Fog, Frame, Light, Medium, Pass, Phase, Prepared, Settings, View,
};
use airglow_gpu::ash::vk::{BufferUsageFlags, Format, ImageLayout, ImageUsageFlags};
use airglow_gpu::{Image, Label, Location};
use airglow_graph::{Access, BufferDesc, ImageDesc, State};
use airglow_math::World;
use airglow_tests::device::{Fixture, fixture_with};
use glam::DVec3;

const SIZE: [u32; 2] = [48, 27];
const PIXELS: usize = 48 * 27;
const STEPS: usize = 200;
/// Metres.
const STEP: f64 = 0.01;
const RADIUS: f64 = 0.5;
const EXTINCTION: f64 = 0.4;
const G: f64 = 0.5;
/// Worst relative error of the default preset with such a lobe.
const ERROR: f64 = 4e-3;

/// One lamp in dense fog, of that radiant intensity, W/sr.
fn view(eye: DVec3, lamp: DVec3, intensity: f64) -> View {
    let camera = Camera {
        position: eye,
        right: DVec3::X,
        up: DVec3::Y,
        forward: DVec3::NEG_Z,
        edges: [-0.8, 0.8, -0.45, 0.45],
    };
    let medium = Medium {
        extinction: [EXTINCTION; 3],
        albedo: [0.9; 3],
        phase: Phase::HenyeyGreenstein { g: G },
        thinning: None,
    };
    let lamp = Light { radius: RADIUS, ..Light::point(lamp, [intensity, 0.5 * intensity, 0.25 * intensity]) };
    View { world: World::default(), camera, medium, lights: vec![lamp] }
}

/// A black surface, its depth and the picture.
struct Images([Image; 3]);

impl Images {
    fn new(fixture: &Fixture) -> Self {
        let context = fixture.context();
        let make = |name, format, usage| {
            let desc = ImageDesc { usage, ..ImageDesc::new_2d(SIZE[0], SIZE[1], format) };
            context.create_image(Label::new("test", name), &desc).unwrap()
        };
        let given = ImageUsageFlags::SAMPLED | ImageUsageFlags::TRANSFER_DST;
        let hdr = Format::R32G32B32A32_SFLOAT;
        let images = [
            make("surface", hdr, given),
            make("depth", Format::D32_SFLOAT, given | ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT),
            make("picture", hdr, ImageUsageFlags::COLOR_ATTACHMENT | ImageUsageFlags::TRANSFER_SRC),
        ];
        let staging = |bytes: &[f32]| {
            let desc = BufferDesc { size: size_of_val(bytes) as u64, usage: BufferUsageFlags::TRANSFER_SRC };
            let buffer =
                context.create_buffer(Label::new("test", "texels"), &desc, Location::Upload).unwrap();
            buffer.write(0, bytes).unwrap();
            buffer
        };
        // Surfaces from 0.2 m to 100 m away, and none in the upper third.
        let farthest = World::default().depth.farthest() as f32;
        let depth = |pixel: usize| {
            let share = (pixel * 7 % PIXELS) as f32 / PIXELS as f32;
            if pixel < PIXELS / 3 { farthest } else { 0.5 * 0.002_f32.powf(share) }
        };
        let contents = [staging(&[0.0; 4 * PIXELS]), staging(&(0..PIXELS).map(depth).collect::<Vec<f32>>())];
        fixture
            .device()
            .run(context, |recorder| {
                for ((image, contents), (_, access)) in images.iter().zip(&contents).zip(ACCESSES) {
                    recorder.transition(
                        image,
                        State::idle(ImageLayout::UNDEFINED),
                        Access::TransferDestination,
                    )?;
                    recorder.copy_buffer_to_image(contents, &image.full_view()?)?;
                    recorder.transition(image, Access::TransferDestination, access)?;
                }
                Ok(())
            })
            .unwrap();
        Self(images)
    }

    fn draw(&self, fixture: &Fixture, pass: &Pass) -> Vec<[f32; 4]> {
        let [surface, depth, picture] = &self.0;
        let mut copy = None;
        fixture
            .device()
            .run(fixture.context(), |recorder| {
                let views = [surface.full_view()?, depth.full_view()?, picture.full_view()?];
                let [surface, depth, target] = views.clone();
                let write = Access::ColorAttachmentWrite;
                recorder.transition(picture, State::idle(ImageLayout::UNDEFINED), write)?;
                pass.record(recorder, &Bindings { surface, depth, target })?;
                recorder.transition(picture, write, Access::TransferSource)?;
                copy = Some(recorder.read_back_image(&views[2])?);
                Ok(())
            })
            .unwrap();
        copy.unwrap().read::<[f32; 4]>().unwrap()
    }
}

/// What a way gave.
#[derive(Debug)]
struct Steps {
    /// The largest change of a value in what is allowed of it.
    worst: f64,
    /// Share of the values that are lit.
    lit: f64,
    /// Frames without the lamp.
    left_out: u32,
}

/// The largest change of a pixel between frames, in what is allowed of it, over the frames of a way.
///
/// With R the radius, b the extinction and d the distance of a point of a ray from the lamp, a step s changes d by no
/// more than s: 1 / (d^2 + R^2) by a factor of at most exp(s / R), the exponential by exp(b s), and the angle of scattering
/// by s / R, so that the lobe, whose logarithm has a slope of at most 3 g / (1 - g^2), changes by exp(3 g s / ((1 - g^2) R)).
/// To that come the error of either frame and the bound below which the lamp is left out of a pixel.
fn steps(fixture: &Fixture, way: impl Fn(f64) -> View) -> Steps {
    let settings = Settings::default();
    let fog = Fog::new(fixture.context(), settings).unwrap();
    let frame = Frame { size: SIZE, surface: (), depth: (), target: Some(()), view: way(0.0) };
    let Prepared::Pass(pass) = fog.prepare(&frame).unwrap() else { panic!("there is a medium") };
    let images = Images::new(fixture);
    let factor = (STEP * ((1.0 + 3.0 * G / (1.0 - G * G)) / RADIUS + EXTINCTION)).exp();
    let mut before = images.draw(fixture, &pass);
    let (mut worst, mut left_out, mut lit) = (0.0_f64, 0, 0);
    for step in 1..=STEPS {
        left_out += pass.control.set(&way(STEP * step as f64)).unwrap().left_out;
        let after = images.draw(fixture, &pass);
        for (before, after) in before.iter().flatten().zip(after.iter().flatten()) {
            let [before, after] = [*before, *after].map(f64::from);
            assert!(after.is_finite() && after >= 0.0, "step {step}: {after}");
            let allowed = before.max(after) * (factor - 1.0 + 2.0 * ERROR) + settings.bound;
            worst = worst.max((after - before).abs() / allowed);
            lit += usize::from(after > 0.0);
        }
        before = after;
    }
    Steps { worst, lit: lit as f64 / (3 * PIXELS * STEPS) as f64, left_out }
}

#[test]
fn a_small_step_makes_a_bounded_step_of_the_picture() {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let ways: [(&str, &dyn Fn(f64) -> View); 5] = [
        ("lamp across", &|s| view(DVec3::ZERO, DVec3::new(s - 1.0, 0.1, -3.0), 2.0)),
        ("lamp out of reach", &|s| view(DVec3::ZERO, DVec3::new(0.3, 0.2, -15.6 - s), 0.1)),
        ("lamp through the eye", &|s| view(DVec3::ZERO, DVec3::new(0.0, 0.0, s - 1.0), 2.0)),
        ("camera past the lamp", &|s| view(DVec3::new(0.0, 0.0, 1.0 - s), DVec3::new(0.2, 0.1, 0.0), 2.0)),
        ("camera across", &|s| view(DVec3::new(s - 1.0, 0.0, 0.0), DVec3::new(0.0, 0.3, -4.0), 2.0)),
    ];
    for (name, way) in ways {
        let steps = steps(&fixture, way);
        println!("{name}: {steps:?}");
        assert!(steps.worst <= 1.0 && steps.lit > 0.0, "{name}: {steps:?}");
        // The bound ends it within the picture first, then in all of it.
        assert_eq!(name == "lamp out of reach", steps.lit < 1.0 && steps.left_out > 0, "{name}: {steps:?}");
    }
}
