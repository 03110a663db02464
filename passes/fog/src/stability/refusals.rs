//! What no frame takes: refused, with the name of the field.

use airglow_math::World;
use glam::DVec3;

use super::{Outcome, refusal};
use crate::light::{Bounds, Cone};
use crate::medium::Thinning;
use crate::pack::pack;
use crate::{Camera, Light, Medium, Phase, PhaseKind, Settings, View};

fn sound() -> View {
    let camera = Camera {
        position: DVec3::ZERO,
        right: DVec3::X,
        up: DVec3::Y,
        forward: DVec3::NEG_Z,
        edges: [-1.0, 1.0, -1.0, 1.0],
    };
    let medium = Medium::with_visibility(50.0);
    View {
        world: World::default(),
        camera,
        medium,
        lights: vec![Light::point(DVec3::Y, [1.0; 3])],
        environment: None,
    }
}

/// Something that spoils a sound view, and the field that the refusal is to name.
type Spoil = (&'static str, fn(&mut View));

const SPOILS: [Spoil; 22] = [
    ("medium.extinction, red", |view| view.medium.extinction[0] = f64::NAN),
    ("medium.extinction, green", |view| view.medium.extinction[1] = -0.1),
    ("medium.extinction, blue", |view| view.medium.extinction[2] = f64::INFINITY),
    ("medium.albedo, red", |view| view.medium.albedo[0] = 1.5),
    ("medium.albedo, blue", |view| view.medium.albedo[2] = f64::NAN),
    ("medium.phase.g", |view| view.medium.phase = Phase::HenyeyGreenstein { g: 1.0 }),
    ("medium.phase.alpha", |view| view.medium.phase = Phase::Draine { g: 0.0, alpha: -1.0 }),
    ("medium.phase", |view| view.medium.phase = Phase::Polynomial([0.0, 1.0, 0.0, 0.0])),
    ("medium.thinning.scale_height", |view| {
        view.medium.thinning = Some(Thinning { level: 0.0, scale_height: 0.0 });
    }),
    ("lights[0].position", |view| view.lights[0].position.y = f64::NAN),
    ("lights[0].intensity", |view| view.lights[0].intensity[1] = -1.0),
    ("lights[0].scatter", |view| view.lights[0].scatter = f64::NAN),
    ("lights[0].radius", |view| view.lights[0].radius = -0.1),
    ("lights[0].range", |view| view.lights[0].range = Some(0.0)),
    ("lights[0].cone.outer", |view| {
        view.lights[0].cone = Some(Cone { direction: DVec3::X, inner: 0.0, outer: 2.0 });
    }),
    ("lights[0].cone.inner", |view| {
        view.lights[0].cone = Some(Cone { direction: DVec3::X, inner: 0.5, outer: 0.5 });
    }),
    ("lights[0].cone.direction", |view| {
        view.lights[0].cone = Some(Cone { direction: DVec3::ZERO, inner: 0.1, outer: 0.5 });
    }),
    ("lights[0].bounds.high", |view| {
        view.lights[0].bounds = Some(Bounds { low: DVec3::ONE, high: DVec3::ZERO });
    }),
    ("camera.position", |view| view.camera.position.x = f64::NAN),
    ("camera.right, up and forward", |view| view.camera.right = DVec3::Y),
    ("camera.edges", |view| view.camera.edges = [1.0; 4]),
    ("65 lights", |view| view.lights = vec![view.lights[0]; 65]),
];

pub(super) fn cases(chosen: impl Fn(&str) -> bool) -> Vec<Outcome> {
    let mut outcomes = Vec::new();
    for (field, spoil) in SPOILS {
        let mut view = sound();
        spoil(&mut view);
        let settings = Settings { phase: PhaseKind::Draine, height: true, ..Settings::default() };
        let reason = pack(&settings, &view, [64, 64]).err().map(|reason| reason.to_string());
        outcomes.push(outcome(field, format!("{:?}, {:?}", view.medium, view.lights.first()), reason));
    }
    for bound in [-1.0, f64::NAN] {
        let reason = Settings { bound, ..Settings::default() }.check().err().map(|reason| reason.to_string());
        outcomes.push(outcome("bound", format!("bound {bound}"), reason));
    }
    outcomes.retain(|outcome| chosen(&outcome.name));
    outcomes
}

/// The refusal is due and names the field.
fn outcome(field: &str, input: String, reason: Option<String>) -> Outcome {
    let name = format!("refused: {field}");
    let reason = reason.unwrap_or_else(|| "accepted".to_owned());
    let mut outcome = refusal(name, input, true, &reason);
    if !reason.contains(field) {
        outcome.error = f64::INFINITY;
    }
    outcome
}
