//! A small step of a lamp or of the camera makes a small step of the picture.

use crate::images::{Images, PIXELS, SIZE};
use airglow_fog::{Camera, Fog, Frame, Light, Medium, Phase, Prepared, Settings, View};
use airglow_math::World;
use airglow_tests::device::{Fixture, fixture_with};
use glam::DVec3;

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
    View { world: World::default(), camera, medium, lights: vec![lamp], environment: None }
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
    let images = Images::new(fixture, 0.0);
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
