//! Hosts that differ in axes, hand and units get the same light.

use airglow_math::statistics::relative_l2;
use airglow_radiance::{Lights, PassSettings, Radiance, Settings, Triangle};
use airglow_tests::hosts::hosts;

use crate::receivers::Mesh;
use crate::scenes::blocks;
use crate::with_bench;

const ORDER: usize = 4;

/// A sample at every vertex, so that no tree is between the hosts.
fn settings() -> PassSettings {
    let refinement = Settings { bound: 0.0, limit: 4096, ..Settings::default() };
    PassSettings { order: ORDER, gradients: false, face: 16, rays: 2, refinement, ..PassSettings::default() }
}

#[test]
fn three_hosts_get_the_same_light() {
    with_bench(&Radiance::requirements(&settings()), |bench| {
        let radiance = Radiance::new(bench.context, settings()).unwrap();
        let [first, others @ ..] = hosts().map(|world| {
            let mesh = Mesh::ball_of(&world, 10, ORDER);
            let corner = |corner| world.host_position(corner);
            let placed = |t: Triangle| Triangle { corners: t.corners.map(corner), ..t };
            let emitters: Vec<Triangle> = blocks().into_iter().map(placed).collect();
            let receiver = mesh.receiver(bench, settings());
            let prepared =
                radiance.prepare(&receiver, &Lights { emitters: &emitters, ..Lights::default() }).unwrap();
            let buffers = bench.light_buffers(&prepared).unwrap();
            bench.frame(&prepared, &buffers).unwrap();
            let light = bench.light::<[f32; 3]>(&buffers).unwrap().concat();
            let light: Vec<[f64; 3]> = light.into_iter().map(|rgb| rgb.map(f64::from)).collect();
            let turn = world.harmonics(ORDER).unwrap();
            light
                .chunks_exact(ORDER * ORDER)
                .flat_map(|l| turn.apply_rgb(l).unwrap().concat())
                .collect::<Vec<_>>()
        });
        assert!(first.iter().any(|value| *value > 0.1));
        for (host, theirs) in others.iter().enumerate() {
            let error = relative_l2(theirs, &first).unwrap();
            println!("host {}: {error:.1e}", host + 1);
            assert!(error < 1e-3, "host {}: {error:e}", host + 1);
        }
    });
}
