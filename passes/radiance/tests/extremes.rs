//! Extreme receivers and emitters, on the CPU's reference.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::ops::ControlFlow;

use airglow_math::sh::zonal::{clamped_cosine, rotate_to_direction};
use airglow_radiance::reference::{Cube, sample, triangles};
use airglow_radiance::{
    Hierarchy, Oracle, RadianceError, Reconstruction, Refined, Settings, Triangle, Weights,
};
use glam::DVec3;

const ORDER: usize = 4;

/// Every way to reconstruct.
const KNOBS: [(Weights, bool); 4] = [
    (Weights::Inverse, false),
    (Weights::Inverse, true),
    (Weights::Compact, false),
    (Weights::Compact, true),
];

/// A level floor of side 2 about the origin, its vertices a grid, with the transfer of what nothing shadows.
fn floor(side: usize) -> (Vec<[f32; 3]>, Vec<f32>) {
    let at = |i: usize| (2.0 * i as f32 / (side - 1) as f32) - 1.0;
    let positions: Vec<_> = (0..side * side).map(|i| [at(i % side), 0.0, at(i / side)]).collect();
    let factors: Vec<f64> = clamped_cosine(ORDER).unwrap().iter().map(|a| a / std::f64::consts::PI).collect();
    let mut vector = [0.0; ORDER * ORDER];
    rotate_to_direction(&factors, DVec3::Y, &mut vector).unwrap();
    let transfer = positions.iter().flat_map(|_| vector.map(|t| t as f32)).collect();
    (positions, transfer)
}

fn tree(positions: &[[f32; 3]], transfer: &[f32]) -> Hierarchy {
    Hierarchy::build(positions, transfer, &mut |_, _| ControlFlow::Continue(())).unwrap()
}

fn square(corner: DVec3, x: DVec3, y: DVec3, radiance: f64) -> Vec<Triangle> {
    let corners = [corner, corner + x, corner + x + y, corner + y];
    let half =
        |half: [usize; 3]| Triangle { corners: half.map(|i| corners[i]), radiance: DVec3::splat(radiance) };
    vec![half([0, 1, 2]), half([0, 2, 3])]
}

/// A lamp of side `size` facing down, centred at `centre`.
fn lamp(centre: DVec3, size: f64, radiance: f64) -> Vec<Triangle> {
    square(centre - 0.5 * size * (DVec3::X + DVec3::Z), size * DVec3::X, size * DVec3::Z, radiance)
}

fn refined(tree: &Hierarchy, settings: &Settings, emitters: &[Triangle]) -> Refined {
    sample(tree, settings, &Cube::new(ORDER, 16).unwrap().with_gradients(), emitters).unwrap()
}

/// Cube maps whose texels do not show beside other errors.
fn fine() -> Cube {
    Cube::new(ORDER, 64).unwrap().with_gradients()
}

/// Colours of all vertices, and the least number of samples that any of them came from.
fn colours(
    refined: &Refined,
    positions: &[[f32; 3]],
    transfer: &[f32],
    weights: Weights,
) -> (Vec<f64>, usize) {
    reconstructed(refined, positions, transfer, weights, false)
}

fn reconstructed(
    refined: &Refined,
    positions: &[[f32; 3]],
    transfer: &[f32],
    weights: Weights,
    extrapolate: bool,
) -> (Vec<f64>, usize) {
    let reconstruction = Reconstruction::new(refined, weights, extrapolate);
    let mut light = vec![DVec3::ZERO; ORDER * ORDER];
    let (mut colours, mut least) = (Vec::new(), usize::MAX);
    for (position, t) in positions.iter().zip(transfer.chunks_exact(ORDER * ORDER)) {
        let count = reconstruction.light(DVec3::from(position.map(f64::from)), &mut light).unwrap();
        least = least.min(count);
        colours.push(t.iter().zip(&light).map(|(t, l)| f64::from(*t) * l.x).sum());
    }
    (colours, least)
}

#[test]
fn every_vertex_has_a_sample_and_every_light_is_finite() {
    let (positions, transfer) = floor(20);
    let tree = tree(&positions, &transfer);
    let corner = DVec3::new(1.0, 0.0, 1.0);
    let cases = [
        ("touching a vertex", lamp(corner, 0.3, 1.0)),
        ("with a corner in a vertex", square(corner, DVec3::Y, DVec3::X, 1.0)),
        ("inside the hull", lamp(DVec3::new(0.1, 1e-3, 0.2), 0.1, 5.0)),
        ("larger than the scene", lamp(DVec3::Y, 1e6, 1.0)),
        ("of no area", lamp(DVec3::Y, 0.0, 1.0)),
        ("a line", square(DVec3::Y, DVec3::X, DVec3::X, 1.0)),
        ("of radiance 1e6", lamp(DVec3::new(0.0, 0.5, 0.0), 0.2, 1e6)),
        ("as small as a speck", lamp(DVec3::new(0.3, 0.1, 0.3), 1e-9, 1e6)),
    ];
    for (what, emitters) in cases {
        for bound in [0.0, 1e-3, f64::INFINITY] {
            let refined = refined(&tree, &Settings { bound, limit: 200, ..Settings::default() }, &emitters);
            for (weights, extrapolate) in KNOBS {
                let (colours, least) = reconstructed(&refined, &positions, &transfer, weights, extrapolate);
                assert!(least > 0, "{what}, bound {bound}, {weights:?}: a vertex without a sample");
                assert!(
                    colours.iter().all(|colour| colour.is_finite()),
                    "{what}, bound {bound}, {weights:?}"
                );
            }
        }
    }
}

