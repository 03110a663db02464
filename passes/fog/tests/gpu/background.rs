//! Environments through fog: the picture against quadrature over the map, its energy and the band factors; and what the
//! way to a surface scatters of their light.

use crate::maps;
use std::f64::consts::{PI, TAU};

use crate::images::{Images, PIXELS, SIZE, view_distance};
use airglow_fog::reference::environment::factors;
use airglow_fog::reference::spread::exact;
use airglow_fog::{
    Asked, Background, Camera, Distant, Environment, Fog, Frame, Medium, Prepared, Preset, Seen, Settings,
    View,
};
use airglow_gpu::open::{FrameLoop, FrameSemaphores};
use airglow_gpu::{Execution, Image, Imports, Record};
use airglow_graph::{Access, Graph, PassKind, State};
use airglow_math::World;
use airglow_math::sh;
use airglow_math::sphere::equirect;
use airglow_tests::device::{Fixture, fixture_with};
use glam::DVec3;

const WIDTH: u32 = 37;
const HEIGHT: u32 = 19;

/// A sky with a small sun in it.
fn environment() -> Vec<[f32; 4]> {
    let texel = |i: u32| {
        let (x, y) = (i % WIDTH, i / WIDTH);
        let sky = 0.4 + 0.3 * (x as f32 * 0.5).sin() * (y as f32 * 0.3).cos();
        if (x, y) == (25, 5) { [900.0, 700.0, 500.0, 1.0] } else { [sky, 0.9 * sky, 1.2 * sky, 1.0] }
    };
    (0..WIDTH * HEIGHT).map(texel).collect()
}

fn fogged(fixture: &Fixture, distant: &Distant) -> Vec<[f32; 4]> {
    let context = fixture.context();
    let map = maps::uploaded(fixture, [WIDTH, HEIGHT], &environment());
    let target = maps::target(fixture, [WIDTH, HEIGHT]);
    let background = Background::new(context, [WIDTH, HEIGHT], maps::FORMAT).unwrap();
    let drawn = Access::ColorAttachmentWrite;
    let run = fixture.device().run(context, |recorder| {
        recorder.transition(&target, State::UNDEFINED, drawn)?;
        background.record(recorder, &map.full_view()?, &target.full_view()?, distant, Seen::Whole).unwrap();
        recorder.transition(&target, drawn, Access::TransferSource)
    });
    run.unwrap();
    read(fixture, &target)
}

/// The texels of an image that is ready to be copied from.
fn read(fixture: &Fixture, image: &Image) -> Vec<[f32; 4]> {
    let copy =
        fixture.device().run(fixture.context(), |recorder| recorder.read_back_image(&image.full_view()?));
    copy.unwrap().read::<[f32; 4]>().unwrap()
}

#[test]
fn a_map_is_made_once_for_an_environment_and_a_medium() {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let context = fixture.context();
    let map = maps::uploaded(&fixture, [WIDTH, HEIGHT], &environment());
    let target = maps::target(&fixture, [WIDTH, HEIGHT]);
    let background = Background::new(context, [WIDTH, HEIGHT], maps::FORMAT).unwrap();
    let thin = Distant { optical_distance: [0.5; 3], albedo: [1.0; 3] };
    let thick = Distant { optical_distance: [2.0; 3], ..thin };
    let asked = |distant, version| Asked { distant, seen: Seen::Whole, version };
    let frames = [asked(thin, 1), asked(thin, 1), asked(thick, 1), asked(thick, 2), asked(thick, 2)];
    let mut passes = Vec::new();
    for asked in frames {
        let (mut graph, mut imports) = (Graph::<Record>::new(), Imports::new());
        let sampled = Access::ComputeSampled;
        let environment = graph.import_image("environment", *map.desc(), sampled, sampled);
        imports.image(&environment, &map);
        let seen = background.add(&mut graph, &mut imports, environment, &target, asked).unwrap();
        let mut pass = graph.pass("host", PassKind::Graphics);
        pass.side_effect().read(&seen, Access::FragmentSampled).record(Box::new(|_, _| Ok(())));
        let plan = airglow_tests::plan::compile(graph, &context.graph_limits());
        assert_eq!(plan.left_out().is_empty(), plan.steps().len() == 3, "{}", plan.text());
        passes.push(plan.steps().len() - 1);
        let mut execution = Execution::prepare(context, plan).unwrap();
        let mut frames = FrameLoop::new(fixture.device(), context).unwrap();
        let recorded = frames.frame(FrameSemaphores::default(), |commands| {
            // SAFETY: the loop's command buffer is recording and submitted once; imports are in their entry states.
            unsafe { execution.record(context, commands, &imports, None) }
        });
        recorded.unwrap();
        frames.finish().unwrap();
    }
    assert_eq!(passes, [2, 0, 2, 2, 0]);
    let run = fixture.device().run(context, |recorder| {
        recorder.transition(&target, Access::FragmentSampled, Access::TransferSource)
    });
    run.unwrap();
    assert_eq!(read(&fixture, &target), fogged(&fixture, &thick), "by both roads");
}

