//! The pass on a device: which samples it chooses, and what it makes of them, against the reference.

use airglow_math::sh::rotation::Rotation;
use airglow_math::statistics::relative_l2;
use airglow_radiance::gpu::bench::Bench;
use airglow_radiance::gpu::{LightShape, TexelSettings, Texels, refinement, vertices};
use airglow_radiance::{
    Glow, Lights, Oracle, Part, PassSettings, Radiance, Receiver, Reconstruction, Refined, Settings, Weights,
    refine,
};
use airglow_tests::reflect::Module;
use glam::{DMat3, DVec3};

use crate::receivers::Mesh;
use crate::scenes::{block, blocks};
use crate::with_bench;

/// Light of all vertices and samples, by the pass.
struct Run {
    light: Vec<f64>,
    refined: Refined,
}

impl Run {
    fn new(
        bench: &Bench<'_>,
        radiance: &Radiance,
        mesh: &Mesh,
        settings: PassSettings,
        lights: &Lights<'_>,
    ) -> Self {
        let receiver = mesh.receiver(bench, settings);
        let prepared = radiance.prepare(&receiver, lights).unwrap();
        let buffers = bench.light_buffers(&prepared).unwrap();
        bench.frame(&prepared, &buffers).unwrap();
        let light = bench.light::<f32>(&buffers).unwrap().concat().into_iter().map(f64::from).collect();
        let (refined, _) = bench.refined(&receiver, &mesh.tree).unwrap();
        Self { light, refined }
    }
}

/// The light that the reference reconstructs from samples.
fn reconstructed(mesh: &Mesh, refined: &Refined, settings: &PassSettings, distant: &[[f32; 3]]) -> Vec<f64> {
    let reconstruction = Reconstruction::new(refined, Weights::Compact, settings.gradients);
    let mut light = vec![DVec3::ZERO; settings.order * settings.order];
    let mut all = Vec::new();
    for vertex in 0..mesh.positions.len() {
        reconstruction.light(mesh.point(vertex), &mut light).unwrap();
        for (i, l) in light.iter().enumerate() {
            let far = distant.get(i).map_or(DVec3::ZERO, |d| DVec3::from(d.map(f64::from)));
            all.extend((*l + far).to_array());
        }
    }
    all
}

fn settings(order: usize, gradients: bool, refinement: Settings) -> PassSettings {
    PassSettings { order, gradients, face: 8, rays: 1, closed_forms: true, keep: 0.0, refinement }
}

#[test]
fn light_of_vertices_is_that_of_the_reference_from_the_same_samples() {
    for (order, gradients, bound) in [(3, false, 0.03), (4, true, 0.01), (5, true, 1e-3), (6, false, 0.0)] {
        let mesh = Mesh::ball(24, order, order == 5);
        let distant: Vec<[f32; 3]> = (0..order * order).map(|i| [0.1, 0.2 * i as f32, -0.1]).collect();
        let distant = if order == 4 { distant } else { Vec::new() };
        let settings = settings(order, gradients, Settings { bound, limit: 700, ..Settings::default() });
        let lights = Lights { emitters: &blocks(), distant: &distant, ..Lights::default() };
        let Run { light, refined } = with_bench(&Radiance::requirements(&settings), |bench| {
            let radiance = Radiance::new(bench.context, settings).unwrap();
            Run::new(bench, &radiance, &mesh, settings, &lights)
        });
        let expected = reconstructed(&mesh, &refined, &settings, &distant);
        let error = relative_l2(&light, &expected).unwrap();
        println!(
            "order {order}, {} samples: {error:.1e} (first {:.6e}, in f64 {:.6e})",
            refined.samples.len(),
            light[0],
            expected[0]
        );
        assert!(error < 1e-5, "order {order}: {error:e}");
    }
}

/// A CPU that reads back the light of every round chooses the same samples in the same order.
#[test]
fn samples_are_those_that_a_cpu_chooses() {
    let (mesh, emitters) = (Mesh::ball(28, 3, true), blocks());
    let made = settings(3, false, Settings::default());
    with_bench(&Radiance::requirements(&made), |bench| {
        let radiance = Radiance::new(bench.context, made).unwrap();
        let shape = LightShape { order: 3, gradients: false };
        let texels = Texels::new(bench.context, TexelSettings { shape, size: 8, rays: 1 }).unwrap();
        let cases = [(0.1, 4096, 1), (0.01, 4096, 3), (1e-3, 200, 3), (0.0, 300, 8)];
        for oracle in [Oracle::Printed, Oracle::Argued, Oracle::Transfer] {
            for (bound, limit, stride) in cases {
                let refinement = Settings { oracle, bound, limit, stride, ..Settings::default() };
                let settings = PassSettings { refinement, ..made };
                let lights = Lights { emitters: &emitters, ..Lights::default() };
                let refined = Run::new(bench, &radiance, &mesh, settings, &lights).refined;
                let driven = refine(&mesh.tree, &refinement, &Glow::of(&emitters), &mut |points| {
                    bench.texels(&texels, &emitters, points)
                });
                let driven = driven.unwrap();
                let nodes = |refined: &Refined| -> Vec<_> {
                    refined.samples.iter().map(|sample| (sample.node, sample.split)).collect()
                };
                let counts = [refined.samples.len(), driven.samples.len()];
                println!(
                    "{oracle:?}, bound {bound}, limit {limit}, stride {stride}: {counts:?} samples, {} rounds, estimates {:.6e} and {:.6e}",
                    refined.rounds, refined.estimate, driven.estimate
                );
                assert_eq!(nodes(&refined), nodes(&driven), "{oracle:?}, bound {bound}");
                assert_eq!((refined.rounds, refined.limited), (driven.rounds, driven.limited));
                assert!((refined.estimate - driven.estimate).abs() <= 1e-5 * driven.estimate);
                assert_eq!(refined.limited, limit < 4096, "{oracle:?}, bound {bound}");
            }
        }
    });
}