#[test]
fn samples_are_taken_only_where_they_count() {
    let (positions, transfer) = floor(20);
    let lit = tree(&positions, &transfer);
    let black = tree(&positions, &vec![0.0; transfer.len()]);
    let near = lamp(DVec3::new(0.0, 0.3, 0.0), 0.3, 1.0);
    let settings = Settings::default();
    for oracle in [Oracle::Printed, Oracle::Argued, Oracle::Transfer] {
        let settings = Settings { oracle, bound: 1e-3, ..settings };
        let count = |tree, emitters: &[Triangle]| refined(tree, &settings, emitters).samples.len();
        assert!(count(&lit, &near) > 50, "{oracle:?}, near: {}", count(&lit, &near));
        assert_eq!(count(&lit, &lamp(DVec3::new(0.0, 1e4, 0.0), 1e3, 1.0)), 1, "{oracle:?}, far");
        assert_eq!(count(&lit, &[]), 0, "{oracle:?}, no emitter");
        assert_eq!(count(&lit, &lamp(DVec3::Y, 1.0, 0.0)), 0, "{oracle:?}, emitters without light");
        assert_eq!(count(&black, &near), 0, "{oracle:?}, black");
    }
}

#[test]
fn bounds_of_zero_and_infinity_end() {
    let (positions, transfer) = floor(16);
    let tree = tree(&positions, &transfer);
    let emitters = lamp(DVec3::new(0.0, 0.5, 0.0), 0.3, 1.0);
    let run = |bound, limit| refined(&tree, &Settings { bound, limit, ..Settings::default() }, &emitters);
    let stopped = run(0.0, 100);
    assert!(
        stopped.limited && stopped.samples.len() <= 100 && stopped.estimate > 0.0,
        "{}",
        stopped.samples.len()
    );
    let whole = run(0.0, 1000);
    assert!(!whole.limited && whole.estimate == 0.0);
    assert_eq!(whole.samples.iter().filter(|sample| !sample.split).count(), positions.len());
    let one = run(f64::INFINITY, 1000);
    assert_eq!((one.samples.len(), one.limited), (1, false));
    assert!(run(0.0, 0).limited);
    let refused = sample(
        &tree,
        &Settings { bound: f64::NAN, ..Settings::default() },
        &Cube::new(4, 4).unwrap(),
        &emitters,
    );
    assert!(matches!(refused, Err(RadianceError::Setting { name: "bound", .. })), "{refused:?}");
}

/// A finer bound takes more samples and leaves less error.
#[test]
fn error_falls_with_the_bound() {
    let (positions, transfer) = floor(32);
    let tree = tree(&positions, &transfer);
    let emitters = lamp(DVec3::new(0.2, 0.4, -0.1), 0.4, 3.0);
    let colours_at = |bound| {
        let refined = refined(&tree, &Settings { bound, ..Settings::default() }, &emitters);
        (refined.samples.len(), colours(&refined, &positions, &transfer, Weights::Compact).0)
    };
    let (_, truth) = colours_at(0.0);
    let mut last = (0, f64::INFINITY);
    for bound in [0.1, 0.03, 0.01, 0.003, 0.001] {
        let (count, colours) = colours_at(bound);
        let error = airglow_math::statistics::relative_l2(&colours, &truth).unwrap();
        println!("bound {bound}: {count} samples, error {error:.4}");
        assert!(count > last.0 && error < last.1, "bound {bound}: {count} samples, {error} after {last:?}");
        last = (count, error);
    }
}

/// The same samples, continued by their gradients, leave less error.
#[test]
fn gradients_lessen_the_error() {
    let (positions, transfer) = floor(32);
    let tree = tree(&positions, &transfer);
    let emitters = lamp(DVec3::new(0.2, 0.5, -0.1), 0.5, 3.0);
    let run = |bound| sample(&tree, &Settings { bound, ..Settings::default() }, &fine(), &emitters).unwrap();
    let truth = colours(&run(0.0), &positions, &transfer, Weights::Compact).0;
    for (bound, gain) in [(0.03, 0.8), (0.01, 0.8), (0.003, 0.8)] {
        let refined = run(bound);
        let [plain, better] = [false, true].map(|extrapolate| {
            let (colours, _) = reconstructed(&refined, &positions, &transfer, Weights::Compact, extrapolate);
            airglow_math::statistics::relative_l2(&colours, &truth).unwrap()
        });
        println!("bound {bound}: error {plain:.4}, with gradients {better:.4}");
        assert!(better < gain * plain, "bound {bound}: {better} is not below {gain} times {plain}");
    }
}