fn middle(x: u32, y: u32) -> DVec3 {
    let place = [f64::from(x) + 0.5, f64::from(y) + 0.5];
    equirect::direction(place[0] / f64::from(WIDTH), place[1] / f64::from(HEIGHT))
}

fn solid_angle(y: u32) -> f64 {
    equirect::texel_solid_angle(WIDTH as usize, HEIGHT as usize, y as usize).unwrap()
}

/// The picture in a direction, the map constant on each texel: every texel in 3² parts, those about the direction in
/// 24².
fn truth(environment: &[[f32; 4]], direction: DVec3, seen: [f32; 4], distant: &Distant) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            let near = middle(x, y).distance(direction) < 0.5;
            let split = if near { 24 } else { 3 };
            let mut glow = [0.0; 3];
            for j in 0..split {
                for i in 0..split {
                    let part = |at: u32, k: u32| f64::from(at) + (f64::from(k) + 0.5) / f64::from(split);
                    let v = part(y, j) / f64::from(HEIGHT);
                    let towards = equirect::direction(part(x, i) / f64::from(WIDTH), v);
                    let share =
                        TAU * PI * (PI * v).sin() / f64::from(WIDTH * HEIGHT) / f64::from(split * split);
                    let chord = towards.distance(direction).max(0.5 * (share / PI).sqrt());
                    let gamma = 2.0 * (0.5 * chord).min(1.0).asin();
                    let mut last = (f64::NAN, 0.0);
                    for (glow, &optical) in glow.iter_mut().zip(&distant.optical_distance) {
                        if last.0 != optical {
                            last = (optical, exact(optical, gamma).unwrap());
                        }
                        *glow += share * last.1;
                    }
                }
            }
            let texel = environment[(y * WIDTH + x) as usize];
            for c in 0..3 {
                sum[c] += distant.albedo[c] * f64::from(texel[c]) * glow[c];
            }
        }
    }
    [0, 1, 2].map(|c| (-distant.optical_distance[c]).exp() * f64::from(seen[c]) + sum[c])
}

#[test]
fn the_picture_is_that_by_quadrature_over_the_map() {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let environment = environment();
    let grey = Distant { optical_distance: [0.7; 3], albedo: [1.0, 0.9, 0.8] };
    let coloured = Distant { optical_distance: [0.05, 1.0, 4.0], albedo: [1.0; 3] };
    for distant in [grey, coloured] {
        let picture = fogged(&fixture, &distant);
        let mut worst = 0.0_f64;
        for (x, y) in [(25, 5), (24, 5), (26, 6), (27, 8), (3, 0), (20, 18), (0, 9), (36, 9), (10, 12)] {
            let at = (y * WIDTH + x) as usize;
            let expected = truth(&environment, middle(x, y), environment[at], &distant);
            for c in 0..3 {
                let actual = f64::from(picture[at][c]);
                let error = (actual / expected[c] - 1.0).abs();
                println!("({x}, {y}) channel {c}: {actual:.5} and {:.5}", expected[c]);
                worst = worst.max(error);
            }
        }
        println!("worst {worst:.2e}");
        assert!(worst < 0.03, "{worst}");
    }
}

#[test]
fn the_light_of_the_whole_picture_is_that_of_the_first_band() {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    for optical in [1e-3, 0.1, 1.0, 5.0] {
        let distant = Distant { optical_distance: [optical; 3], albedo: [1.0; 3] };
        let sum = |texels: &[[f32; 4]]| -> f64 {
            texels.iter().zip(0..).map(|(texel, i)| f64::from(texel[1]) * solid_angle(i / WIDTH)).sum()
        };
        let share = sum(&fogged(&fixture, &distant)) / sum(&environment());
        let factor = distant.band_factors(1).unwrap()[0][1];
        println!("optical distance {optical}: {share:.5} and {factor:.5}");
        assert!((share / factor - 1.0).abs() < 0.015, "{share} and {factor}");
    }
}

#[test]
fn clear_and_opaque_media_have_their_limits() {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let clear = Distant { optical_distance: [0.0; 3], albedo: [1.0; 3] };
    assert_eq!(fogged(&fixture, &clear), environment());
    assert_eq!(clear.band_factors(6).unwrap(), vec![[1.0; 3]; 6]);
    for optical in [200.0, 1e3, 1e30] {
        let opaque = Distant { optical_distance: [optical; 3], albedo: [1.0; 3] };
        assert!(fogged(&fixture, &opaque).iter().flatten().all(|value| *value == 0.0 || *value == 1.0));
        assert!(opaque.band_factors(6).unwrap().iter().flatten().all(|value| value.abs() < 1e-80));
    }
    let refused = Distant { albedo: [1.0, 2.0, 1.0], ..clear }.band_factors(3).unwrap_err();
    assert!(refused.to_string().contains("albedo"), "{refused}");
    assert!(Distant::new(&Medium::with_visibility(60.0), f64::NAN).is_err());
}

