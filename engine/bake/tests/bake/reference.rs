//! Bakes of a bumpy mesh against the brute-force f64 reference.

use crate::common::{Shape, bake_at, relative};
use airglow_bake::{BelowHorizon, Settings, reference};
use glam::Mat4;

#[test]
fn vertices_of_a_bumpy_mesh_agree_with_brute_force() {
    let shape = Shape::bumpy_sphere(24, 16);
    let turn = Mat4::from_rotation_x(0.7) * Mat4::from_scale(glam::Vec3::new(1.0, 2.0, 0.7));
    let triangles = reference::triangles(&[shape.mesh().occluder_at(turn)]).unwrap();
    for below in [BelowHorizon::Mean, BelowHorizon::Visible, BelowHorizon::Blocked] {
        let settings = Settings { order: 4, rays: 4096, visibility: Some(below), ..Settings::default() };
        let baked = bake_at(&shape.mesh(), turn, &[shape.mesh().occluder()], &settings).transfer;
        for vertex in (30..baked.vertex_count).step_by(97) {
            let place = reference::vertex(&shape.mesh(), turn, vertex).unwrap();
            let truth = reference::vectors(place, 1e-6, &triangles, 4, 40, below).unwrap();
            let error = relative(baked.vector(vertex), &truth.transfer);
            let visibility_error = relative(baked.visibility_vector(vertex), &truth.visibility);
            println!("{below:?} vertex {vertex}: transfer {error:.2e}, visibility {visibility_error:.2e}");
            assert!(error < 0.01, "{:?} for {:?}", baked.vector(vertex), truth.transfer);
            assert!(
                visibility_error < 0.015,
                "{:?} for {:?}",
                baked.visibility_vector(vertex),
                truth.visibility
            );
        }
    }
}
