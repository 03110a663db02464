//! The pass per pixel: against f64, the same bits by both roads, shares of light, and broken pixels.

use std::sync::{Arc, Mutex};

use airglow_gpu::{Execution, GpuError, Imports, Readback, Recorder};
use airglow_graph::{Access, Graph, PassKind};
use airglow_shadow::reference::{Reference, caps};
use airglow_shadow::{
    Bench, Blockers, Disc, Exponential, PixelLight, PixelLights, PixelPicture, PixelShadow, Products,
    Settings, Sphere,
};
use airglow_tests::device::{Fixture, fixture_with};
use glam::{DMat4, DVec3};

const SIDE: u32 = 20;
/// All above the ground.
const SPHERES: [Sphere; 2] = [
    Sphere { center: DVec3::new(0.5, 1.0, 0.2), radius: 0.6 },
    Sphere { center: DVec3::new(-1.0, 1.4, -0.8), radius: 0.9 },
];

type Texels = Vec<[f32; 4]>;

fn light(order: usize) -> PixelLight {
    let mut light = vec![[0.0; 3]; order * order];
    light[0] = [2.0, 1.5, 1.0];
    light[1] = [-0.5, -0.4, -0.6];
    light[6] = [0.1, -0.2, 0.3];
    let direction = DVec3::new(0.3, 0.9, 0.2).normalize();
    let disc = Disc { direction, angular_radius: 0.05, irradiance: [3.0, 2.5, 2.0] };
    PixelLight {
        products: Products::new(order, &light).unwrap(),
        disc: Some(disc),
        picture: PixelPicture::Light,
    }
}

/// A square of ground without its first pixel, and its normals.
fn texels() -> [Texels; 2] {
    let place =
        |at: u32| [(at % SIDE) as f32 * 0.2 - 2.0, 0.0, (at / SIDE) as f32 * 0.2 - 2.0, at.min(1) as f32];
    [(0..SIDE * SIDE).map(place).collect(), vec![[0.0, 2.0, 0.0, 0.0]; (SIDE * SIDE) as usize]]
}

/// What `frames` makes of a bench on the fixture.
fn on<T>(fixture: &Fixture, frames: impl FnOnce(Bench<'_>) -> T) -> T {
    let run = |record: &mut dyn FnMut(&mut Recorder<'_>) -> Result<(), GpuError>| {
        fixture.device().run(fixture.context(), |recorder| record(recorder))
    };
    frames(Bench { context: fixture.context(), run: &run })
}

/// Without a graph.
fn alone(
    fixture: &Fixture,
    shadow: &PixelShadow,
    blockers: &Blockers,
    light: &PixelLight,
    [positions, normals]: &[Texels; 2],
) -> Texels {
    let size = [SIDE, SIDE];
    on(fixture, |bench| bench.pixels(shadow, size, [positions, normals], blockers, light)).unwrap()
}

fn with_graph(fixture: &Fixture, shadow: &PixelShadow, blockers: &Blockers, light: &PixelLight) -> Texels {
    let context = fixture.context();
    let images = texels().map(|texels| on(fixture, |bench| bench.image([SIDE, SIDE], &texels)).unwrap());
    let mut graph = Graph::new();
    let mut imports = Imports::new();
    let handles = [0, 1].map(|at| {
        let entry = Access::ComputeSampled;
        let handle = graph.import_image(&format!("surface {at}"), *images[at].desc(), entry, entry);
        imports.image(&handle, &images[at]);
        handle
    });
    let lights = PixelLights::new(PixelLight { disc: None, ..light.clone() });
    let picture = shadow.add(&mut graph, [SIDE, SIDE], blockers, &lights, handles).unwrap();
    // What it reads is set before it is recorded.
    lights.set(light.clone());
    let slot: Arc<Mutex<Option<Readback>>> = Arc::default();
    let filled = Arc::clone(&slot);
    let mut read = graph.pass("read back", PassKind::Transfer);
    read.read(&picture, Access::TransferSource).side_effect();
    read.record(Box::new(move |recorder, resources| {
        *filled.lock().unwrap() = Some(recorder.read_back_image(&resources.view(&picture)?)?);
        Ok(())
    }));
    let plan = airglow_tests::plan::compile(graph, &context.graph_limits());
    let mut execution = Execution::prepare(context, plan).unwrap();
    let record = |recorder: &mut Recorder<'_>| -> Result<(), GpuError> {
        // SAFETY: a recording command buffer of this frame; the imports are in their entry state.
        unsafe { execution.record(context, recorder.command_buffer(), &imports, None) }.map(|_| ())
    };
    fixture.device().run(context, record).unwrap();
    slot.lock().unwrap().take().unwrap().texels().unwrap()
}

