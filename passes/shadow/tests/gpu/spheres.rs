//! The pass over receivers: against f64, the extremes, the counts.

use airglow_shadow::bench::{Scene, SphereKernel};
use airglow_shadow::families::{FAMILIES, Random};
use airglow_shadow::reference::{Reference, caps, rms};
use airglow_shadow::spheres::Hierarchy;
use airglow_shadow::{Blockers, Exponential, Settings, Shadow, Sphere};
use glam::{DMat4, DVec3};

use crate::{wide, with_bench};

/// Nothing is left out or clamped, so that the reference computes the same.
fn plain(order: usize) -> Settings {
    Settings { order, reach: 0.0, clamp: false, ..Default::default() }
}

#[test]
fn the_pass_agrees_with_the_reference() {
    with_bench(|bench| {
        for order in [3, 4, 5, 6] {
            let reference = Reference::new(order).unwrap();
            for family in FAMILIES {
                let spheres: Vec<Sphere> =
                    family.scene(1).unwrap().iter().map(|cap| cap.sphere(3.0)).collect();
                let positions = [[0.0; 3], [0.5, -0.25, 0.125], [0.0, 0.0, -0.5]];
                let scene = Scene { positions: &positions, normals: None, spheres: &spheres };
                let kernels = match order {
                    4 => &[SphereKernel::Pass, SphereKernel::Products, SphereKernel::Logarithm][..],
                    _ => &[SphereKernel::Pass],
                };
                for &kernel in kernels {
                    let found = bench.spheres(plain(order), kernel, &scene, 1).unwrap();
                    for (position, found) in positions.iter().zip(found.values.chunks(order * order)) {
                        let caps = caps(&spheres, DVec3::from_array(position.map(f64::from)));
                        let truth = match kernel {
                            SphereKernel::Pass => reference.visibility(Exponential::Adaptive, &caps),
                            SphereKernel::Products => reference.chain(&caps),
                            SphereKernel::Logarithm => reference.log_visibility(&caps),
                        };
                        let truth = truth.unwrap();
                        let error = rms(&wide(found), &truth);
                        assert!(error < 2e-3, "order {order}, {}, {kernel:?}: {error:e}", family.name);
                    }
                }
            }
        }
    });
}

#[test]
fn points_on_in_and_at_spheres_are_finite_and_within_bounds() {
    let sphere = |x: f64, radius: f64| Sphere { center: DVec3::new(x, 0.0, 0.0), radius };
    let thousand: Vec<Sphere> = (0..1000).map(|i| sphere(2.0 + 1e-4 * f64::from(i), 1.0)).collect();
    let sets = [
        vec![sphere(0.0, 0.0)],
        vec![sphere(0.0, 1.0)],
        vec![sphere(1.0, 1.0)],
        vec![sphere(1.0 + 1e-7, 1.0)],
        vec![sphere(1.1e6, 1e6)],
        vec![sphere(1e-15, 1e-16)],
        vec![sphere(1e15, 0.5e15)],
        thousand,
    ];
    with_bench(|bench| {
        for (number, spheres) in sets.iter().enumerate() {
            for order in [3, 6] {
                let scene = Scene { positions: &[[0.0; 3]], normals: None, spheres };
                let settings = Settings { order, ..Default::default() };
                let frame = bench.spheres(settings, SphereKernel::Pass, &scene, 1).unwrap();
                let one = (4.0 * std::f64::consts::PI).sqrt();
                let values = wide(&frame.values);
                assert!(values.iter().all(|value| value.is_finite()), "set {number}: {values:?}");
                assert!((0.0..=one + 1e-6).contains(&values[0]), "set {number}: {}", values[0]);
                let square: f64 = values.iter().map(|value| value * value).sum();
                assert!(square <= one * values[0] + 1e-5, "set {number}, order {order}: {square} {values:?}");
            }
        }
        // Radius 0 leaves all open; a centre above leaves half of the sky.
        let open = bench.spheres(
            Settings::default(),
            SphereKernel::Pass,
            &Scene { positions: &[[0.0; 3]], normals: None, spheres: &sets[0] },
            1,
        );
        let open = open.unwrap();
        assert_eq!((open.counts.open, open.counts.spheres), (1, 0));
        assert_eq!(open.values[1..], [0.0; 15]);
    });
}

#[test]
fn what_lies_below_the_tangent_plane_counts_nothing_and_edges_are_smooth() {
    let settings = Settings { normals: true, clamp: false, reach: 0.0, ..Default::default() };
    let seen = |spheres: &[Sphere], position: [f32; 3]| {
        let scene = Scene { positions: &[position], normals: Some(&[[0.0, 2.0, 0.0]]), spheres };
        let frame = with_bench(|bench| bench.spheres(settings, SphereKernel::Pass, &scene, 1).unwrap());
        f64::from(frame.values[0]) / (4.0 * std::f64::consts::PI).sqrt()
    };
    let at = |y: f64| [Sphere { center: DVec3::new(0.6, y, 0.0), radius: 0.5 }];
    let open = |value: f64| assert!((value - 1.0).abs() < 1e-6, "{value}");
    open(seen(&at(-0.6), [0.0; 3]));
    let inside_below = [Sphere { center: DVec3::new(0.0, -0.2, 0.0), radius: 0.5 }];
    // A receiver's own sphere.
    open(seen(&inside_below, [0.0; 3]));
    assert!(seen(&at(0.5), [0.0; 3]) < 0.95);
    // From below the plane to above it, in steps: no step changes much more than its neighbours.
    let values: Vec<f64> = (0..=40).map(|i| seen(&at(-0.6 + 0.03 * f64::from(i)), [0.0; 3])).collect();
    let steps: Vec<f64> = values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    let largest = steps.iter().copied().fold(0.0, f64::max);
    assert!(largest < 0.03, "{largest}: {values:?}");
}

