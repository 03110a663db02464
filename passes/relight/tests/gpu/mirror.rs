//! Mirrored instances share the transfer baked in object space: the light is rotated and its odd bands change sign.

use crate::host::{Numbers, length, wide, wide_rgb, with_bench};
use airglow_bake::{Mesh, unshadowed};
use airglow_math::sh::reconstruct;
use airglow_relight::{Case, CaseLight, Orientation, Relight, Settings, instance_rotation, reference};
use glam::{DMat3, DQuat, DVec3, Mat3, Mat4};

/// Instances that mirror, turn and scale uniformly.
fn mirrored() -> Vec<DMat3> {
    let turns = [(DVec3::X, 0.0), (DVec3::new(1.0, 2.0, -0.5), 2.1), (DVec3::new(-1.0, 0.3, 0.2), 3.1)];
    let mirrors = [DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, 1.0, -1.0), DVec3::NEG_ONE];
    let matrix = |((axis, angle), mirror): ((DVec3, f64), DVec3)| {
        DMat3::from_axis_angle(axis.normalize(), angle) * DMat3::from_diagonal(mirror) * 2.5
    };
    turns.into_iter().zip(mirrors).map(matrix).collect()
}

fn unit(numbers: &mut Numbers) -> DVec3 {
    DVec3::new(numbers.next(), numbers.next(), numbers.next()).normalize()
}

/// The light that the object sees along o is the light along M o.
#[test]
fn light_of_a_mirrored_instance_is_that_of_the_mirrored_directions() {
    let mut numbers = Numbers::new(70);
    for order in 1..=6 {
        for matrix in mirrored() {
            let light: Vec<[f64; 3]> = wide_rgb(&numbers.rgb(order * order));
            let orientation = instance_rotation(matrix).unwrap();
            assert!(orientation.inverted);
            let in_object = reference::light(order, &light, DQuat::IDENTITY, orientation).unwrap();
            let red = |light: &[[f64; 3]]| light.iter().map(|rgb| rgb[0]).collect::<Vec<_>>();
            for _ in 0..20 {
                let direction = unit(&mut numbers);
                let seen = reconstruct(order, &red(&in_object), direction).unwrap();
                let truth = reconstruct(order, &red(&light), (matrix * direction).normalize()).unwrap();
                assert!((seen - truth).abs() < 1e-12, "order {order}, {matrix}: {seen} and {truth}");
            }
        }
    }
}

/// One mesh, baked once in object space and once for each instance in world space: the same colours, and those of the
/// f64 reference.
#[test]
fn a_mirrored_instance_has_the_colours_of_its_bake_in_world_space() {
    with_bench(|bench| {
        let mut numbers = Numbers::new(71);
        let normals: Vec<[f32; 3]> = (0..100).map(|_| unit(&mut numbers).as_vec3().to_array()).collect();
        let positions = vec![[0.0; 3]; normals.len()];
        let mesh = Mesh { name: "points", positions: &positions, normals: &normals, indices: &[0, 1, 2] };
        for order in [1, 2, 4, 6] {
            let settings = Settings { order, ..Settings::default() };
            let light = numbers.rgb(order * order);
            let turn = DQuat::from_xyzw(0.3, -0.4, 0.5, 0.6);
            for matrix in mirrored() {
                let vectors = |matrix: Mat3| {
                    unshadowed(&mesh, Mat4::from_mat3(matrix), order).unwrap().transfer.coefficients
                };
                let colours = |vectors: &[f32], orientation: Orientation| {
                    let mut relight = Relight::new(bench.context, settings).unwrap();
                    let mesh = relight.add_mesh(bench.context, "points", 100, Some(vectors)).unwrap();
                    let light = CaseLight::Uniform(&light, turn);
                    let case = Case { orientation, ..Case::new(light, mesh) };
                    bench.results(&mut relight, &case).unwrap()
                };
                let orientation = instance_rotation(matrix).unwrap();
                let in_object = vectors(Mat3::IDENTITY);
                let shared = colours(&in_object, orientation);
                let own = colours(&vectors(matrix.as_mat3()), Orientation::IDENTITY);
                let turned = reference::light(order, &wide_rgb(&light), turn, orientation).unwrap();
                for (vertex, transfer) in in_object.chunks_exact(order * order).enumerate() {
                    let transfer = wide(transfer);
                    let expected = reference::colour(&transfer, &turned);
                    let scale = length(transfer) * length(turned.iter().flatten().copied());
                    for channel in 0..3 {
                        let (ours, baked) = (shared[4 * vertex + channel], own[4 * vertex + channel]);
                        for truth in [expected[channel], f64::from(baked)] {
                            let error = (f64::from(ours) - truth).abs() / scale;
                            assert!(
                                error < 1e-5,
                                "order {order}, vertex {vertex}: {ours} and {truth}: {error}"
                            );
                        }
                    }
                }
            }
        }
    });
}