/// A black object takes no sample and a lamp out of reach one; without emitters the pass is left out.
#[test]
fn samples_are_taken_only_where_they_count() {
    let mesh = Mesh::ball(16, 3, false);
    let far = block(DVec3::new(0.0, 1e4, 0.0), 1e3, DVec3::ONE);
    let settings = settings(3, true, Settings { bound: 1e-3, ..Settings::default() });
    with_bench(&Radiance::requirements(&settings), |bench| {
        let radiance = Radiance::new(bench.context, settings).unwrap();
        let black = vec![0.0; mesh.transfer.len()];
        let tree = airglow_radiance::Hierarchy::build(&mesh.positions, &black, &mut |_, _| {
            std::ops::ControlFlow::Continue(())
        });
        let black =
            Receiver::new(bench.context, settings, &tree.unwrap(), &mesh.positions, &mesh.whole()).unwrap();
        let lights = Lights { emitters: &far, ..Lights::default() };
        assert_eq!(Run::new(bench, &radiance, &mesh, settings, &lights).refined.samples.len(), 1);
        let lit = mesh.receiver(bench, settings);
        let dark = block(DVec3::Y, 0.1, DVec3::ZERO);
        for (receiver, emitters, why) in [
            (&black, &far[..], "no vertex reflects light"),
            (&lit, &dark[..], "no emitter gives light"),
            (&lit, &[], "no emitter gives light"),
        ] {
            let prepared = radiance.prepare(receiver, &Lights { emitters, ..Lights::default() }).unwrap();
            assert!(prepared.stages.is_empty() && prepared.control.is_none());
            assert_eq!(prepared.left_out.unwrap().why, why);
        }
    });
}

/// Parts of a receiver get the same light, each about its own axes.
#[test]
fn parts_get_light_in_their_own_space() {
    let order = 4;
    let mesh = Mesh::ball(12, order, false);
    let settings = settings(order, true, Settings::default());
    let turn = DMat3::from_rotation_y(0.7) * DMat3::from_rotation_x(-1.1) * -DMat3::IDENTITY;
    with_bench(&Radiance::requirements(&settings), |bench| {
        let radiance = Radiance::new(bench.context, settings).unwrap();
        let parts = [Part { vertices: 0..50, turn: Some(turn) }, Part { vertices: 30..144, turn: None }];
        let receiver = Receiver::new(bench.context, settings, &mesh.tree, &mesh.positions, &parts).unwrap();
        let prepared =
            radiance.prepare(&receiver, &Lights { emitters: &blocks(), ..Lights::default() }).unwrap();
        let buffers = bench.light_buffers(&prepared).unwrap();
        bench.frame(&prepared, &buffers).unwrap();
        let light = bench.light::<[f32; 3]>(&buffers).unwrap();
        let count = order * order;
        let rotation = Rotation::from_matrix(order, turn).unwrap();
        for vertex in 30..50 {
            let plain: Vec<[f64; 3]> =
                light[1][(vertex - 30) * count..][..count].iter().map(|l| l.map(f64::from)).collect();
            let turned = rotation.apply_rgb(&plain).unwrap().concat();
            let found: Vec<f64> =
                light[0][vertex * count..][..count].concat().into_iter().map(f64::from).collect();
            let error = relative_l2(&found, &turned).unwrap();
            assert!(error < 1e-5, "vertex {vertex}: {error:e}, {:?} is not {:?}", &found[..3], &turned[..3]);
        }
    });
}

#[test]
fn modules_declare_what_is_stated() {
    let read = |bytes| Module::read(bytes).unwrap();
    read(refinement::REFINE).assert_bindings(&refinement::REFINE_BINDINGS);
    for order in 3..=6 {
        read(vertices::turn_module(order).unwrap()).assert_bindings(&vertices::TURN_BINDINGS);
        for gradients in [false, true] {
            let shape = LightShape { order, gradients };
            let module = read(vertices::module(shape).unwrap());
            module.assert_bindings(&vertices::bindings(shape));
            assert_eq!(module.push_constants.as_ref().unwrap().size, vertices::CONSTANTS);
            assert!(module.shared_bytes <= 16 << 10, "{} bytes shared", module.shared_bytes);
        }
    }
    assert!(vertices::module(LightShape { order: 2, gradients: true }).is_none());
}
