//! A lamp that moves through a plan that stays.

use airglow_math::statistics::relative_l2;
use airglow_radiance::gpu::RefineState;
use airglow_radiance::reference::Cube;
use airglow_radiance::{Lights, PassSettings, Radiance, Settings, Triangle};
use glam::DVec3;

use crate::receivers::Mesh;
use crate::scenes::block;
use crate::with_bench;

const FRAMES: usize = 200;

/// A lamp on its way around the ball.
fn lamp(frame: usize) -> Vec<Triangle> {
    let angle = std::f64::consts::TAU * frame as f64 / FRAMES as f64;
    block(
        DVec3::new(1.1 * angle.cos(), 0.3 * (3.0 * angle).sin(), 1.1 * angle.sin()),
        0.1,
        DVec3::splat(20.0),
    )
}

/// Root mean square of the colours' difference.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    (square / a.len() as f64).sqrt()
}

/// From one frame to the next colours change by what the light changes and by no more than samples may be wrong; a
/// frame of a plan that was recorded often has the bits of one made from scratch; and nothing is sampled where nothing moves.
#[test]
fn a_lamp_moves_without_popping() {
    let mesh = Mesh::ball(9, 3, false);
    let settings = |bound| PassSettings {
        order: 3,
        gradients: true,
        face: 8,
        rays: 1,
        closed_forms: true,
        keep: 0.0,
        refinement: Settings { bound, ..Settings::default() },
    };
    let bound = 0.02;
    with_bench(&Radiance::requirements(&settings(bound)), |bench| {
        let radiance = Radiance::new(bench.context, settings(bound)).unwrap();
        let colours = |light: &[f32]| mesh.colours(light);
        let plan = |bound| {
            let receiver = mesh.receiver(bench, settings(bound));
            let lights = Lights { emitters: &lamp(0), ..Lights::default() };
            let prepared = radiance.prepare(&receiver, &lights).unwrap();
            let buffers = bench.light_buffers(&prepared).unwrap();
            (receiver, prepared, buffers)
        };
        let sampled = plan(bound);
        let cube = Cube::new(3, 8).unwrap();
        let every = |number: usize| -> Vec<f32> {
            let light = |vertex| cube.sample(mesh.point(vertex), &lamp(number)).unwrap().coefficients;
            let lights = (0..mesh.positions.len()).flat_map(light);
            lights.flat_map(|l| l.as_vec3().to_array()).collect()
        };
        let frame = |(_, prepared, buffers): &(_, airglow_radiance::Prepared, Vec<_>), number: usize| {
            let control = prepared.control.as_ref().unwrap();
            control.set(&Lights { emitters: &lamp(number), ..Lights::default() }).unwrap();
            bench.frame(prepared, buffers).unwrap();
            bench.light::<f32>(buffers).unwrap().concat()
        };
        let (mut last, mut worst, mut wrong): (Option<[Vec<f64>; 2]>, f64, f64) = (None, 0.0, 0.0);
        for number in 0..FRAMES {
            let light = frame(&sampled, number);
            if number % 50 == 0 {
                let light_again = frame(&plan(bound), number);
                assert_eq!(light, light_again, "frame {number} is not that from scratch");
                assert_eq!(light, frame(&sampled, number), "frame {number} recorded twice");
            }
            let now = [colours(&light), colours(&every(number))];
            wrong = wrong.max(distance(&now[0], &now[1]));
            if let Some([before, before_true]) = &last {
                let change: Vec<f64> = now[0].iter().zip(before).map(|(a, b)| a - b).collect();
                let true_change: Vec<f64> = now[1].iter().zip(before_true).map(|(a, b)| a - b).collect();
                worst = worst.max(distance(&change, &true_change));
            }
            last = Some(now);
        }
        let [found, truth] = last.unwrap();
        println!(
            "worst frame {wrong:.5} off, worst step {worst:.5} off, last frame {:.4} of the light; bound {bound}",
            relative_l2(&found, &truth).unwrap()
        );
        // The bound is that of a node: what n nodes may be wrong adds up as their squares do.
        let refined = bench.refined(&sampled.0, &mesh.tree).unwrap().0;
        let nodes = refined.samples.iter().filter(|sample| !sample.split).count();
        let allowed = bound * (nodes as f64).sqrt();
        println!("{nodes} nodes that were not split: {allowed:.5}");
        assert!(
            nodes < 60 && worst < allowed && wrong < allowed,
            "{wrong} and {worst} are not below {allowed}"
        );
    });
}