#[test]
fn coincident_vertices_and_one_triangle_are_receivers() {
    let (_, transfer) = floor(2);
    let emitters = lamp(DVec3::new(0.0, 0.5, 0.0), 0.3, 1.0);
    let settings = Settings { bound: 0.0, ..Settings::default() };
    for (positions, samples) in [([[0.5, 0.0, 0.5]; 3], 1), ([[0.0; 3], [0.1, 0.0, 0.0], [0.0, 0.0, 0.1]], 4)]
    {
        let transfer = &transfer[..3 * ORDER * ORDER];
        let refined = refined(&tree(&positions, transfer), &settings, &emitters);
        assert_eq!(refined.samples.len(), samples);
        assert!(colours(&refined, &positions, transfer, Weights::Compact).1 > 0);
    }
}

/// A wall through the floor keeps the light on its side; what leaks through reconstruction stays within the bound.
#[test]
fn a_thin_wall_leaks_no_more_than_stated() {
    let (positions, transfer) = floor(32);
    let tree = tree(&positions, &transfer);
    let mut emitters = lamp(DVec3::new(-0.5, 0.6, 0.0), 0.4, 3.0);
    emitters.extend(square(DVec3::new(0.0, -9.0, -9.0), 18.0 * DVec3::Y, 18.0 * DVec3::Z, 0.0));
    let dark = |colours: &[f64]| {
        let square: f64 =
            colours.iter().zip(&positions).filter(|(_, p)| p[0] > 0.0).map(|(c, _)| c * c).sum();
        (square / colours.iter().map(|c| c * c).sum::<f64>()).sqrt()
    };
    for (bound, leak) in [(0.03, 0.1), (0.003, 0.05), (0.0, 1e-12)] {
        let refined = refined(&tree, &Settings { bound, ..Settings::default() }, &emitters);
        let (colours, _) = colours(&refined, &positions, &transfer, Weights::Compact);
        println!("bound {bound}: {} samples, leak {:.4}", refined.samples.len(), dark(&colours));
        assert!(dark(&colours) <= leak, "bound {bound}: {} > {leak}", dark(&colours));
    }
}

/// A sample that a blocker hides from every emitter does not speak for its neighbours that see them.
#[test]
fn a_shadow_is_not_taken_for_the_whole() {
    let (positions, transfer) = floor(32);
    let tree = tree(&positions, &transfer);
    let mut emitters = lamp(DVec3::new(0.0, 0.8, 0.0), 0.1, 30.0);
    emitters.extend(lamp(DVec3::new(0.0, 0.2, 0.0), 0.3, 0.0));
    let run = |bound, hidden| {
        let settings = Settings { bound, hidden, ..Settings::default() };
        let refined = sample(&tree, &settings, &fine(), &emitters).unwrap();
        (refined.samples.len(), colours(&refined, &positions, &transfer, Weights::Compact).0)
    };
    let (_, truth) = run(0.0, airglow_radiance::HIDDEN);
    let blind = run(1e-3, 0.0);
    assert!(blind.0 == 1 && blind.1.iter().all(|colour| *colour == 0.0), "{} samples", blind.0);
    let (count, colours) = run(1e-3, airglow_radiance::HIDDEN);
    let error = airglow_math::statistics::relative_l2(&colours, &truth).unwrap();
    println!("{count} samples, error {error:.4}; without, 1 sample and the error 1");
    assert!(error < 0.5, "{count} samples, error {error}");
}

#[test]
fn what_is_occluded_is_dark() {
    let (positions, transfer) = floor(8);
    let mut emitters = lamp(DVec3::new(0.0, 1.0, 0.0), 0.5, 1.0);
    emitters.extend(lamp(DVec3::new(0.0, 0.5, 0.0), 100.0, 0.0));
    let refined = refined(&tree(&positions, &transfer), &Settings::default(), &emitters);
    let (colours, least) = colours(&refined, &positions, &transfer, Weights::Compact);
    assert!(least > 0 && colours.iter().all(|colour| *colour == 0.0), "{colours:?}");
}

/// Over edges and corners of the cube the map is as close to the closed form as inside a face.
#[test]
fn edges_and_corners_of_the_cube_do_not_show() {
    let cube = Cube::new(ORDER, 64).unwrap();
    for direction in
        [DVec3::Z, DVec3::new(1.0, 0.0, 1.0), DVec3::ONE, DVec3::new(1.0, -1.0, 1.0), DVec3::NEG_ONE]
    {
        let normal = direction.normalize();
        let x = normal.any_orthonormal_vector();
        let emitters = square(2.0 * normal - 0.5 * (x + normal.cross(x)), x, normal.cross(x), 1.0);
        let map = cube.sample(DVec3::ZERO, &emitters).unwrap();
        let exact = triangles(ORDER, DVec3::ZERO, &emitters).unwrap();
        for (i, (l, e)) in map.coefficients.iter().zip(&exact.coefficients).enumerate() {
            assert!(l.distance(*e) < 0.03 * exact.norm(), "{direction}, coefficient {i}: {l} is not {e}");
        }
    }
}