#[test]
fn pixels_agree_with_the_reference_by_both_roads() {
    let fixture = fixture_with(&PixelShadow::requirements());
    for order in [3, 6] {
        let settings = Settings { order, reach: 0.0, clamp: false, ..Default::default() };
        let shadow = PixelShadow::new(fixture.context(), settings).unwrap();
        let (blockers, light) = (Blockers::default(), light(order));
        blockers.set(&SPHERES, DMat4::IDENTITY).unwrap();
        let found = alone(&fixture, &shadow, &blockers, &light, &texels());
        assert_eq!(found, with_graph(&fixture, &shadow, &blockers, &light), "order {order}");
        assert_eq!(found[0], [0.0; 4], "no surface");
        let (reference, disc) = (Reference::new(order).unwrap(), light.disc.unwrap());
        for (at, (place, found)) in texels()[0].iter().zip(&found).enumerate().skip(1) {
            let caps = caps(&SPHERES, DVec3::new(place[0].into(), place[1].into(), place[2].into()));
            let visibility = reference.visibility(Exponential::Adaptive, &caps).unwrap();
            let lit = light.products.lit(DVec3::Y, &visibility).unwrap();
            let disc = disc.lit(DVec3::Y, disc.seen(&caps));
            for c in 0..3 {
                let truth = lit[c].max(0.0) + disc[c];
                let error = (f64::from(found[c]) - truth).abs();
                assert!(error < 6e-3, "order {order}, pixel {at}: {found:?} and {lit:?} + {disc:?}");
            }
        }
    }
    let other = Settings { exponential: Exponential::OptimalLinear, ..Default::default() };
    assert!(PixelShadow::new(fixture.context(), other).is_err());
}

#[test]
fn shares_are_what_is_left_of_the_light_and_one_where_nothing_blocks() {
    let fixture = fixture_with(&PixelShadow::requirements());
    let settings = Settings { reach: 0.0, ..Default::default() };
    let shadow = PixelShadow::new(fixture.context(), settings).unwrap();
    let (blockers, whole) = (Blockers::default(), light(settings.order));
    let share = PixelLight { picture: PixelPicture::Share, ..whole.clone() };
    let pixels = |light: &PixelLight| alone(&fixture, &shadow, &blockers, light, &texels());
    // A point hides nothing.
    blockers.set(&[Sphere { radius: 0.0, ..SPHERES[0] }], DMat4::IDENTITY).unwrap();
    let open = pixels(&whole);
    assert!(pixels(&share).iter().all(|share| *share == [1.0; 4]), "nothing blocks, or there is no surface");
    blockers.set(&SPHERES, DMat4::IDENTITY).unwrap();
    let (left, shares) = (pixels(&whole), pixels(&share));
    for (at, ((left, open), share)) in left.iter().zip(&open).zip(&shares).enumerate().skip(1) {
        for c in 0..3 {
            let error = (left[c] - share[c] * open[c]).abs();
            assert!(error < 3e-3, "pixel {at}: {left:?} is not {share:?} of {open:?}");
        }
    }
    let darkest = shares.iter().fold(1.0_f32, |least, share| least.min(share[0]));
    assert!(darkest < 0.5, "the spheres hide the disc and some of the sky: {darkest}");
}

#[test]
fn a_broken_pixel_is_no_surface_and_its_neighbours_stay() {
    let fixture = fixture_with(&PixelShadow::requirements());
    let settings = Settings { reach: 0.0, ..Default::default() };
    let shadow = PixelShadow::new(fixture.context(), settings).unwrap();
    let (blockers, light) = (Blockers::default(), light(settings.order));
    blockers.set(&SPHERES, DMat4::IDENTITY).unwrap();
    let whole = alone(&fixture, &shadow, &blockers, &light, &texels());
    let mut broken = texels();
    let places = [(0, 25, f32::NAN), (0, 130, f32::INFINITY), (0, 203, f32::NEG_INFINITY), (1, 77, f32::NAN)];
    for (image, pixel, value) in places {
        broken[image][pixel][pixel % 3] = value;
    }
    // Of a position its w, too.
    broken[0][350][3] = f32::NAN;
    let found = alone(&fixture, &shadow, &blockers, &light, &broken);
    for (at, (found, whole)) in found.iter().zip(&whole).enumerate() {
        let gone = at == 350 || places.iter().any(|(_, pixel, _)| *pixel == at);
        assert_eq!(found, if gone { &[0.0; 4] } else { whole }, "pixel {at}");
    }
}
