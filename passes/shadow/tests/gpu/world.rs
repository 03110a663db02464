//! Hosts that differ in axes, hand and units get the same visibility.

use airglow_math::statistics::relative_l2;
use airglow_shadow::bench::{Scene, SphereKernel};
use airglow_shadow::{Settings, Sphere};
use airglow_tests::hosts::hosts;
use glam::DVec3;

use crate::graph::{SPHERES, ground};
use crate::{wide, with_bench};

#[test]
fn three_hosts_get_the_same_visibility() {
    // Which spheres a cluster leaves out depends on how its host's axes cut clusters: leave out none.
    let settings = Settings { reach: 0.0, normals: true, ..Settings::default() };
    let (positions, normals) = ground();
    with_bench(|bench| {
        let [first, others @ ..] = hosts().map(|world| {
            let airglow = |values: &[f32; 3]| DVec3::from_array(values.map(f64::from));
            let place = |p: &[f32; 3]| world.host_position(airglow(p)).as_vec3().to_array();
            let direction = |n: &[f32; 3]| world.host_direction(airglow(n)).as_vec3().to_array();
            let positions: Vec<[f32; 3]> = positions.iter().map(place).collect();
            let normals: Vec<[f32; 3]> = normals.iter().map(direction).collect();
            let spheres = SPHERES.map(|sphere| Sphere {
                center: world.host_position(sphere.center),
                radius: sphere.radius / world.metres_per_unit,
            });
            let scene = Scene { positions: &positions, normals: Some(&normals), spheres: &spheres };
            let frame = bench.spheres(settings, SphereKernel::Pass, &scene, 1).unwrap();
            let turn = world.harmonics(settings.order).unwrap();
            let vectors = wide(&frame.values);
            let turned = vectors.chunks_exact(settings.order * settings.order).flat_map(|vector| {
                let mut turned = vec![0.0; vector.len()];
                turn.apply(vector, &mut turned).unwrap();
                turned
            });
            turned.collect::<Vec<_>>()
        });
        for (host, theirs) in others.iter().enumerate() {
            let error = relative_l2(theirs, &first).unwrap();
            println!("host {}: {error:.1e}", host + 1);
            assert!(error < 1e-5, "host {}: {error:e}", host + 1);
        }
    });
}