#[test]
fn spheres_out_of_reach_are_left_out_within_the_bound_and_counted() {
    let mut random = Random::new(7);
    let spheres: Vec<Sphere> = (0..100)
        .map(|_| Sphere {
            center: 20.0 * random.direction() + 30.0 * DVec3::Y,
            radius: 0.02 + 0.1 * random.unit(),
        })
        .collect();
    let positions: Vec<[f32; 3]> = (0..4096).map(|i| [(i % 64) as f32, 0.0, (i / 64) as f32]).collect();
    let scene = Scene { positions: &positions, normals: None, spheres: &spheres };
    with_bench(|bench| {
        let all = bench.spheres(plain(4), SphereKernel::Pass, &scene, 1).unwrap();
        let settings = Settings { clamp: false, ..Default::default() };
        let near = bench.spheres(settings, SphereKernel::Pass, &scene, 1).unwrap();
        assert_eq!(all.counts.spheres, 64 * 100);
        assert!(near.counts.spheres < all.counts.spheres / 2, "{:?}", near.counts);
        assert!(near.counts.open > 0 && near.counts.clusters == 64, "{:?}", near.counts);
        for (all, near) in all.values.chunks(16).zip(near.values.chunks(16)) {
            let error = rms(&wide(all), &wide(near));
            assert!(error < 100.0 * 1e-5, "{error:e}");
        }
        let again = bench.spheres(settings, SphereKernel::Pass, &scene, 1).unwrap();
        assert_eq!(near.values, again.values, "the same frame, the same bits");
    });
}

/// Small spheres in a ball of radius 1 above the ground.
fn swarm(count: usize, radius: f64) -> Vec<Sphere> {
    let mut random = Random::new(11);
    let mut sphere = || Sphere { center: 2.0 * DVec3::Y + random.unit().cbrt() * random.direction(), radius };
    (0..count).map(|_| sphere()).collect()
}

#[test]
fn a_cut_of_the_hierarchy_takes_fewer_spheres_and_changes_little() {
    let spheres = swarm(60, 0.2);
    let positions: Vec<[f32; 3]> = (0..256).map(|i| [(i % 16) as f32 - 8.0, 0.0, (i / 16) as f32]).collect();
    let hierarchy = Hierarchy::new(&spheres, 4).unwrap();
    let plain_hierarchy = Hierarchy::without_ratios(&spheres).unwrap();
    with_bench(|bench| {
        let run = |hierarchy: &Hierarchy, cut: f64| {
            let settings = Settings { cut, ..plain(4) };
            let shadow = Shadow::new(bench.context, settings).unwrap();
            let blockers = Blockers::default();
            blockers.set_nodes(&hierarchy.posed(&spheres).unwrap(), DMat4::IDENTITY).unwrap();
            bench.blocked(&shadow, &positions, None, &blockers, 1).unwrap()
        };
        let difference = |a: &[f32], b: &[f32]| {
            let pairs = a.chunks(16).zip(b.chunks(16));
            pairs.map(|(a, b)| rms(&wide(a), &wide(b))).fold(0.0, f64::max)
        };
        let scene = Scene { positions: &positions, normals: None, spheres: &spheres };
        let listed = bench.spheres(plain(4), SphereKernel::Pass, &scene, 1).unwrap();
        let leaves = run(&plain_hierarchy, 0.0);
        assert_eq!(leaves.counts.spheres, listed.counts.spheres);
        let error = difference(&leaves.values, &listed.values);
        assert!(error < 1e-5, "the same spheres in another order: {error:e}");
        let (fine, coarse) = (run(&hierarchy, 0.0), run(&hierarchy, 0.04));
        assert!(coarse.counts.spheres < fine.counts.spheres / 2, "{:?}", coarse.counts);
        let error = difference(&coarse.values, &fine.values);
        assert!(error < 0.02, "{error}");
    });
}

#[test]
fn spheres_of_several_uniform_ranges_add_up() {
    let spheres = swarm(2500, 0.01);
    let positions = [[0.0, 0.0, 0.0], [1.5, 0.5, -1.0]];
    let reference = Reference::new(3).unwrap();
    with_bench(|bench| {
        let scene = Scene { positions: &positions, normals: None, spheres: &spheres };
        let found = bench.spheres(plain(3), SphereKernel::Pass, &scene, 1).unwrap();
        assert_eq!(found.counts.spheres, 2500);
        for (position, found) in positions.iter().zip(found.values.chunks(9)) {
            let caps = caps(&spheres, DVec3::from_array(position.map(f64::from)));
            let truth = reference.visibility(Exponential::Adaptive, &caps).unwrap();
            let error = rms(&wide(found), &truth);
            assert!(error < 2e-3, "{error:e}: {found:?} and {truth:?}");
        }
    });
}