#[test]
fn bands_fall_and_a_tabulated_brdf_is_spread_by_them() {
    for optical in [1e-4, 0.01, 0.3, 1.0, 3.0, 20.0] {
        let distant = Distant { optical_distance: [optical; 3], albedo: [1.0; 3] };
        let factors = distant.band_factors(6).unwrap();
        for pair in factors.windows(2) {
            assert!(pair[1][0] <= pair[0][0] && pair[1][0] > 0.0, "{optical}: {factors:?}");
        }
        println!("{optical}: {:.4}", factors[0][0]);
        // A medium that absorbs nothing sends light to the eye from all around: up to an eighth more than in clear air.
        assert!(factors[0][0] < 1.15, "{optical}: {}", factors[0][0]);
    }
    // A tabulated BRDF that answers one band alone.
    let distant = Distant { optical_distance: [0.8; 3], albedo: [0.5; 3] };
    let mut table = vec![0.0; 2 * 9];
    table[9 + sh::index(1, 0)] = 2.0;
    let effective = distant.effective_brdf(0, 3, &table).unwrap();
    let expected = 2.0 * (distant.band_factors(3).unwrap()[1][0] - (-0.8_f64).exp());
    assert!((effective[9 + sh::index(1, 0)] - expected).abs() < 1e-12);
    assert!(distant.effective_brdf(0, 3, &table[..10]).is_err());
}

/// What the pass leaves of a surface of radiance 2 and adds to it before an environment, without a lamp.
#[test]
fn before_a_surface_the_light_of_the_environment_is_scattered_and_behind_it_left_alone() {
    let fixture = fixture_with(&Fog::requirements(&Settings::default()));
    let mut radiance = [[0.0; 3]; 9];
    for (i, band) in radiance.iter_mut().enumerate() {
        let value = if i == 0 { 5.0 } else { 0.8 * (i as f64).sin() };
        *band = [value, 0.8 * value, 1.3 * value];
    }
    let environment = Environment { distance: 60.0, radiance };
    let medium =
        Medium { extinction: [0.005, 0.02, 0.08], albedo: [1.0, 0.9, 0.7], ..Medium::with_visibility(1.0) };
    let edges = [-0.8, 0.8, -0.45, 0.45];
    let camera = Camera { position: DVec3::Y, right: DVec3::X, up: DVec3::Y, forward: DVec3::NEG_Z, edges };
    let view =
        View { world: World::default(), camera, medium, lights: Vec::new(), environment: Some(environment) };
    let images = Images::new(&fixture, 2.0);
    for preset in [Preset::Default, Preset::Reference] {
        let settings = Settings { preset, environment: true, ..Settings::default() };
        let fog = Fog::new(fixture.context(), settings).unwrap();
        let frame = Frame { size: SIZE, surface: (), depth: (), target: Some(()), view: view.clone() };
        let Prepared::Pass(pass) = fog.prepare(&frame).unwrap() else {
            unreachable!("the medium is not clear")
        };
        let picture = images.draw(&fixture, &pass);
        let mut worst = 0.0_f64;
        for pixel in (0..PIXELS).step_by(13) {
            let [x, y] = [pixel % SIZE[0] as usize, pixel / SIZE[0] as usize].map(|at| at as f64 + 0.5);
            let ray =
                DVec3::new(1.6 * x / f64::from(SIZE[0]) - 0.8, 0.45 - 0.9 * y / f64::from(SIZE[1]), -1.0);
            let mut basis = vec![0.0; 9];
            sh::evaluate(3, ray.normalize(), &mut basis).unwrap();
            for c in 0..3 {
                let optical = medium.extinction[c] * 60.0;
                let expected = match view_distance(pixel) {
                    None => 2.0,
                    Some(metres) => {
                        let way = medium.extinction[c] * metres * ray.length();
                        let factors = factors(3, way.min(optical), optical).unwrap();
                        let band = |l: usize| -> f64 {
                            (l * l..(l + 1) * (l + 1)).map(|i| radiance[i][c] * basis[i]).sum()
                        };
                        let scattered: f64 = (0..3).map(|l| factors[l] * band(l)).sum();
                        2.0 * (-way).exp() + medium.albedo[c] * scattered
                    }
                };
                worst = worst.max((f64::from(picture[pixel][c]) / expected - 1.0).abs());
            }
        }
        println!("{preset:?}: worst {worst:.2e}");
        // Most of it is what f32 loses of a depth next to the far plane.
        assert!(worst < 1e-4, "{preset:?}: {worst}");
    }
    let both = Settings { environment: true, height: true, ..Settings::default() };
    assert!(both.check().is_err());
    let frame = Frame { size: SIZE, surface: (), depth: (), target: Some(()), view };
    let refused = Fog::new(fixture.context(), Settings::default()).unwrap().prepare(&frame).err().unwrap();
    assert!(refused.to_string().contains("Settings::environment"), "{refused}");
}