/// Where a lamp moves little, most samples are kept, and frames stay as near to those of all samples as the bound says.
#[test]
fn samples_are_kept_where_a_lamp_moves_little() {
    let (mesh, bound) = (Mesh::ball(9, 3, false), 0.02);
    let settings = |keep| PassSettings {
        order: 3,
        gradients: true,
        face: 8,
        rays: 1,
        keep,
        refinement: Settings { bound, ..Settings::default() },
        ..PassSettings::default()
    };
    let lamp = |frame: usize| {
        let angle = 0.002 * frame as f64;
        let centre = DVec3::new(1.1 * angle.cos(), 0.1 * (5.0 * angle).sin(), 1.1 * angle.sin());
        block(centre, 0.1, DVec3::splat(20.0))
    };
    with_bench(&Radiance::requirements(&settings(0.0)), |bench| {
        let radiance = Radiance::new(bench.context, settings(0.0)).unwrap();
        let plans = [0.0, 0.25].map(|keep| {
            let receiver = mesh.receiver(bench, settings(keep));
            let lights = Lights { emitters: &lamp(0), ..Lights::default() };
            let prepared = radiance.prepare(&receiver, &lights).unwrap();
            let buffers = bench.light_buffers(&prepared).unwrap();
            (receiver, prepared, buffers)
        });
        let (mut taken, mut fresh, mut stale, mut pop) = (0, 0, 0.0_f64, 0.0_f64);
        let (mut nodes, mut last): (usize, Option<[Vec<f64>; 2]>) = (usize::MAX, None);
        for number in 0..FRAMES {
            let now = [0, 1].map(|i: usize| {
                let (receiver, prepared, buffers) = &plans[i];
                let lights = Lights { emitters: &lamp(number), ..Lights::default() };
                prepared.control.as_ref().unwrap().set(&lights).unwrap();
                bench.frame(prepared, buffers).unwrap();
                let state: Vec<RefineState> = bench.read(&receiver.samples().state).unwrap();
                if i == 1 {
                    (taken, fresh) = (taken + state[0].taken, fresh + state[0].fresh);
                } else {
                    assert_eq!(state[0].fresh, state[0].taken);
                }
                mesh.colours(&bench.light::<f32>(buffers).unwrap().concat())
            });
            stale = stale.max(distance(&now[0], &now[1]));
            if let Some(last) = &last {
                let step =
                    |i: usize| -> Vec<f64> { now[i].iter().zip(&last[i]).map(|(a, b)| a - b).collect() };
                pop = pop.max(distance(&step(0), &step(1)));
            }
            if number == FRAMES / 2 {
                let refined = bench.refined(&plans[0].0, &mesh.tree).unwrap().0;
                nodes = refined.samples.iter().filter(|sample| !sample.split).count();
            }
            last = Some(now);
        }
        let allowed = bound * (nodes as f64).sqrt();
        println!(
            "{fresh} of {taken} samples taken; worst frame {stale:.5} off that of all samples, worst step {pop:.5}; \
             {nodes} nodes of bound {bound}: {allowed:.5}"
        );
        assert!(3 * fresh < taken, "{fresh} of {taken} samples were taken");
        assert!(nodes < 100 && stale < allowed && pop < allowed, "{stale} and {pop} are not below {allowed}");
    });
}
